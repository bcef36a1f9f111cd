//! Weights as little-endian bytes: magic, version, size, the features' fingerprint, the weights and a checksum.

use crate::error::LoadError;
use crate::values::{Features, Values};

const MAGIC: [u8; 4] = *b"TILE";
const VERSION: u32 = 1;
const HEADER: usize = 16;
const CHECKSUM: usize = 4;

impl<F: Features<D, T>, const S: usize, const A: usize, const D: usize, const T: usize>
    Values<'_, F, S, A, D, T>
{
    /// The number of bytes that [`Values::save`] returns.
    pub const BYTES: usize = HEADER + 4 * S * A + CHECKSUM;

    /// The weights as [`Values::BYTES`] bytes, from the first to the last.
    pub fn save(&self) -> impl Iterator<Item = u8> + '_ {
        let header = self.header();
        let weights = || self.weights.iter().flatten().map(|w| w.to_le_bytes());
        let checksum = header
            .iter()
            .copied()
            .chain(weights().flatten())
            .fold(FNV, fnv);
        header
            .into_iter()
            .chain(weights().flatten())
            .chain(checksum.to_le_bytes())
    }

    /// Loads weights that [`Values::save`] returned. Schedules stay as they are.
    ///
    /// # Errors
    ///
    /// [`LoadError`] for bytes of another kind, version, size or learner, for damaged bytes, and for a weight that is
    /// not finite. The weights are unchanged then.
    pub fn load(&mut self, bytes: &[u8]) -> Result<(), LoadError> {
        let word = |at: usize| match bytes.get(at..at + 4) {
            Some(&[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]),
            _ => 0,
        };
        if bytes.get(..4) != Some(&MAGIC) {
            return Err(LoadError::Magic);
        }
        let header = self.header();
        let expected = |at: usize| {
            u32::from_le_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]])
        };
        if bytes.len() >= 8 && word(4) != VERSION {
            return Err(LoadError::Version {
                found: word(4),
                expected: VERSION,
            });
        }
        if bytes.len() != Self::BYTES || word(8) != expected(8) {
            return Err(LoadError::Size {
                found: if bytes.len() == Self::BYTES {
                    word(8) as usize
                } else {
                    bytes.len()
                },
                expected: Self::BYTES,
            });
        }
        if word(12) != expected(12) {
            return Err(LoadError::Features {
                found: word(12),
                expected: expected(12),
            });
        }
        let (body, _) = bytes.split_at(Self::BYTES - CHECKSUM);
        let checksum = body.iter().copied().fold(FNV, fnv);
        if word(Self::BYTES - CHECKSUM) != checksum {
            return Err(LoadError::Checksum {
                found: word(Self::BYTES - CHECKSUM),
                expected: checksum,
            });
        }
        let numbers = || {
            let (numbers, _) = body[HEADER..].as_chunks();
            numbers.iter().map(|&bytes| f32::from_le_bytes(bytes))
        };
        if let Some(index) = numbers().position(|w| !w.is_finite()) {
            return Err(LoadError::NotFinite { index });
        }
        for (w, number) in self.weights.iter_mut().flatten().zip(numbers()) {
            *w = number;
        }
        Ok(())
    }

    fn header(&self) -> [u8; HEADER] {
        let mut fingerprint = FNV;
        self.features.fingerprint(|word| {
            fingerprint = word.to_le_bytes().into_iter().fold(fingerprint, fnv);
        });
        let words = [VERSION, Self::BYTES as u32, fingerprint].map(u32::to_le_bytes);
        let mut header = [0; HEADER];
        let bytes = MAGIC.iter().chain(words.iter().flatten());
        for (byte, &value) in header.iter_mut().zip(bytes) {
            *byte = value;
        }
        header
    }
}

/// FNV-1a, 32 bits: <http://www.isthe.com/chongo/tech/comp/fnv/>.
const FNV: u32 = 0x811c_9dc5;

fn fnv(hash: u32, byte: u8) -> u32 {
    (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
}
