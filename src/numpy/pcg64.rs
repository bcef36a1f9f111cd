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
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Pcg64 {
    state: u128,
    /// Odd, otherwise the period is short.
    increment: u128,
    /// The high half of a 64-bit draw whose low half was used.
    half: Option<u32>,
}

impl Pcg64 {
    /// A placeholder that a [`Batch`](crate::batch::Batch) seeds. Its own stream is of low quality.
    pub const UNSEEDED: Self = Self {
        state: 0,
        increment: 1,
        half: None,
    };

    /// NumPy's `default_rng(seed)`. For other seeds: `Pcg64::from` a [`SeedSequence`].
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self::from_sequence(&SeedSequence::new(seed))
    }

    const fn from_sequence(sequence: &SeedSequence) -> Self {
        let [state1, state0, stream1, stream0] = sequence.generate_state();
        let increment = (join(stream1, stream0) << 1) | 1;
        let mut pcg = Self {
            state: increment.wrapping_add(join(state1, state0)),
            increment,
            half: None,
        };
        pcg.advance();
        pcg
    }

    /// One step of the underlying linear congruential generator.
    #[inline]
    const fn advance(&mut self) {
        const MULTIPLIER: u128 = 0x2360_ed05_1fc6_5da4_4385_df64_9fcc_f645;
        self.state = self
            .state
            .wrapping_mul(MULTIPLIER)
            .wrapping_add(self.increment);
    }
}

const fn join(high: u64, low: u64) -> u128 {
    ((high as u128) << 64) | low as u128
}

impl From<SeedSequence> for Pcg64 {
    /// NumPy's `default_rng(sequence)`.
    fn from(sequence: SeedSequence) -> Self {
        Self::from_sequence(&sequence)
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
        Self::from_sequence(&SeedSequence::from_words(&words))
    }

    /// [`Pcg64::new`]: NumPy's stream of this seed, not the one that `rand_core` would derive.
    fn seed_from_u64(seed: u64) -> Self {
        Self::new(seed)
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for Pcg64 {
    /// Rejects an even increment.
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(serde::Deserialize)]
        #[serde(rename = "Pcg64")]
        struct Snapshot {
            state: u128,
            increment: u128,
            // Must be present: without it the stream would be another.
            #[serde(deserialize_with = "Option::deserialize")]
            half: Option<u32>,
        }

        let Snapshot {
            state,
            increment,
            half,
        } = Snapshot::deserialize(deserializer)?;
        if increment % 2 == 0 {
            let reason = format_args!("increment must be odd, got {increment}");
            return Err(serde::de::Error::custom(reason));
        }
        Ok(Self {
            state,
            increment,
            half,
        })
    }
}
