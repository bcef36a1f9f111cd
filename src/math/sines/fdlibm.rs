//! `f64` by the polynomials of Sun's `fdlibm`, without a branch, for SIMD: bit-identical to the
//! crate `libm` 0.2.16, which is FreeBSD's in Rust.
//!
//! Let n be the integer nearest to x · 2/π and y + tail = x − n π/2, so that |y| ≤ π/4. The
//! polynomials approximate sine and cosine of y, and each has a term for the tail.

use super::{HAS_F64, HAS_SIMD};
use crate::math::lanes::Numbers;
use crate::math::real::sealed::Sealed as _;

/// `libm` computes where it reduces x in another way:
///
/// - |y| > π/4 − 1e-5, where it finds n from the upper 32 bits of x;
/// - |y| < 2⁻¹⁵ |x|, where it subtracts more digits of π/2, and so all |x| above 25,736.
#[inline(always)]
pub fn sin_cos<V: Numbers<f64>>(x: V) -> (V, V) {
    /// π/2: its leading 33 bits, and the rest.
    const PI_2_HIGH: f64 = f64::from_bits(0x3ff9_21fb_5440_0000);
    const PI_2_LOW: f64 = f64::from_bits(0x3dd0_b461_1a62_6331);

    let c = V::splat;
    let largest = c(core::f64::consts::FRAC_PI_4 - 1e-5);
    let is_fast = if V::IS_ONE { HAS_F64 } else { HAS_SIMD };
    if !is_fast {
        // `libm` has branches instead, so it needs fewer instructions.
        return x.map_unzip(libm::sincos);
    }
    if V::IS_ONE && x.all_abs_le(largest) {
        // A branch is faster than the reduction, for which one number has to wait.
        return x.map_unzip(|x| reduced(f64::MAGIC, x, 0.0));
    }
    let shifted = x * c(core::f64::consts::FRAC_2_PI) + c(f64::MAGIC);
    let n = shifted - c(f64::MAGIC);
    let high = x - n * c(PI_2_HIGH);
    let low = n * c(PI_2_LOW);
    let y = high - low;
    let tail = (high - y) - low;
    let least = x * c(1.0 / 32_768.0);
    if y.all_abs_le(largest) & least.all_abs_le(y.map(f64::abs)) {
        shifted.zip3(y, tail, reduced)
    } else {
        by_libm(x)
    }
}

#[cold]
#[inline(never)]
fn by_libm<V: Numbers<f64>>(x: V) -> (V, V) {
    x.map_unzip(libm::sincos)
}

/// Sine and cosine of y + `tail` + n π/2. The lowest bits of `shifted` are those of n.
#[inline(always)]
fn reduced(shifted: f64, y: f64, tail: f64) -> (f64, f64) {
    /// sin y = y + y³ (S0 + S1 y² + …), and cos y = 1 − y²/2 + y⁴ (C0 + C1 y² + …): `k_sin.c` and
    /// `k_cos.c` of FreeBSD.
    const S: [f64; 6] = [
        f64::from_bits(0xbfc5_5555_5555_5549),
        f64::from_bits(0x3f81_1111_1110_f8a6),
        f64::from_bits(0xbf2a_01a0_19c1_61d5),
        f64::from_bits(0x3ec7_1de3_57b1_fe7d),
        f64::from_bits(0xbe5a_e5e6_8a2b_9ceb),
        f64::from_bits(0x3de5_d93a_5acf_d57c),
    ];
    const C: [f64; 6] = [
        f64::from_bits(0x3fa5_5555_5555_554c),
        f64::from_bits(0xbf56_c16c_16c1_5177),
        f64::from_bits(0x3efa_01a0_19cb_1590),
        f64::from_bits(0xbe92_7e4f_809c_52ad),
        f64::from_bits(0x3e21_ee9e_bdb4_b1c4),
        f64::from_bits(0xbda8_fae9_be88_38d4),
    ];
    const SIGN: u64 = 1 << 63;

    let z = y * y;
    let w = z * z;
    let r = S[1] + z * (S[2] + z * S[3]) + z * w * (S[4] + z * S[5]);
    let cube = z * y;
    // `libm` has another order where it does not reduce x. The sum with the tail, which is 0 there,
    // keeps the sign of −0.
    let rest = if shifted == f64::MAGIC {
        tail - cube * (S[0] + z * r)
    } else {
        (z * (0.5 * tail - cube * r) - tail) - cube * S[0]
    };
    let sin = y - rest;

    let r = z * (C[0] + z * (C[1] + z * C[2])) + w * w * (C[3] + z * (C[4] + z * C[5]));
    let half = 0.5 * z;
    let high = 1.0 - half;
    let cos = high + (((1.0 - high) - half) + (z * r - y * tail));

    // By 0 to 3 quarter turns. One changes (sin, cos) to (cos, −sin).
    let turns = shifted.to_bits();
    let even = (turns & 1).wrapping_sub(1);
    let kept = (sin.to_bits() ^ cos.to_bits()) & even;
    let turned_sin = cos.to_bits() ^ kept ^ (turns << 62 & SIGN);
    let turned_cos = sin.to_bits() ^ kept ^ (turns.wrapping_add(1) << 62 & SIGN);
    (f64::from_bits(turned_sin), f64::from_bits(turned_cos))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::lanes::Lanes;
    use crate::numpy::{Pcg64, uniform};
    use rand_core::Rng;

    /// With optimization these are 20 million arguments.
    #[test]
    fn numbers_and_lanes_equal_libm() {
        const N: usize = 4;
        let count = match (cfg!(miri), cfg!(debug_assertions)) {
            (true, _) => 50,
            (_, true) => 500_000,
            _ => 20_000_000 / N,
        };
        let mut rng = Pcg64::new(0);
        for i in 0..count {
            // The lanes of other blocks all have a short way.
            let spread = 1.0 / (1_u64 << (i % 64)) as f64;
            let x = [(); N].map(|()| match rng.next_u32() % if i % 2 == 0 { 2 } else { 8 } {
                0 => uniform(&mut rng, -spread, spread),
                1 => uniform(&mut rng, -4.0, 4.0),
                2 => uniform(&mut rng, -30_000.0, 30_000.0),
                3 => f64::from_bits(rng.next_u64()),
                _ => {
                    let multiple = rng.next_u32() as i32 >> (8 + i % 24);
                    let multiple = f64::from(multiple) * core::f64::consts::FRAC_PI_4;
                    multiple + uniform(&mut rng, -spread, spread)
                }
            });
            check(x);
        }
        // The last two are so near a multiple of π/2 that `libm` subtracts more digits of it.
        let near = [7.854_038_625_652_270_5, 48.695_046_946_962_93];
        for x in [0.0, -0.0, f64::MIN_POSITIVE, -5e-324].into_iter().chain(near) {
            check([x; N]);
        }
    }

    fn check<const N: usize>(x: [f64; N]) {
        let (sin, cos) = sin_cos(Lanes(x));
        for (x, lane) in x.into_iter().zip(sin.0.into_iter().zip(cos.0)) {
            let expected = libm::sincos(x);
            for (sin, cos) in [lane, sin_cos(x)] {
                let are_equal =
                    |x: f64, y: f64| x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan();
                assert!(
                    are_equal(sin, expected.0) && are_equal(cos, expected.1),
                    "{x:e}: {sin:e} {cos:e}"
                );
            }
        }
    }
}
