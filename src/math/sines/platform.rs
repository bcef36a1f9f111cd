//! `f64` by the platform's C library.
#![expect(clippy::disallowed_methods, reason = "this file calls the library")]

use core::hint::black_box;

/// C's `sin` and `cos`.
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    x.sin_cos()
}

/// C's `cos`.
#[inline(always)]
pub fn cos(x: f64) -> f64 {
    x.cos()
}

/// NumPy computes `x**2` of a scalar by C's `pow`. For one argument in a thousand, whose exact
/// square is about half way between two doubles, glibc's `pow` rounds differently from `x * x`.
#[inline(always)]
pub fn square(x: f64) -> f64 {
    if is_far_from_a_tie(x) { x * x } else { power(x) }
}

#[cold]
fn power(x: f64) -> f64 {
    // LLVM replaces the call by `x * x` if it sees the exponent.
    x.powf(black_box(2.0))
}

/// Whether `pow(x, 2.0)` certainly equals `x * x`: x is moderate, and its exact square is far from
/// half way between two doubles.
///
/// glibc's source (`e_pow.c`) bounds the error of `pow` by 0.511 units in the last place and by 2⁵³
/// × 1.5 × 2⁻⁶⁸ |2 ln x|, below 0.004 for |x| of 2⁻⁶⁰ to 2⁶⁰. So `pow` rounds correctly if half way
/// is more than 0.015 units from the square; this requires 0.02. An integer product gives the bits
/// of the square beyond its last place, which is faster than floats without a fused multiply-add.
#[inline(always)]
fn is_far_from_a_tie(x: f64) -> bool {
    /// 0.02 units, where 2⁶⁴ is one unit.
    const NEAR: u64 = (0.02 * 18_446_744_073_709_551_616.0) as u64;
    const fn mantissa(x: f64) -> u64 {
        (x.to_bits() & ((1 << 52) - 1)) | (1 << 52)
    }

    let is_moderate = (x.to_bits() << 1).wrapping_sub((1023 - 60) << 53) < 120 << 53;
    let mantissa_of_x = mantissa(x);
    // From √2 on, the square of the mantissa has one more bit before its last place.
    let kept = if mantissa_of_x > mantissa(core::f64::consts::SQRT_2) { 11 } else { 12 };
    let rest = mantissa_of_x.wrapping_mul(mantissa_of_x) << kept;
    is_moderate & (rest.wrapping_sub((1 << 63) - NEAR) > 2 * NEAR)
}
