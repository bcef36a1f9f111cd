//! NumPy's random numbers: the same streams as `np.random`, from the same seeds.
//!
//! Gymnasium seeds each environment and each space with NumPy's `default_rng(seed)`. [`Pcg64`] is
//! that generator, which rand's `Pcg64` seeds differently.
//!
//! ```
//! use acrobot::numpy::{Pcg64, uniform};
//!
//! // np.random.default_rng(42).uniform(0.0, 1.0)
//! assert_eq!(uniform(&mut Pcg64::new(42), 0.0, 1.0), 0.7739560485559633);
//! ```

mod pcg64;
mod seed_sequence;

use core::num::NonZeroU32;

use rand_core::Rng;

pub use pcg64::Pcg64;
pub use seed_sequence::SeedSequence;

/// NumPy's `Generator.uniform(low, high)`: draws from \[`low`, `high`) with 53 random bits. The
/// difference of the bounds must be finite. As in NumPy, rounding can give `high` itself.
#[inline(never)] // saves flash: a reset draws four
pub fn uniform<R: Rng + ?Sized>(rng: &mut R, low: f64, high: f64) -> f64 {
    let unit = (rng.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64);
    low + (high - low) * unit
}

/// NumPy's `Generator.integers(n)`: draws one of 0 to `n` − 1, all equally likely.
///
/// This is Lemire's method (<https://arxiv.org/abs/1805.10941>) on 32-bit draws. After 64 rejected
/// draws, which only a broken generator produces, it takes the last one.
#[inline]
pub fn integers<R: Rng + ?Sized>(rng: &mut R, n: NonZeroU32) -> u32 {
    // Like NumPy, draw nothing if there is only one result.
    if n.get() == 1 {
        return 0;
    }
    let mut product = 0;
    for _ in 0..64 {
        product = u64::from(rng.next_u32()) * u64::from(n.get());
        // Rejects the lowest 2³² mod n products, which would make some results more likely than
        // others.
        if product as u32 >= n.get() || product as u32 >= n.get().wrapping_neg() % n {
            break;
        }
    }
    (product >> 32) as u32
}
