//! The fast path for machines that emulate `f64`: 64-bit integers.
//!
//! All numbers are fractions with 64 or 128 bits after the point. A unit is 2⁻⁶⁴. An interval says
//! by how many units a number may be too high or, if negative, too low. `tests/data/sines.py`
//! derives the coefficients and these bounds.
//!
//! - Reduction: the product of x's mantissa and 2/π gives the octant and its fraction φ, where |x|
//!   = (octant + φ) π/4, or (octant + 1 − φ) π/4 if the octant is odd. The upper 128 bits of the
//!   product are at most 4 · 2⁻¹²⁸ too low. Shifting to the point and to the first digit of φ
//!   enlarges this to at most a quarter of a unit, because |x| is below 2⁶ and a φ below 2⁻⁵⁴ is
//!   left to the slow path.
//! - w = φ² from the upper 64 bits of φ: \[−5, 0\].
//! - sin x = φ S(w) and cos x = 1 − w T(w), with polynomials S and T of degree 7. They differ from
//!   the functions by \[−0.8, −0.5\] and \[−1.2, −1.1\], and Horner's scheme adds \[−0.2, 1.5\].
//!   Their first coefficients are a unit lower than the best ones, which centres the sum.
//! - The last product keeps 128 bits, so a small φ costs no precision. The 64 bits from its first
//!   digit on are the mantissa.
//!
//! In total, a mantissa is less than 3 units off. For one in 410 the last 11 bits are so near half
//! way that the slow path decides.

use super::wide::TWO_OVER_PI;

/// The coefficients of S, whose signs alternate. They have 64, 67, 71, 76, 76, 76, 68 and 68 bits
/// after the point: the last ones are small and need fewer bits.
static SIN: [u64; 8] = [
    0xc90f_daa2_2168_c234,
    0xa55d_e731_2df2_95c2,
    0x519a_f19d_d6ab_5760,
    0x265a_599c_c552_0fe8,
    0x0054_1e0d_2167_95da,
    0x0000_78c1_d2ca_0f9c,
    0x0000_0000_7a3b_b0fd,
    0x0000_0000_005b_16e2,
];

/// The coefficients of T.
static COS: [u64; 8] = [
    0x4ef4_f326_f917_7968,
    0x2078_3e10_36b5_8764,
    0x0aae_9e3f_1e5f_fae7,
    0x03c3_ea0d_1235_8d73,
    0x0006_9b47_ca81_9bcc,
    0x0000_07e7_4e1b_b1bf,
    0x0000_0000_06db_7a08,
    0x0000_0000_0004_79d1,
];

/// The error of a mantissa is below this.
const ERROR: u64 = 3;

/// The angle x, reduced for both functions.
pub(super) struct Angle {
    /// The sign of x, in the highest bit.
    sign: u64,
    octant: u32,
    /// φ, the upper word first.
    fraction: [u64; 2],
    /// w.
    square: u64,
}

impl Angle {
    /// For |x| from 2⁻²⁷ to 64.
    #[inline(always)]
    pub(super) fn new(x: f64) -> Self {
        let exponent = (x.to_bits() >> 52) as u32 % 2048;
        let mantissa = x.to_bits() << 11 | 1 << 63;
        let [upper, lower, ..] = TWO_OVER_PI;
        // |x| 4/π = product 2^(exponent − 1021). The remainders tell the compiler that a shift is
        // below 32.
        let product = full(mantissa, upper) + u128::from(high(mantissa, lower));
        let (octant, fraction) = if exponent > 1021 {
            let shift = (exponent - 1021) % 32; // 1 to 7
            let octant = (product >> 96) as u32 >> ((32 - shift) % 32);
            let flip = i128::from(octant % 2).wrapping_neg() as u128;
            (octant, product << shift ^ flip)
        } else {
            (0, product >> ((1021 - exponent) % 32))
        };
        let upper = (fraction >> 64) as u64;
        Self {
            sign: x.to_bits() & 1 << 63,
            octant,
            fraction: [upper, fraction as u64],
            square: high(upper, upper),
        }
    }

    /// sin x, correctly rounded, or `None` if it is too near half way between two `f64`.
    #[inline(always)]
    pub(super) fn sin(&self) -> Option<f64> {
        self.sine(0, self.sign)
    }

    /// cos x; otherwise as [`sin`](Self::sin).
    #[inline(always)]
    pub(super) fn cos(&self) -> Option<f64> {
        self.sine(1, 0)
    }

    #[inline(always)]
    fn sine(&self, quarters: u32, sign: u64) -> Option<f64> {
        let quadrant = self.octant.div_ceil(2) + quarters;
        let sign = sign ^ u64::from(quadrant & 2) << 62;
        if quadrant % 2 == 1 {
            let rest = full(self.square, polynomial(&COS, self.square));
            return round(!((rest >> 64) as u64), 1021, sign);
        }
        let [upper, lower] = self.fraction;
        let series = polynomial(&SIN, self.square);
        let mut product = full(upper, series) + u128::from(high(lower, series));
        let mut exponent = 1021;
        if product >> 96 == 0 {
            if product >> 73 == 0 {
                return None; // φ is below 2⁻⁵⁴
            }
            product <<= 32;
            exponent -= 32;
        }
        let zeros = ((product >> 96) as u32).leading_zeros();
        let mantissa = ((product << (zeros % 32)) >> 64) as u64;
        round(mantissa, exponent - zeros, sign ^ u64::from(self.octant) << 63)
    }
}

#[inline(never)] // saves flash
fn polynomial(coefficients: &[u64; 8], w: u64) -> u64 {
    let [c0, c1, c2, c3, c4, c5, c6, c7] = *coefficients;
    let p = c6 - ((c7 * (w >> 32)) >> 32);
    let p = c5 - ((p * (w >> 32)) >> 24);
    let p = c4 - high(p, w);
    let p = c3 - high(p, w);
    let p = c2 - (high(p, w) >> 5);
    let p = c1 - (high(p, w) >> 4);
    c0 - (high(p, w) >> 3)
}

/// The `f64` nearest to `mantissa` 2⁻⁶⁴ 2^(exponent − 1021), or `None` if undecided.
#[inline(always)]
fn round(mantissa: u64, exponent: u32, sign: u64) -> Option<f64> {
    /// Half a unit of the 53rd bit.
    const HALF: u64 = 1 << 10;
    let to_half = mantissa.wrapping_sub(HALF - (ERROR - 1)) % (2 * HALF);
    if to_half <= 2 * (ERROR - 1) {
        return None;
    }
    // The highest bit of the mantissa adds 1 to the exponent, and so does a carry.
    let magnitude = (u64::from(exponent) << 52) + (mantissa >> 11) + (mantissa >> 10) % 2;
    Some(f64::from_bits(sign | magnitude))
}

#[inline(always)]
fn full(a: u64, b: u64) -> u128 {
    u128::from(a) * u128::from(b)
}

/// The upper half of the product, less than 3 too low. The exact one takes a fourth multiplication,
/// and carries.
#[inline(always)]
fn high(a: u64, b: u64) -> u64 {
    let [a1, a0, b1, b0] = [a >> 32, a << 32 >> 32, b >> 32, b << 32 >> 32];
    a1 * b1 + ((a1 * b0) >> 32) + ((a0 * b1) >> 32)
}
