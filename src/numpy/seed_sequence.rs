//! NumPy's `SeedSequence`: turns a seed into the initial state of a generator.
//!
//! The algorithm is M. E. O'Neill's `seed_seq_fe`
//! (<https://www.pcg-random.org/posts/developing-a-seed_seq-alternative.html>), with NumPy's
//! constants and order (<https://numpy.org/doc/stable/reference/random/bit_generators/>).

#[cfg(feature = "std")]
use crate::error::Error;

/// A hashed seed: NumPy's `SeedSequence` of any non-negative integer, and its children.
///
/// It has 48 bytes, however large the seed. It is not `Copy`, so that two copies do not spawn the
/// same children by accident.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SeedSequence {
    pool: [u32; 4],
    /// The multiplier of the next `hash`, which changes it.
    hash_multiplier: u32,
    /// The number of children spawned.
    spawned: u128,
}

const SHIFT: u32 = 16;

impl SeedSequence {
    /// The sequence of `seed`. For longer seeds: [`from_words`](Self::from_words) and, with `std`,
    /// `parse` on a decimal text.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self::pooled([seed as u32, (seed >> 32) as u32, 0, 0])
    }

    /// The sequence of the integer with these 32-bit digits, the lowest first.
    #[must_use]
    #[expect(clippy::indexing_slicing, reason = "the loop ends with the words")]
    pub const fn from_words(mut words: &[u32]) -> Self {
        while let [rest @ .., 0] = words {
            words = rest;
        }
        let (mut first, mut i) = ([0; 4], 0);
        while i < 4 && i < words.len() {
            first[i] = words[i];
            i += 1;
        }
        let mut sequence = Self::pooled(first);
        while i < words.len() {
            sequence.absorb(words[i]);
            i += 1;
        }
        sequence
    }

    /// The sequence of four words, or fewer and zeros.
    #[expect(clippy::indexing_slicing, reason = "the pool has 4 words")]
    #[inline(never)] // saves flash, as does `hash`, which it calls sixteen times
    const fn pooled(words: [u32; 4]) -> Self {
        let mut sequence = Self { pool: [0; 4], hash_multiplier: 0x43b0_d7e5, spawned: 0 };
        let mut i = 0;
        while i < 4 {
            sequence.pool[i] = sequence.hash(words[i]);
            i += 1;
        }
        let mut source = 0;
        while source < 4 {
            let mut target = 0;
            while target < 4 {
                if source != target {
                    let hashed = sequence.hash(sequence.pool[source]);
                    sequence.pool[target] = mix(sequence.pool[target], hashed);
                }
                target += 1;
            }
            source += 1;
        }
        sequence
    }

    /// NumPy's `spawn(n)`: the next `n` children, each with an independent stream. A later call
    /// returns other children.
    pub fn spawn(&mut self, n: u64) -> impl Iterator<Item = Self> + use<> {
        let parent = self.clone();
        self.spawned = parent.spawned.saturating_add(n.into());
        (0..n).map(move |i| parent.descend(parent.spawned.saturating_add(i.into())))
    }

    /// The child with this index, counted from 0 over all calls of [`spawn`](Self::spawn).
    #[must_use]
    pub fn child(&self, index: u64) -> Self {
        self.descend(index.into())
    }

    fn descend(&self, mut index: u128) -> Self {
        let mut child = Self { spawned: 0, ..self.clone() };
        loop {
            child.absorb(index as u32);
            index >>= 32;
            if index == 0 {
                return child;
            }
        }
    }

    /// The first `N` 64-bit words of the sequence. Each call returns the same.
    #[must_use]
    #[expect(clippy::indexing_slicing, reason = "indices are below 4 and N")]
    pub const fn generate_state<const N: usize>(&self) -> [u64; N] {
        let mut state = [0; N];
        let mut multiplier = 0x8b51_f9dd_u32;
        let mut half = 0;
        while half < 2 * N {
            let mut word = self.pool[half % 4] ^ multiplier;
            multiplier = multiplier.wrapping_mul(0x58f3_8ded);
            word = word.wrapping_mul(multiplier);
            word ^= word >> SHIFT;
            state[half / 2] |= (word as u64) << (32 * (half % 2));
            half += 1;
        }
        state
    }

    /// Mixes one more word of entropy into the whole pool.
    const fn absorb(&mut self, word: u32) {
        let [a, b, c, d] = self.pool;
        self.pool = [
            mix(a, self.hash(word)),
            mix(b, self.hash(word)),
            mix(c, self.hash(word)),
            mix(d, self.hash(word)),
        ];
    }

    #[inline(never)]
    const fn hash(&mut self, word: u32) -> u32 {
        let word = word ^ self.hash_multiplier;
        self.hash_multiplier = self.hash_multiplier.wrapping_mul(0x931e_8875);
        let word = word.wrapping_mul(self.hash_multiplier);
        word ^ (word >> SHIFT)
    }
}

const fn mix(x: u32, y: u32) -> u32 {
    let mixed = x.wrapping_mul(0xca01_f9dd).wrapping_sub(y.wrapping_mul(0x4973_f715));
    mixed ^ (mixed >> SHIFT)
}

impl From<u64> for SeedSequence {
    fn from(seed: u64) -> Self {
        Self::new(seed)
    }
}

#[cfg(feature = "std")]
impl std::str::FromStr for SeedSequence {
    type Err = Error;

    /// The sequence of a decimal integer with up to 4300 digits, as many as Python's `int` parses
    /// by default. For a larger one: [`from_words`](Self::from_words).
    ///
    /// # Errors
    ///
    /// [`Error::MalformedSeed`].
    fn from_str(text: &str) -> Result<Self, Error> {
        if text.is_empty() {
            return Err(Error::MalformedSeed { found: None, position: 1 });
        }
        let mut words = std::vec::Vec::new();
        for (found, position) in text.chars().zip(1..) {
            // The time is quadratic in the length.
            let Some(digit) = found.to_digit(10).filter(|_| position <= 4300) else {
                return Err(Error::MalformedSeed { found: Some(found), position });
            };
            let mut carry = u64::from(digit);
            for word in &mut words {
                carry += u64::from(*word) * 10;
                *word = carry as u32;
                carry >>= 32;
            }
            if carry != 0 {
                words.push(carry as u32);
            }
        }
        Ok(Self::from_words(&words))
    }
}
