//! NumPy's `SeedSequence`: from a seed to the words that a generator starts with.
//!
//! The algorithm is M. E. O'Neill's `seed_seq_fe`
//! (<https://www.pcg-random.org/posts/developing-a-seed_seq-alternative.html>), with the constants
//! and the order of NumPy (<https://numpy.org/doc/stable/reference/random/bit_generators/>).

/// A seed, mixed: NumPy's `SeedSequence` for any non-negative integer, and its children.
///
/// NumPy keeps the seed itself and mixes it anew for every child. Mixing is sequential, so that
/// the mixed pool can be kept in its place: a seed of any size takes 32 bytes. It is `Clone`, and
/// never `Copy`, so that no two copies spawn the same children by accident.
///
/// ```
/// use acrobot::SeedSequence;
///
/// let mut seed = SeedSequence::from(42);
/// assert_eq!(seed.generate_state::<2>(), [0x9f1e_2e6d_cd54_0ab7, 0xd578_73dc_79fb_94b6]);
///
/// // One stream for each of a thousand workers, none like another.
/// let workers: Vec<SeedSequence> = seed.spawn(1000).collect();
/// assert_eq!(workers[7], seed.child(7));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SeedSequence {
    pool: [u32; 4],
    /// The multiplier of the next `hash`; it moves on with each.
    hash_multiplier: u32,
    /// How many children were spawned.
    spawned: u64,
}

const SHIFT: u32 = 16;

impl SeedSequence {
    /// The sequence of the integer whose 32-bit digits are `words`, the lowest first; none are 0, and
    /// zeros at the high end do not count.
    ///
    /// For seeds beyond 64 bits: `from` takes a `u64`, and with `std` a text of decimal digits can be
    /// parsed.
    ///
    /// ```
    /// use acrobot::SeedSequence;
    ///
    /// assert_eq!(SeedSequence::from_words(&[7, 1]), SeedSequence::from((1 << 32) + 7));
    /// assert_eq!(SeedSequence::from_words(&[]), SeedSequence::from(0));
    /// ```
    #[must_use]
    #[expect(
        clippy::indexing_slicing,
        reason = "the pool has four words, and 0..4 is below"
    )]
    #[inline(never)] // for flash, as `hash`, which stands sixteen times in it
    pub fn from_words(words: &[u32]) -> Self {
        let mut sequence = Self {
            pool: [0; 4],
            hash_multiplier: 0x43b0_d7e5,
            spawned: 0,
        };
        let end = words
            .iter()
            .rposition(|&word| word != 0)
            .map_or(0, |last| last + 1);
        let mut words = words.iter().copied().take(end);
        for i in 0..4 {
            sequence.pool[i] = sequence.hash(words.next().unwrap_or(0));
        }
        for source in 0..4 {
            for target in 0..4 {
                if source != target {
                    let hashed = sequence.hash(sequence.pool[source]);
                    sequence.pool[target] = mix(sequence.pool[target], hashed);
                }
            }
        }
        words.for_each(|word| sequence.absorb(word));
        sequence
    }

    /// NumPy's `spawn(n)`: the next `n` children, each with a stream of its own. The children of
    /// a later call are others. There are 2⁶⁴ − 1 of them in all.
    pub fn spawn(&mut self, n: u64) -> impl Iterator<Item = Self> + use<> {
        let parent = self.clone();
        self.spawned = parent.spawned.saturating_add(n);
        (parent.spawned..self.spawned).map(move |index| parent.child(index))
    }

    /// The child of that index, counted from 0 over all calls of [`spawn`](Self::spawn): for a
    /// worker that knows its number and nothing of the others.
    #[must_use]
    pub fn child(&self, index: u64) -> Self {
        let mut child = Self {
            spawned: 0,
            ..self.clone()
        };
        let [low, high] = [index as u32, (index >> 32) as u32];
        child.absorb(low);
        if high != 0 {
            child.absorb(high);
        }
        child
    }

    /// The first `N` words of 64 bits that the sequence generates; always the same ones.
    #[must_use]
    pub fn generate_state<const N: usize>(&self) -> [u64; N] {
        let mut multiplier = 0x8b51_f9dd_u32;
        let mut pool = self.pool.into_iter().cycle();
        let mut word = || {
            let mut word = pool.next().unwrap_or(0) ^ multiplier;
            multiplier = multiplier.wrapping_mul(0x58f3_8ded);
            word = word.wrapping_mul(multiplier);
            u64::from(word ^ (word >> SHIFT))
        };
        [(); N].map(|()| word() | (word() << 32))
    }

    /// Mixes one more word of entropy into the whole pool.
    fn absorb(&mut self, word: u32) {
        let pool = self.pool;
        self.pool = pool.map(|target| mix(target, self.hash(word)));
    }

    #[inline(never)]
    fn hash(&mut self, word: u32) -> u32 {
        let word = word ^ self.hash_multiplier;
        self.hash_multiplier = self.hash_multiplier.wrapping_mul(0x931e_8875);
        let word = word.wrapping_mul(self.hash_multiplier);
        word ^ (word >> SHIFT)
    }
}

impl From<u64> for SeedSequence {
    fn from(seed: u64) -> Self {
        Self::from_words(&[seed as u32, (seed >> 32) as u32])
    }
}

#[cfg(feature = "std")]
impl std::str::FromStr for SeedSequence {
    type Err = crate::Error;

    /// The sequence of an integer in decimal digits, as many as there are.
    ///
    /// # Errors
    ///
    /// [`Error::MalformedSeed`](crate::Error::MalformedSeed) with the first character that is not a
    /// digit.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let mut words = std::vec::Vec::new();
        for (found, position) in text.chars().zip(1..) {
            let malformed = crate::Error::MalformedSeed {
                found: Some(found),
                position,
            };
            let mut carry = u64::from(found.to_digit(10).ok_or(malformed)?);
            for word in &mut words {
                carry += u64::from(*word) * 10;
                *word = carry as u32;
                carry >>= 32;
            }
            if carry != 0 {
                words.push(carry as u32);
            }
        }
        if text.is_empty() {
            return Err(crate::Error::MalformedSeed {
                found: None,
                position: 1,
            });
        }
        Ok(Self::from_words(&words))
    }
}

fn mix(x: u32, y: u32) -> u32 {
    let mixed = x
        .wrapping_mul(0xca01_f9dd)
        .wrapping_sub(y.wrapping_mul(0x4973_f715));
    mixed ^ (mixed >> SHIFT)
}
