//! `f32` by a table: the fewest instructions on a microcontroller.

use core::f32::consts::{FRAC_1_PI, PI};

use crate::math::real::sealed::Sealed as _;

/// A table gives sine and cosine of the nearest multiple of π/16, and polynomials those of the
/// remainder `r`. The addition theorem combines them.
#[inline(always)]
pub fn sin_cos(x: f32) -> (f32, f32) {
    const STEP: f32 = PI / 16.0;
    /// sin r = r + S r³, error 9.9e-9, and cos r = 1 + C r², error 6.6e-7: minimax over |r| ≤ π/32
    /// (`tests/data/polynomials.py`).
    const S: f32 = f32::from_bits(0xbe2a_985f);
    const C: f32 = f32::from_bits(0xbeff_d468);

    let shifted = x * (16.0 * FRAC_1_PI) + f32::MAGIC;
    let multiple = shifted - f32::MAGIC;
    let r = x - multiple * STEP;
    let z = r * r;
    let sin = r + (r * z) * S;
    let cos = 1.0 + z * C;

    let (multiple_sin, multiple_cos) = sixteenths(shifted.to_bits());
    (multiple_sin * cos + multiple_cos * sin, multiple_cos * cos - multiple_sin * sin)
}

/// Sine and cosine of `number` sixteenths of half a turn.
#[inline(always)]
#[expect(clippy::indexing_slicing, reason = "the index is 0 to 31")]
fn sixteenths(number: u32) -> (f32, f32) {
    /// Sines over one turn, and over a quarter turn more for the cosines.
    static SINES: [f32; 40] = sines();
    let i = (number & 31) as usize;
    (SINES[i], SINES[i + 8])
}

#[expect(clippy::indexing_slicing, reason = "evaluated by the compiler")]
const fn sines() -> [f32; 40] {
    /// Sines from 0 to a quarter turn, each rounded to the nearest `f32`
    /// (`tests/data/polynomials.py`).
    const QUARTER: [u32; 9] = [
        0x0000_0000,
        0x3e47_c5c2,
        0x3ec3_ef15,
        0x3f0e_39da,
        0x3f35_04f3,
        0x3f54_db31,
        0x3f6c_835e,
        0x3f7b_14be,
        0x3f80_0000,
    ];
    let mut sines = [0.0; 40];
    let mut i = 0;
    while i < 40 {
        let within_half = i % 16;
        let from_zero = if within_half < 8 { within_half } else { 16 - within_half };
        let sine = f32::from_bits(QUARTER[from_zero]);
        sines[i] = if i % 32 < 16 { sine } else { 0.0 - sine };
        i += 1;
    }
    sines
}
