//! NumPy's PCG64 and the draws that Gymnasium makes from it.

use core::convert::Infallible;
use core::num::NonZeroU32;

use rand_core::utils::{fill_bytes_via_next_word, read_words};
use rand_core::{Rng, SeedableRng, TryRng};

use crate::seed::SeedSequence;

/// NumPy's `PCG64`, the generator of every Gymnasium environment and space: PCG XSL-RR 128/64,
/// seeded through a [`SeedSequence`], with NumPy's way of making two 32-bit draws of one of 64 bits.
///
/// It is `Clone`, so that it can be saved and resumed, and never `Copy`, so that no stream is
/// drawn from twice by accident. With the `serde` feature it can be stored.
///
/// `rand_pcg` has the same generator, but shows its state to nobody but its own `serde` feature,
/// which needs std. Source: M. E. O'Neill, *PCG: A Family of Simple Fast Space-Efficient
/// Statistically Good Algorithms for Random Number Generation* (2014).
///
/// ```
/// use acrobot::{Pcg64, uniform};
///
/// let mut np_random = Pcg64::new(42);
/// assert_eq!(uniform(&mut np_random, 0.0, 1.0), 0.7739560485559633);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Pcg64 {
    state: u128,
    /// Odd, or the period would be short.
    increment: u128,
    /// The high half of a 64-bit draw of which only the low half was used.
    half: Option<u32>,
}

impl Pcg64 {
    /// Memory for a generator that is yet to be seeded, as by a [`Batch`](crate::Batch): a stream of
    /// low quality.
    pub const UNSEEDED: Self = Self {
        state: 0,
        increment: 1,
        half: None,
    };

    /// The generator that NumPy's `default_rng(seed)` is, from an integer or a [`SeedSequence`].
    #[must_use]
    pub fn new(seed: impl Into<SeedSequence>) -> Self {
        let [state1, state0, stream1, stream0] = seed.into().generate_state().map(u128::from);
        let increment = (((stream1 << 64) | stream0) << 1) | 1;
        let mut pcg = Self {
            state: increment.wrapping_add((state1 << 64) | state0),
            increment,
            half: None,
        };
        pcg.advance();
        pcg
    }

    /// One step of the linear congruential generator underneath.
    #[inline]
    fn advance(&mut self) {
        const MULTIPLIER: u128 = 0x2360_ed05_1fc6_5da4_4385_df64_9fcc_f645;
        self.state = self
            .state
            .wrapping_mul(MULTIPLIER)
            .wrapping_add(self.increment);
    }
}

impl TryRng for Pcg64 {
    type Error = Infallible;

    /// The low half of a new 64-bit draw, or the high half that the last call left.
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

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        fill_bytes_via_next_word(bytes, || self.try_next_u64())
    }
}

impl SeedableRng for Pcg64 {
    type Seed = [u8; 32];

    /// [`Pcg64::new`] of the integer that these bytes are, the lowest first.
    fn from_seed(seed: Self::Seed) -> Self {
        let words: [u32; 8] = read_words(&seed);
        Self::new(SeedSequence::from_words(&words))
    }

    /// [`Pcg64::new`]: NumPy's stream of that seed, and not the one that `rand_core` would expand
    /// it to.
    fn seed_from_u64(seed: u64) -> Self {
        Self::new(seed)
    }
}

/// NumPy's `Generator.uniform(low, high)`: a draw from \[`low`, `high`), of 53 random bits. The
/// difference of the two must be finite.
#[inline(never)] // for flash: an acrobot draws four at each start
pub fn uniform<R: Rng + ?Sized>(rng: &mut R, low: f64, high: f64) -> f64 {
    let unit = (rng.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64);
    low + (high - low) * unit
}

/// NumPy's `Generator.integers(n)`: a draw from 0 to `n` − 1, all equally likely.
///
/// Lemire's method (<https://arxiv.org/abs/1805.10941>) on 32-bit draws. Of a generator that keeps
/// returning what must be rejected, the 64th draw is taken, so that this ends with any.
#[inline]
pub fn integers<R: Rng + ?Sized>(rng: &mut R, n: NonZeroU32) -> u32 {
    // NumPy draws nothing where there is nothing to choose.
    if n.get() == 1 {
        return 0;
    }
    let mut product = 0;
    for _ in 0..64 {
        product = u64::from(rng.next_u32()) * u64::from(n.get());
        // 2³² mod n: so many of the lowest products would be drawn once too often.
        if product as u32 >= n.get() || product as u32 >= n.get().wrapping_neg() % n {
            break;
        }
    }
    (product >> 32) as u32
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for Pcg64 {
    /// Refuses an even increment.
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(serde::Deserialize)]
        #[serde(rename = "Pcg64")]
        struct Snapshot {
            state: u128,
            increment: u128,
            // Not left out: that would be another stream, and not an older snapshot.
            #[serde(deserialize_with = "Option::deserialize")]
            half: Option<u32>,
        }

        let Snapshot {
            state,
            increment,
            half,
        } = Snapshot::deserialize(deserializer)?;
        if increment % 2 == 0 {
            let reason = format_args!("increment is {increment}; allowed is an odd number");
            return Err(serde::de::Error::custom(reason));
        }
        Ok(Self {
            state,
            increment,
            half,
        })
    }
}
