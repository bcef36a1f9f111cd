//! Twice the digits of `f64`: a number is the sum of two.

use core::ops::{Add, Mul};

use crate::math::matrix::Matrix;

/// The sum of two `f64`, the second at most half a unit in the last place of the first.
///
/// The error of a sum or a product is at most 2⁻¹⁰² times that of the absolute values (M. Joldes,
/// J.-M. Muller and V. Popescu, *Tight and Rigorous Error Bounds for Basic Building Blocks of
/// Double-Word Arithmetic*, 2017), while nothing overflows or underflows.
#[derive(Clone, Copy, Debug)]
pub struct Double(f64, f64);

pub const ONE: Double = Double(1.0, 0.0);
pub const MINUS_ONE: Double = Double(-1.0, 0.0);

#[inline(never)] // saves flash
pub fn widen(m: &Matrix) -> Matrix<Double> {
    m.map(|row| row.map(Double::from))
}

#[inline(never)]
pub fn narrow(m: &Matrix<Double>) -> Matrix {
    m.map(|row| row.map(f64::from))
}

impl From<f64> for Double {
    fn from(x: f64) -> Self {
        Self(x, 0.0)
    }
}

impl From<Double> for f64 {
    fn from(x: Double) -> Self {
        x.0
    }
}

impl Add for Double {
    type Output = Self;

    #[inline(never)]
    fn add(self, other: Self) -> Self {
        // The rounding error of the sum, which is an `f64` (D. Knuth).
        let sum = self.0 + other.0;
        let added = sum - self.0;
        let lost = (self.0 - (sum - added)) + (other.0 - added);
        normalize(sum, lost + (self.1 + other.1))
    }
}

impl Mul for Double {
    type Output = Self;

    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        // The rounding error of the product, from exact products of half as many digits (T. J.
        // Dekker).
        let ([a, b], [c, d]) = (split(self.0), split(other.0));
        let product = self.0 * other.0;
        let lost = ((a * c - product) + a * d + b * c) + b * d;
        normalize(product, lost + (self.0 * other.1 + self.1 * other.0))
    }
}

fn normalize(high: f64, low: f64) -> Double {
    let sum = high + low;
    Double(sum, low - (sum - high))
}

/// The upper 26 bits and the rest, which has as many with its sign.
fn split(x: f64) -> [f64; 2] {
    let scaled = x * ((1_u32 << 27) + 1) as f64;
    let high = scaled - (scaled - x);
    [high, x - high]
}
