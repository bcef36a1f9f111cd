//! f32 with a polynomial kernel of its own, in the lean form: for FPUs of single precision, WASM
//! and SIMD.

use super::{Arithmetic, FARTHEST, Form, Numbers};

/// `f32` and polynomial trigonometry, in the lean form: the same bits on every target, from a
/// single-precision FPU without a fused multiply-add.
///
/// ```
/// use acrobot::{Arithmetic, Fast};
///
/// let (sin, cos) = Fast::sin_cos(1.0);
/// assert!((sin - 0.84147098).abs() < 1.2e-7 && (cos - 0.54030231).abs() < 1.2e-7);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fast;

impl Arithmetic for Fast {
    type Scalar = f32;
    const FORM: Form = Form::Lean;

    /// Sine and cosine, each within 1.2e-7 (two units in the last place of 1) of the true value for
    /// |x| ≤ 64 rad: 1.17e-7 is the worst over all those `f32`
    /// (`cargo test --release --test trigonometry`). Farther out the error is that of an angle in
    /// `f32`, 1.2e-7 |x|, up to 2¹⁹ rad, whose value stands for all beyond.
    #[inline]
    fn sin_cos(x: f32) -> (f32, f32) {
        kernel(x.clamp(-FARTHEST, FARTHEST))
    }

    #[inline(always)]
    fn sin_cos_near(x: f32) -> (f32, f32) {
        kernel(x)
    }
}

/// Cody-Waite reduction to a quarter turn about the nearest multiple of π/2, and two polynomials
/// there. It needs no more than two constants: `quadrant` has at most 6 bits for |x| ≤ 64 and
/// `PI_2_HIGH` 18, so that their product is exact.
#[inline(always)]
pub(crate) fn kernel<V: QuarterTurns>(x: V) -> (V, V) {
    /// The leading 18 bits of π/2, and the rest.
    const PI_2_HIGH: f32 = f32::from_bits(0x3fc9_0fc0);
    const PI_2_LOW: f32 = (core::f64::consts::FRAC_PI_2 - PI_2_HIGH as f64) as f32;
    /// 1.5 × 2²³: a sum with it is rounded to a whole number, which stands in its lowest bits.
    const MAGIC: f32 = 12_582_912.0;
    /// Minimax over |r| ≤ π/4, each rounded to f32 before the next was fitted
    /// (`tests/data/polynomials.py`): to 1.8e-9 for sin r = r + r³(S0 + S1 r² + S2 r⁴),
    const S: [f32; 3] = [
        f32::from_bits(0xbe2a_aaa0),
        f32::from_bits(0x3c08_82df),
        f32::from_bits(0xb94c_6e8b),
    ];
    /// and to 3.3e-8 for cos r = 1 + C0 r² + C1 r⁴ + C2 r⁶.
    const C: [f32; 3] = [
        f32::from_bits(0xbeff_ffdd),
        f32::from_bits(0x3d2a_9fd5),
        f32::from_bits(0xbab2_3c11),
    ];

    let c = V::splat;
    let shifted = x * c(core::f32::consts::FRAC_2_PI) + c(MAGIC);
    let multiple = shifted - c(MAGIC);
    let r = (x - multiple * c(PI_2_HIGH)) - multiple * c(PI_2_LOW);

    let z = r * r;
    let sin = r + (r * z) * (c(S[0]) + z * (c(S[1]) + z * c(S[2])));
    let cos = c(1.0) + z * (c(C[0]) + z * (c(C[1]) + z * c(C[2])));
    V::rotate(shifted, sin, cos)
}

/// Numbers that can be turned by quarters.
pub(crate) trait QuarterTurns: Numbers<f32> {
    /// The sine and cosine of an angle, after so many quarter turns more as the lowest bits of
    /// `turns` say: each takes (sin, cos) to (cos, −sin).
    fn rotate(turns: Self, sin: Self, cos: Self) -> (Self, Self);
}

impl QuarterTurns for f32 {
    /// By the sine and the cosine of the quarter turns: exact because they are 0 and ±1, and cheaper
    /// on a Cortex-M than to pick, swap and negate. No −0 is lost: `sin` is never −0, `cos` never 0.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "the index is 0 to 3")]
    fn rotate(turns: Self, sin: Self, cos: Self) -> (Self, Self) {
        const SINES: [f32; 5] = [0.0, 1.0, 0.0, -1.0, 0.0];
        let i = (turns.to_bits() & 3) as usize;
        let (turned_sin, turned_cos) = (SINES[i], SINES[i + 1]);
        (
            sin * turned_cos + cos * turned_sin,
            cos * turned_cos - sin * turned_sin,
        )
    }
}
