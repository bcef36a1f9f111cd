//! The fast path for machines with instructions for `f64`: a table of sines, and sums of two `f64`.
//!
//! Let n be the integer nearest to x · 128/π, a = n π/128 and b = x − a, so that |b| ≤ π/256. Then
//!
//! sin x = sin a + cos a · b + sin a (cos b − 1) + cos a (sin b − b).
//!
//! The cosine has cos a in place of sin a, and −sin a in place of cos a. The first two terms need
//! more than 53 bits. The others are below 2⁻¹³. The errors, term by term:
//!
//! - b: three `f64` hold 41, 39 and 53 bits of π/128. The products of n < 2¹² with the first two
//!   are exact. So are the differences from x, except that the last may round; `tail` holds this
//!   rounding error and the third product. The error of b + tail is below 2⁻¹²⁷. It matters most
//!   where the result is about b. An x below 64 is at least 2⁻⁶¹ from each multiple of π/2 except
//!   0, so the error is below 2⁻⁶⁶ of the result.
//! - sin a and cos a: an `f64` of 26 bits plus an `f64` with the rest, error below 2⁻⁷⁹. The
//!   product of the 26 bits and the upper 26 bits of b is exact. The rounding error of adding it to
//!   sin a is computed exactly, because |sin a| is 0 or above |b|.
//! - sin a (cos b − 1): Taylor's series to b⁶, and 5 roundings of numbers below 2⁻¹³ sin a. This is
//!   most of the error.
//! - cos a (sin b − b): Taylor's series to b⁷, and 6 roundings of numbers below 2⁻²¹.
//! - The sum of the small terms: 3 roundings of numbers below 2⁻¹³.
//!
//! `tests/data/sines.py` adds up the errors for each a. The sum is below 2⁻⁶² of the result, which
//! is the margin of the rounding test. One result in 320 is within the margin.

use super::wide::{Fraction, octant_sine};
use crate::math::real::sealed::Sealed as _;

/// sin(i π/128): its leading 26 bits, and the rest.
static SINES: [[f64; 2]; 320] = sines();

#[expect(clippy::indexing_slicing, reason = "evaluated by the compiler")]
const fn sines() -> [[f64; 2]; 320] {
    let mut table = [[0.0; 2]; 320];
    let mut i = 0;
    while i < 320 {
        // Mirrored to within a quarter turn.
        let index = if i % 128 > 64 { 128 - i % 128 } else { i % 128 };
        let [high, low] = match index as u64 {
            0 => [0.0; 2],
            32 => split(&octant_sine(&[u64::MAX; 3], false)),
            64 => [1.0, 0.0],
            index @ ..32 => split(&octant_sine(&[index << 59, 0, 0], false)),
            index => split(&octant_sine(&[(64 - index) << 59, 0, 0], true)),
        };
        table[i] = if i % 256 < 128 { [high, low] } else { [-high, -low] };
        i += 1;
    }
    table
}

/// The leading 26 bits of a number above 2⁻⁶, and the rest.
const fn split(&[first, second, _]: &Fraction) -> [f64; 2] {
    const UNIT: f64 = 1.0 / (1_u128 << 64) as f64;
    let high = first & !0 << (38 - first.leading_zeros());
    let rest = ((first - high) as u128) << 64 | second as u128;
    [high as f64 * UNIT, rest as f64 * UNIT * UNIT]
}

/// The angle x, reduced for both functions.
pub(super) struct Angle {
    /// n, reduced to one turn.
    index: usize,
    /// b, its upper 26 bits, and the rest of it.
    b: [f64; 3],
    /// cos b − 1.
    cos_rest: f64,
    /// sin b − b, with the tail of b.
    sin_rest: f64,
}

impl Angle {
    /// For |x| from 2⁻²⁷ to 64.
    #[inline(always)]
    pub(super) fn new(x: f64) -> Self {
        const STEPS: f64 = 128.0 * core::f64::consts::FRAC_1_PI;
        /// π/128: 41 bits, 39 bits and the rest.
        const STEP: [f64; 3] = [
            f64::from_bits(0x3f99_21fb_5444_2000),
            f64::from_bits(0x3d0a_308d_3131_8000),
            f64::from_bits(0x3a88_a2e0_3707_344a),
        ];

        let shifted = x * STEPS + f64::MAGIC;
        let n = shifted - f64::MAGIC;
        let near = x - n * STEP[0];
        let middle = n * STEP[1];
        let b = near - middle;
        let tail = ((near - b) - middle) - n * STEP[2];
        let upper = f64::from_bits(b.to_bits() & !0 << 27);
        let z = b * b;
        Self {
            index: shifted.to_bits() as usize % 256,
            b: [b, upper, b - upper],
            cos_rest: z * (-1.0 / 2.0 + z * (1.0 / 24.0 - z * (1.0 / 720.0))),
            sin_rest: tail + b * z * (-1.0 / 6.0 + z * (1.0 / 120.0 - z * (1.0 / 5040.0))),
        }
    }

    /// sin x, correctly rounded, or `None` if it is too near half way between two `f64`.
    #[inline(always)]
    pub(super) fn sin(&self) -> Option<f64> {
        let [sin, cos] = self.look_up();
        self.rotate(sin, cos)
    }

    /// cos x; otherwise as [`sin`](Self::sin).
    #[inline(always)]
    pub(super) fn cos(&self) -> Option<f64> {
        let [sin, cos] = self.look_up();
        self.rotate(cos, sin.map(|x| -x))
    }

    /// sin a and cos a.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "the index is 0 to 255")]
    fn look_up(&self) -> [[f64; 2]; 2] {
        [SINES[self.index], SINES[self.index + 64]]
    }

    #[inline(always)]
    fn rotate(&self, sin: [f64; 2], cos: [f64; 2]) -> Option<f64> {
        const MARGIN: f64 = 1.0 / (1_u64 << 62) as f64;
        let [b, upper, lower] = self.b;
        let exact = cos[0] * upper;
        let high = sin[0] + exact;
        let lost = (sin[0] - high) + exact;
        let linear = sin[1] + (cos[0] * lower + cos[1] * b);
        let small =
            (sin[0] + sin[1]) * self.cos_rest + (linear + (cos[0] + cos[1]) * self.sin_rest);
        let low = lost + small;
        let sum = high + (low + high * MARGIN);
        (sum == high + (low - high * MARGIN)).then_some(sum)
    }
}
