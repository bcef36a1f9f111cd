//! `f64`, correctly rounded: for each x one `f64` is nearest to sin x.
//!
//! A fast path computes about ten bits more than an `f64` has, with a proven error bound. If the
//! result is farther from half way between two `f64` than that bound, the nearest `f64` is certain.
//! Otherwise, for one result in 300 to 400, a slow path computes 192 bits. Source: A. Ziv, *Fast
//! Evaluation of Elementary Mathematical Functions with Correctly Rounded Last Bit* (1991).
//!
//! | x | method |
//! |---|---|
//! | \|x\| < 2⁻²⁷ | sin x rounds to x and cos x to 1: x³/6 and x²/2 are at most a quarter of the last place |
//! | \|x\| < 64, with instructions for `f64` | `float.rs`: a table, and sums of two `f64` |
//! | \|x\| < 64, elsewhere | `integer.rs`: polynomials in 64-bit integers |
//! | other finite x, and results that the fast paths leave open | `wide.rs`: Taylor's series in 192 bits |
//! | infinity, NaN | NaN |
//!
//! The two fast paths return the same bits, because only one result is correct. The files list
//! their errors term by term. `tests/data/sines.py` derives the constants, adds up the errors, and
//! records 21 million results of MPFR for `cargo test --test sines`.

mod float;
mod integer;
mod wide;

use super::{HAS_F64, HAS_SIMD};
use crate::math::lanes::Numbers;

/// 2⁻²⁷.
const TINY: f64 = 1.0 / 134_217_728.0;

/// Sine and cosine, correctly rounded. NaN for infinity and NaN.
#[inline(always)]
pub fn sin_cos<V: Numbers<f64>>(x: V) -> (V, V) {
    if V::IS_ONE {
        return x.map_unzip(of_one);
    }
    let (sin, cos) = x.map_unzip(|x| {
        if !HAS_SIMD {
            return of_one(x);
        }
        let angle = float::Angle::new(x);
        let sin = or_nan(x, angle.sin());
        let sin = if x.abs() < TINY { x } else { sin };
        (sin, or_nan(x, angle.cos()))
    });
    complete(x, sin, cos)
}

/// Cosine, correctly rounded; otherwise as [`sin_cos`].
#[inline(always)]
pub fn cos<V: Numbers<f64>>(x: V) -> V {
    if V::IS_ONE {
        return x.map(cos_of_one);
    }
    let cos =
        x.map(|x| if HAS_SIMD { or_nan(x, float::Angle::new(x).cos()) } else { cos_of_one(x) });
    complete(x, V::splat(0.0), cos).1
}

/// NaN for what the table leaves open: SIMD has no branch for a lane.
#[inline(always)]
fn or_nan(x: f64, y: Option<f64>) -> f64 {
    let y = y.unwrap_or(f64::NAN);
    if x.abs() < 64.0 { y } else { f64::NAN }
}

/// Replaces the lanes that are NaN.
#[inline(always)]
fn complete<V: Numbers<f64>>(x: V, sin: V, cos: V) -> (V, V) {
    #[cold]
    #[inline(never)]
    fn each<V: Numbers<f64>>(x: V, sin: V, cos: V) -> (V, V) {
        let one = |x: f64, y: f64, quarters| match (y.is_nan(), x.is_finite()) {
            (true, true) => wide::sine(x, quarters),
            _ => y,
        };
        x.zip3(sin, cos, |x, sin, cos| (one(x, sin, 0), one(x, cos, 1)))
    }
    let one = V::splat(1.0);
    if sin.all_abs_le(one) & cos.all_abs_le(one) { (sin, cos) } else { each(x, sin, cos) }
}

#[inline(always)]
fn of_one(x: f64) -> (f64, f64) {
    if !has_fast_path(x) {
        return apart(x);
    }
    let [sin, cos] = if HAS_F64 {
        let angle = float::Angle::new(x);
        [angle.sin(), angle.cos()]
    } else {
        let angle = integer::Angle::new(x);
        [angle.sin(), angle.cos()]
    };
    (sin.unwrap_or_else(|| wide::sine(x, 0)), cos.unwrap_or_else(|| wide::sine(x, 1)))
}

#[inline(always)]
fn cos_of_one(x: f64) -> f64 {
    if !has_fast_path(x) {
        return apart(x).1;
    }
    let cos = if HAS_F64 { float::Angle::new(x).cos() } else { integer::Angle::new(x).cos() };
    cos.unwrap_or_else(|| wide::sine(x, 1))
}

/// Whether |x| is from 2⁻²⁷ to 64.
#[inline(always)]
fn has_fast_path(x: f64) -> bool {
    let exponent = (x.to_bits() >> 52) as u32 % 2048;
    (1023 - 27..1023 + 6).contains(&exponent)
}

/// Sine and cosine of an x without a fast path.
#[cold]
#[inline(never)]
fn apart(x: f64) -> (f64, f64) {
    if x.abs() < 1.0 {
        (x, 1.0)
    } else if x.is_finite() {
        (wide::sine(x, 0), wide::sine(x, 1))
    } else {
        (f64::NAN, f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::lanes::Lanes;
    use crate::numpy::{Pcg64, uniform};

    /// A machine uses only one of the two fast paths. This test runs both.
    #[test]
    fn all_paths_agree() {
        let mut rng = Pcg64::new(0);
        // Miri is slow.
        for i in 0..if cfg!(miri) { 50 } else { 1_000_000_u32 } {
            let x = match i % 4 {
                0 => uniform(&mut rng, -64.0, 64.0),
                1 => uniform(&mut rng, -3.2, 3.2),
                2 => f64::from(i % 79) * core::f64::consts::FRAC_PI_4 * 0.5,
                _ => uniform(&mut rng, -1.0, 1.0) / f64::from(1 << (i % 26)),
            };
            if !has_fast_path(x) {
                continue;
            }
            let (float, integer) = (float::Angle::new(x), integer::Angle::new(x));
            let fast = [[float.sin(), integer.sin()], [float.cos(), integer.cos()]];
            for (quarters, fast) in (0..).zip(fast) {
                let expected = wide::sine(x, quarters);
                for y in fast.into_iter().flatten() {
                    assert_eq!(y.to_bits(), expected.to_bits(), "{x:e}");
                }
            }
        }
    }

    /// With SIMD lanes take the table.
    #[test]
    fn lanes_equal_single_numbers() {
        let mut rng = Pcg64::new(1);
        let ends = [0.0, TINY, 64.0, f64::INFINITY, f64::NAN];
        for i in 0..if cfg!(miri) { 50 } else { 200_000_u32 } {
            let scale = f64::from(1 << (i % 29)) / f64::from(1 << (i % 23));
            let end = ends.get(i as usize % 8).unwrap_or(&1.0);
            let near_end = f64::from_bits(end.to_bits().wrapping_sub(u64::from(i / 8 % 2)));
            let random = uniform(&mut rng, -scale, scale);
            let x = [random, -near_end, 3.0 * random, near_end];
            let (cos_alone, (sin, cos)) = (cos(Lanes(x)), sin_cos(Lanes(x)));
            for (lane, x) in x.into_iter().enumerate() {
                let expected = of_one(x);
                let bits = |y: f64| if y.is_nan() { 1 } else { y.to_bits() };
                let found = [sin.0[lane], cos.0[lane], cos_alone.0[lane]].map(bits);
                let expected = [expected.0, expected.1, expected.1].map(bits);
                assert_eq!(found, expected, "{x:e}");
            }
        }
    }
}
