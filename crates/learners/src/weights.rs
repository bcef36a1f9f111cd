//! Weights as little-endian bytes: magic with version, size, number of tilings, weights, checksum.

use core::fmt;

use crate::QLambda;

/// The name and the version. Other tiles need another version.
const MAGIC: [u8; 8] = *b"TILE\x01\0\0\0";
/// The words before the weights.
const HEADER: usize = 4;

impl<const S: usize, const T: usize> QLambda<'_, S, T> {
    /// The number of bytes that [`QLambda::save`] returns.
    pub const BYTES: usize = 4 * (HEADER + 2 * S + 1);

    /// The weights as [`QLambda::BYTES`] bytes, from the first to the last.
    pub fn save(&self) -> impl Iterator<Item = u8> + '_ {
        let header = [Self::BYTES as u32, T as u32];
        let words = MAGIC.into_iter().chain(header.into_iter().flat_map(u32::to_le_bytes));
        let weights = self.weights.as_flattened().iter().flat_map(|w| w.to_le_bytes());
        let body = words.chain(weights);
        let checksum = body.clone().fold(FNV, fnv);
        body.chain(checksum.to_le_bytes())
    }

    /// Loads weights that [`QLambda::save`] returned. The step size stays as it is.
    ///
    /// # Errors
    ///
    /// [`LoadError`]. The weights are unchanged then.
    pub fn load(&mut self, bytes: &[u8]) -> Result<(), LoadError> {
        let (words, _) = bytes.as_chunks();
        let word = |at: usize| words.get(at).copied().map_or(0, u32::from_le_bytes);
        if !bytes.starts_with(&MAGIC) {
            return Err(LoadError::Magic);
        }
        if bytes.len() != Self::BYTES {
            return Err(LoadError::Size { found: bytes.len(), expected: Self::BYTES });
        }
        if word(3) != T as u32 {
            return Err(LoadError::Features);
        }
        let body = bytes.iter().take(Self::BYTES - 4).copied();
        if word(HEADER + 2 * S) != body.fold(FNV, fnv) {
            return Err(LoadError::Checksum);
        }
        let weights = words.iter().skip(HEADER).take(2 * S);
        let weights = weights.map(|&bytes| f32::from_le_bytes(bytes));
        if let Some(index) = weights.clone().position(|w| !w.is_finite()) {
            return Err(LoadError::NotFinite(index));
        }
        for (w, number) in self.weights.as_flattened_mut().iter_mut().zip(weights) {
            *w = number;
        }
        Ok(())
    }
}

/// FNV-1a, 32 bits: <http://www.isthe.com/chongo/tech/comp/fnv/>.
const FNV: u32 = 0x811c_9dc5;

fn fnv(hash: u32, byte: u8) -> u32 {
    (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
}

/// Why bytes were rejected as weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LoadError {
    /// The bytes do not begin as weights of this version do.
    Magic,
    /// Too few or too many bytes.
    Size {
        /// The bytes given.
        found: usize,
        /// The bytes that this learner's weights take, header included.
        expected: usize,
    },
    /// The weights of a learner with other features, for which they mean something else.
    Features,
    /// The bytes changed since they were saved.
    Checksum,
    /// A weight that is infinite or NaN: its index among the weights, counted from 0.
    NotFinite(usize),
}

impl LoadError {
    /// The text without its numbers, whose formatting takes 4 KB of a WebAssembly module.
    #[must_use]
    pub const fn message(&self) -> &'static str {
        match self {
            Self::Magic => "weights must begin with the bytes TILE and version 1",
            Self::Size { .. } => "weights must have the learner's number of bytes",
            Self::Features => "weights must be those of a learner with the same features",
            Self::Checksum => "damaged weights: the checksum differs",
            Self::NotFinite(_) => "weights must be finite numbers",
        }
    }
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Size { found, expected } => {
                write!(f, "weights must have {expected} bytes, got {found}")
            }
            Self::NotFinite(index) => write!(f, "weight {index} must be a finite number"),
            _ => f.write_str(self.message()),
        }
    }
}

impl core::error::Error for LoadError {}
