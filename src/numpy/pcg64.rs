//! NumPy's PCG64.

use core::convert::Infallible;

use rand_core::{Rng, SeedableRng, TryRng};

use super::SeedSequence;

/// NumPy's `PCG64`, the generator of every Gymnasium environment and space: PCG XSL-RR 128/64, seeded through
/// a [`SeedSequence`]. Like NumPy, it takes two 32-bit draws from one of 64 bits.
///
/// It is `Clone`, so that it can be saved and resumed, and not `Copy`, so that no stream is drawn from twice by
/// accident. With the `serde` feature it can be stored.
///
/// `rand_pcg` has the same generator but shows its state only to its own `serde` feature, which needs std.
/// Source: M. E. O'Neill, *PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random
/// Number Generation* (2014).
///
/// ```
/// use acrobot::numpy::{Pcg64, uniform};
///
/// static SEEDED_BY_THE_COMPILER: Pcg64 = Pcg64::new(42);
///
/// let mut np_random = SEEDED_BY_THE_COMPILER.clone();
/// assert_eq!(uniform(&mut np_random, 0.0, 1.0), 0.7739560485559633);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pcg64 {
    state: u128,
    /// Odd, otherwise the period is short.
    increment: u128,
    /// The high half of a 64-bit draw whose low half was used.
    half: Option<u32>,
    #[cfg(feature = "serde")]
    origin: snapshot::Origin,
}

impl Pcg64 {
    /// A placeholder that a [`Batch`](crate::batch::Batch) seeds. Its own stream is of low quality.
    pub const UNSEEDED: Self = Self::from_hash([0; 4]);

    /// NumPy's `default_rng(seed)`. For other seeds: `Pcg64::from` a [`SeedSequence`].
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self::from_hash(SeedSequence::new(seed).generate_state())
    }

    /// The generator of a seed with this hash. Any hash makes a valid generator.
    const fn from_hash(hash: [u64; 4]) -> Self {
        let [state1, state0, stream1, stream0] = hash;
        let increment = (join(stream1, stream0) << 1) | 1;
        let state = increment.wrapping_add(join(state1, state0));
        Self {
            state: state.wrapping_mul(MULTIPLIER).wrapping_add(increment),
            increment,
            half: None,
            #[cfg(feature = "serde")]
            origin: snapshot::Origin { hash, position: 0 },
        }
    }

    /// One step of the underlying linear congruential generator.
    #[inline]
    fn advance(&mut self) {
        self.state = self
            .state
            .wrapping_mul(MULTIPLIER)
            .wrapping_add(self.increment);
        #[cfg(feature = "serde")]
        self.origin.advance(1);
    }
}

const MULTIPLIER: u128 = 0x2360_ed05_1fc6_5da4_4385_df64_9fcc_f645;

const fn join(high: u64, low: u64) -> u128 {
    ((high as u128) << 64) | low as u128
}

impl From<SeedSequence> for Pcg64 {
    /// NumPy's `default_rng(sequence)`.
    fn from(sequence: SeedSequence) -> Self {
        Self::from_hash(sequence.generate_state())
    }
}

impl TryRng for Pcg64 {
    type Error = Infallible;

    /// The low half of a new 64-bit draw, or the high half left by the last call.
    #[inline]
    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        if let Some(high) = self.half.take() {
            return Ok(high);
        }
        let both = self.next_u64();
        self.half = Some((both >> 32) as u32);
        Ok(both as u32)
    }

    #[inline]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        self.advance();
        let folded = (self.state >> 64) as u64 ^ self.state as u64;
        Ok(folded.rotate_right((self.state >> 122) as u32))
    }

    // rand_core's `fill_bytes_via_next_word` has a division that panics by zero, which some compilers keep.
    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        let (words, rest) = bytes.as_chunks_mut();
        for word in words {
            *word = self.next_u64().to_le_bytes();
        }
        if !rest.is_empty() {
            let last = self.next_u64().to_le_bytes();
            rest.iter_mut().zip(last).for_each(|(to, byte)| *to = byte);
        }
        Ok(())
    }
}

impl SeedableRng for Pcg64 {
    type Seed = [u8; 32];

    /// The generator of the integer with these bytes, the lowest first.
    fn from_seed(seed: Self::Seed) -> Self {
        let mut words = [0; 8];
        for (word, bytes) in words.iter_mut().zip(seed.as_chunks().0) {
            *word = u32::from_le_bytes(*bytes);
        }
        SeedSequence::from_words(&words).into()
    }

    /// [`Pcg64::new`]: NumPy's stream of this seed, not the one that `rand_core` would derive.
    fn seed_from_u64(seed: u64) -> Self {
        Self::new(seed)
    }
}

#[cfg(feature = "serde")]
mod snapshot {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::{MULTIPLIER, Pcg64};

    /// Where a generator comes from. It is what a snapshot holds, because any of these makes a valid generator.
    #[derive(Clone, Debug, PartialEq, Eq)]
    #[cfg_attr(feature = "defmt", derive(defmt::Format))]
    pub struct Origin {
        /// The hash of the seed.
        pub hash: [u64; 4],
        /// How many 64-bit draws were made since.
        pub position: u64,
    }

    impl Origin {
        #[inline]
        pub fn advance(&mut self, draws: u64) {
            self.position = self.position.wrapping_add(draws);
        }
    }

    /// Only numbers that every format holds: TOML has no integers above 2⁶³, JavaScript none above 2⁵³, and others no
    /// 128 bits. No field is optional, because some formats leave those out.
    #[derive(Serialize, Deserialize)]
    #[serde(rename = "Pcg64")]
    struct Snapshot {
        /// The hash of the seed, in halves: the lower before the upper.
        seed: [u32; 8],
        position: u64,
        has_half: bool,
        half: u32,
    }

    impl Serialize for Pcg64 {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let [a, b, c, d] = self
                .origin
                .hash
                .map(|word| [word as u32, (word >> 32) as u32]);
            Snapshot {
                seed: [a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1]],
                position: self.origin.position,
                has_half: self.half.is_some(),
                half: self.half.unwrap_or_default(),
            }
            .serialize(serializer)
        }
    }

    impl<'de> Deserialize<'de> for Pcg64 {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let Snapshot {
                seed: [a, b, c, d, e, f, g, h],
                position,
                has_half,
                half,
            } = Snapshot::deserialize(deserializer)?;
            let hash = [[a, b], [c, d], [e, f], [g, h]];
            let mut pcg =
                Self::from_hash(hash.map(|[low, high]| u64::from(high) << 32 | u64::from(low)));
            pcg.skip(position);
            pcg.half = has_half.then_some(half);
            Ok(pcg)
        }
    }

    impl Pcg64 {
        /// Advances by many draws at once. x → a x + c, applied twice, is x → a² x + (a + 1) c.
        fn skip(&mut self, draws: u64) {
            let (mut a, mut c) = (MULTIPLIER, self.increment);
            for bit in 0..u64::BITS {
                if draws >> bit & 1 == 1 {
                    self.state = self.state.wrapping_mul(a).wrapping_add(c);
                }
                c = a.wrapping_add(1).wrapping_mul(c);
                a = a.wrapping_mul(a);
            }
            self.origin.advance(draws);
        }
    }
}
