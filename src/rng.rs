//! NumPy's PCG64 and the draws that Gymnasium makes from it.

use core::convert::Infallible;
use core::num::NonZeroU32;

use rand_core::{Rng, SeedableRng, TryRng};

use crate::seed::SeedSequence;

/// NumPy's `PCG64`, the generator of every Gymnasium environment and space: `rand_pcg`'s, seeded
/// through a [`SeedSequence`], and with NumPy's way of making two 32-bit draws of one of 64 bits.
///
/// It is `Clone`, so that it can be saved and resumed, and never `Copy`, so that no stream is
/// drawn from twice by accident. With the `serde` feature it can be stored.
///
/// ```
/// use acrobot::{Pcg64, uniform};
///
/// let mut np_random = Pcg64::new(42);
/// assert_eq!(uniform(&mut np_random, 0.0, 1.0), 0.7739560485559633);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pcg64 {
    generator: rand_pcg::Pcg64,
    /// The high half of a 64-bit draw of which only the low half was used.
    half: Option<u32>,
}

impl Pcg64 {
    /// The generator that NumPy's `default_rng(seed)` is, from an integer or a [`SeedSequence`].
    #[must_use]
    pub fn new(seed: impl Into<SeedSequence>) -> Self {
        let [state1, state0, stream1, stream0] = seed.into().generate_state().map(u128::from);
        Self {
            generator: rand_pcg::Pcg64::new((state1 << 64) | state0, (stream1 << 64) | stream0),
            half: None,
        }
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
        let both = self.generator.next_u64();
        self.half = Some((both >> 32) as u32);
        Ok(both as u32)
    }

    #[inline]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        self.generator.try_next_u64()
    }

    #[inline]
    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        self.generator.try_fill_bytes(bytes)
    }
}

impl SeedableRng for Pcg64 {
    type Seed = [u8; 32];

    /// State and stream themselves, as `rand_pcg` takes them; NumPy has no such seed.
    fn from_seed(seed: Self::Seed) -> Self {
        Self {
            generator: rand_pcg::Pcg64::from_seed(seed),
            half: None,
        }
    }

    /// [`Pcg64::new`]: NumPy's stream of that seed, and not the one that `rand_core` would expand
    /// it to.
    fn seed_from_u64(seed: u64) -> Self {
        Self::new(seed)
    }
}

/// NumPy's `Generator.uniform(low, high)`: a draw from \[`low`, `high`), of 53 random bits.
#[inline]
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

#[cfg(feature = "defmt")]
impl defmt::Format for Pcg64 {
    /// Its name alone: `rand_pcg` shows its state to nobody but `serde`.
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "Pcg64");
    }
}

#[cfg(feature = "serde")]
mod snapshot {
    use serde::de::value::{Error as ValueError, SeqDeserializer};
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Serialize, Serializer};

    use super::Pcg64;

    /// What `rand_pcg` writes of its generator, and the half that is kept beside it.
    #[derive(serde::Deserialize)]
    struct Stored {
        generator: Generator,
        half: Option<u32>,
    }

    #[derive(serde::Deserialize)]
    struct Generator {
        state: u128,
        increment: u128,
    }

    impl Serialize for Pcg64 {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            #[derive(serde::Serialize)]
            struct Stored<'a> {
                generator: &'a rand_pcg::Pcg64,
                half: Option<u32>,
            }
            let Self { generator, half } = self;
            Stored {
                generator,
                half: *half,
            }
            .serialize(serializer)
        }
    }

    impl<'de> Deserialize<'de> for Pcg64 {
        /// Refuses an even increment, which would cut the generator's period short.
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let Stored { generator, half } = Stored::deserialize(deserializer)?;
            let Generator { state, increment } = generator;
            if increment % 2 == 0 {
                return Err(D::Error::custom(format_args!(
                    "increment is {increment}; allowed is an odd number"
                )));
            }
            let fields = SeqDeserializer::<_, ValueError>::new([state, increment].into_iter());
            let generator = rand_pcg::Pcg64::deserialize(fields).map_err(D::Error::custom)?;
            Ok(Self { generator, half })
        }
    }
}
