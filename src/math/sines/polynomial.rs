//! `f32` by two polynomials: for single-precision FPUs, WASM and SIMD.

use crate::math::lanes::Numbers;
use crate::math::real::sealed::Sealed as _;

/// Cody-Waite reduction to the nearest multiple of π/2, then two polynomials. Two constants
/// suffice: for
/// |x| ≤ 64 the multiple has at most 6 bits and `PI_2_HIGH` has 18, so their product is exact.
#[inline(always)]
pub fn sin_cos<V: Numbers<f32>>(x: V) -> (V, V) {
    /// π/2: its leading 18 bits, and the rest.
    const PI_2_HIGH: f32 = f32::from_bits(0x3fc9_0fc0);
    const PI_2_LOW: f32 = (core::f64::consts::FRAC_PI_2 - PI_2_HIGH as f64) as f32;
    /// sin r = r + r³(S0 + S1 r² + S2 r⁴), error 1.8e-9. Minimax over |r| ≤ π/4, each coefficient
    /// rounded to `f32` before the next was fitted (`tests/data/polynomials.py`).
    const S: [f32; 3] =
        [f32::from_bits(0xbe2a_aaa0), f32::from_bits(0x3c08_82df), f32::from_bits(0xb94c_6e8b)];
    /// cos r = 1 + C0 r² + C1 r⁴ + C2 r⁶, error 3.3e-8. Fitted as `S`.
    const C: [f32; 3] =
        [f32::from_bits(0xbeff_ffdd), f32::from_bits(0x3d2a_9fd5), f32::from_bits(0xbab2_3c11)];

    let c = V::splat;
    let shifted = x * c(core::f32::consts::FRAC_2_PI) + c(f32::MAGIC);
    let multiple = shifted - c(f32::MAGIC);
    let r = (x - multiple * c(PI_2_HIGH)) - multiple * c(PI_2_LOW);

    let z = r * r;
    let sin = r + (r * z) * (c(S[0]) + z * (c(S[1]) + z * c(S[2])));
    let cos = c(1.0) + z * (c(C[0]) + z * (c(C[1]) + z * c(C[2])));

    // By 0 to 3 quarter turns, the two lowest bits of `shifted`. One changes (sin, cos) to (cos,
    // −sin).
    shifted.zip3(sin, cos, |shifted, sin, cos| {
        let turns = shifted.to_bits();
        if !V::IS_ONE {
            rotate_by_bits(turns, sin, cos)
        } else if HAS_F32 {
            rotate_by_products(turns, sin, cos)
        } else {
            rotate_by_selection(turns, sin, cos)
        }
    })
}

/// Whether the target may have instructions for `f32`. Results do not depend on it.
const HAS_F32: bool = !cfg!(any(
    all(target_arch = "arm", target_abi = "eabi"),
    // Stable Rust does not tell whether RISC-V has the extension F. All its targets with F also
    // have A.
    all(target_arch = "riscv32", not(target_feature = "a")),
));

/// Uses the addition theorem, which is cheaper on an FPU than selecting and negating. No −0 is
/// lost: `sin` is never −0, `cos` never 0.
#[inline(always)]
#[expect(clippy::indexing_slicing, reason = "the index is 0 to 3")]
fn rotate_by_products(turns: u32, sin: f32, cos: f32) -> (f32, f32) {
    const SINES: [f32; 5] = [0.0, 1.0, 0.0, -1.0, 0.0];
    let i = (turns & 3) as usize;
    let (turned_sin, turned_cos) = (SINES[i], SINES[i + 1]);
    (sin * turned_cos + cos * turned_sin, cos * turned_cos - sin * turned_sin)
}

/// Selects and negates: without an FPU that saves four products and two sums. No −0 results, as
/// from the products.
#[inline(always)]
fn rotate_by_selection(turns: u32, sin: f32, cos: f32) -> (f32, f32) {
    let minus_sin = if sin.to_bits() == 0 { sin } else { -sin };
    match turns & 3 {
        0 => (sin, cos),
        1 => (cos, minus_sin),
        2 => (minus_sin, -cos),
        _ => (-cos, sin),
    }
}

/// Selects and flips signs, without a branch or a table: for SIMD. Adding 0 changes −0 to 0, which
/// is the result for a single `f32`.
#[inline(always)]
fn rotate_by_bits(turns: u32, sin: f32, cos: f32) -> (f32, f32) {
    const SIGN: u32 = 1 << 31;
    let even = (turns & 1).wrapping_sub(1);
    let kept = (sin.to_bits() ^ cos.to_bits()) & even;
    let turned_sin = cos.to_bits() ^ kept ^ (turns << 30 & SIGN);
    let turned_cos = sin.to_bits() ^ kept ^ (turns.wrapping_add(1) << 30 & SIGN);
    (f32::from_bits(turned_sin) + 0.0, f32::from_bits(turned_cos) + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A target uses only one for a single number. This test runs all.
    #[test]
    fn all_rotations_agree() {
        for i in -100..=100 {
            let angle = i as f32 / 128.0;
            // Within a quarter turn about 0 nothing is rotated.
            let (sin, cos) = sin_cos(angle);
            for turns in 0..8 {
                let [products, selection, bits] =
                    [rotate_by_products, rotate_by_selection, rotate_by_bits]
                        .map(|rotate| rotate(turns, sin, cos))
                        .map(|(sin, cos)| [sin, cos].map(f32::to_bits));
                assert_eq!(products, selection, "{angle} {turns}");
                assert_eq!(products, bits, "{angle} {turns}");
            }
        }
    }
}
