//! Noise that is nearly normal, for lanes side by side.

use rand_core::Rng;

use crate::arithmetic::{Numbers, Real};

/// A counter and its stride: whole numbers below [`PERIOD`], which `f32` has exactly.
pub(super) type Noise = [f32; 2];

/// How many numbers a counter has.
pub(super) const PERIOD: u32 = 1 << 23;

/// A generator for one acrobot. Two acrobots share one with a probability of 2⁻⁴⁵.
pub(super) fn seed<S: Real, R: Rng + ?Sized>(rng: &mut R) -> [S; 2] {
    // An odd stride visits each number.
    [rng.next_u32(), rng.next_u32() | 1].map(|x| S::from_f64(f64::from(x % PERIOD)))
}

/// A draw with a mean of 0 and a standard deviation of 1: the sum of four uniform draws of 16 bits.
/// It is at most 3.46, and its fourth moment is 2.7 where that of a normal distribution is 3. A
/// draw from PCG64 would take ten times as long, because it has no lanes.
#[inline(always)]
pub(super) fn normal<S: Real, V: Numbers<S>>([counter, stride]: &mut [V; 2]) -> V {
    let mut sum = V::splat(S::ZERO);
    for _ in 0..2 {
        *counter = counter.zip(*stride, |counter, stride| {
            let next = counter + stride;
            let period = S::from_f64(f64::from(PERIOD));
            if next >= period { next - period } else { next }
        });
        sum = sum
            + counter.zip(*stride, |counter, stride| {
                let bits = mix(whole(counter) ^ (whole(stride) << 9));
                S::from_f64(f64::from(((bits & 0xffff) + (bits >> 16)) as i32))
            });
    }
    let unit = V::splat(S::from_f64(1.732_050_807_568_877_2 / 65_536.0)); // √3 / 2¹⁶
    (sum - V::splat(S::from_f64(2.0 * 65_535.0))) * unit
}

/// The bits of a whole number below [`PERIOD`], as the fraction of a number from [`PERIOD`] on:
/// SSE2 has no conversion to `u32`.
#[inline(always)]
fn whole<S: Real>(x: S) -> u32 {
    (x.to_f64() as f32 + PERIOD as f32).to_bits()
}

/// Mixes the bits of a counter: `lowbias32` of Chris Wellons, from his hash-prospector.
#[inline(always)]
fn mix(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}
