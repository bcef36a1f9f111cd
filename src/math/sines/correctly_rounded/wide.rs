//! Sine and cosine in 192 bits: the slow path.
//!
//! - Reduction: |x| = m 2ᵖ with an integer m below 2⁵³. The product of m and 384 bits of 2/π gives
//!   the octant and 192 bits of its fraction, with an error below 2⁻²⁰⁰. Earlier bits of 2/π
//!   contribute whole turns only.
//! - Series: Taylor's, to the term of r⁴⁷, with r ≤ π/4. The next term is below 2⁻²¹⁸.
//! - Rounding: each operation drops less than 2⁻¹⁹². The sum of all errors is below 2⁻¹⁸⁸.
//!
//! Why 192 bits suffice: the sine and the cosine of an `f64` other than 0 are transcendental
//! (Lindemann), so they are never half way between two `f64`. An error of 2⁻¹⁸⁸ can matter only if
//! a result is that near half way. No theorem excludes such a result, but it is improbable. There
//! are 2⁶³ pairs of a function and an |x| from 2⁻²⁷ on. One pair in 2ᶻ has a result of about 2⁻ᶻ,
//! where two neighbouring `f64` are 2⁻⁵³⁻ᶻ apart, so it is misrounded with a probability of 2 ·
//! 2⁻¹⁸⁸ / 2⁻⁵³⁻ᶻ. The sum over all pairs, with z up to 62, is below 2⁻⁶⁴.

/// A number in [0, 1): the 192 bits after the point, the highest word first.
pub(super) type Fraction = [u64; 3];

/// 2/π, with enough bits for any `f64`.
pub(super) static TWO_OVER_PI: [u64; 21] = [
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
    0x0649_2eea_09d1_921c,
    0xfe1d_eb1c_b129_a73e,
    0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41,
    0x3991_d639_8353_39f4,
    0x9c84_5f8b_bdf9_283b,
    0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f,
    0x6d36_7ecf_27cb_09b7,
    0x4f46_3f66_9e5f_ea2d,
    0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea,
    0x6bfb_5fb1_1f8d_5d08,
    0x5603_3046_fc7b_6bab,
    0xf0cf_bc20_9af4_361d,
    0xa9e3_9161_5ee6_1b08,
];

const QUARTER_PI: Fraction = [0xc90f_daa2_2168_c234, 0xc4c6_628b_80dc_1cd1, 0x2902_4e08_8a67_cc74];

/// 1/n! for n from 2 to 47, in pairs of an even n and the next odd n.
const INVERSE_FACTORIALS: &[[Fraction; 2]] = &inverse_factorials();

#[expect(clippy::indexing_slicing, reason = "evaluated by the compiler")]
const fn inverse_factorials() -> [[Fraction; 2]; 23] {
    let mut table = [[[0; 3]; 2]; 23];
    let mut inverse = [u64::MAX; 3];
    let mut n = 2;
    while n < 48 {
        let mut remainder = 0;
        let mut i = 0;
        while i < 3 {
            let dividend = remainder << 64 | inverse[i] as u128;
            inverse[i] = (dividend / n as u128) as u64;
            remainder = dividend % n as u128;
            i += 1;
        }
        table[n / 2 - 1][n % 2] = inverse;
        n += 1;
    }
    table
}

/// sin(x + `quarters` π/2), correctly rounded, for `quarters` of 0 or 1 and any finite |x| from
/// 2⁻²⁷ on.
#[cold]
#[inline(never)]
pub(super) fn sine(x: f64, quarters: u64) -> f64 {
    let (octant, fraction) = reduce(x);
    let quadrant = octant.div_ceil(2) + quarters;
    let is_cosine = quadrant % 2 == 1;
    let magnitude = round(octant_sine(&fraction, is_cosine));
    let is_negative = (quadrant & 2 != 0)
        ^ (!is_cosine && octant % 2 == 1)
        ^ (quarters == 0 && x.is_sign_negative());
    if is_negative { -magnitude } else { magnitude }
}

/// Up to whole turns, |x| = (octant + fraction) π/4, or (octant + 1 − fraction) π/4 if the octant
/// is odd.
fn reduce(x: f64) -> (u64, Fraction) {
    // |x| 4/π = mantissa 2/π · 2^(shift − 1152)
    let shift = (x.to_bits() >> 52) as usize % 2048 + 78;
    let mantissa = u128::from((x.to_bits() % (1 << 52)) | (1 << 52)) << (shift % 64);
    let words = shift / 64; // 16 to 33
    // Products with earlier words are multiples of 2⁶⁴ octants.
    let first = words.saturating_sub(19);
    let mut window = [0; 6];
    for (word, known) in window.iter_mut().zip(TWO_OVER_PI.iter().skip(first)) {
        *word = *known;
    }
    let mut product = [0; 8];
    let factors = [mantissa as u64, (mantissa >> 64) as u64];
    for (place, factor) in factors.into_iter().enumerate() {
        let mut carry = 0;
        let words = window.iter().rev().chain(&[0]);
        for (sum, word) in product.iter_mut().rev().skip(place).zip(words) {
            (carry, *sum) = multiply_add(factor, *word, *sum, carry);
        }
    }
    let whole_words = words - first - 16; // 0 to 3
    let octant = match whole_words.checked_sub(1) {
        Some(last) => product.get(last).map_or(0, |word| word % 8),
        None => 0,
    };
    let flip = (octant % 2).wrapping_neg();
    let mut fraction = [0; 3];
    for (word, known) in fraction.iter_mut().zip(product.iter().skip(whole_words)) {
        *word = known ^ flip;
    }
    (octant, fraction)
}

/// Sine or cosine of `fraction` π/4.
pub(super) const fn octant_sine(fraction: &Fraction, is_cosine: bool) -> Fraction {
    let r = product(fraction, &QUARTER_PI);
    let square = product(&r, &r);
    // sin r = r − r (r²/3! − r⁴/5! + …), cos r = 1 − (r²/2! − r⁴/4! + …)
    let mut sum = [0; 3];
    let mut terms = INVERSE_FACTORIALS;
    while let [smaller @ .., [even, odd]] = terms {
        let term = if is_cosine { even } else { odd };
        sum = product(&difference(term, &sum), &square); // the first factor has leading zeros
        terms = smaller;
    }
    if is_cosine { difference(&[u64::MAX; 3], &sum) } else { difference(&r, &product(&r, &sum)) }
}

/// The `f64` nearest to a fraction.
fn round([first, second, third]: Fraction) -> f64 {
    let (upper, lower, exponent) =
        if first == 0 { (second, third, 1021 - 64) } else { (first, second, 1021) };
    let zeros = upper.leading_zeros() % 64;
    let mantissa = upper << zeros | lower >> 1 >> (63 - zeros);
    let last_place = (exponent - u64::from(zeros)) << 52;
    f64::from_bits(last_place + (mantissa >> 11) + (mantissa >> 10) % 2)
}

/// The product, at most 2⁻¹⁹² too low.
#[cfg_attr(not(target_pointer_width = "64"), inline(never))] // saves flash
const fn product(&[a2, a1, a0]: &Fraction, b: &Fraction) -> Fraction {
    /// (sum + a b) / 2⁶⁴.
    const fn row([sum2, sum1, sum0]: Fraction, a: u64, &[b2, b1, b0]: &Fraction) -> Fraction {
        if a == 0 {
            return [0, sum2, sum1];
        }
        let (carry, _) = multiply_add(a, b0, sum0, 0);
        let (carry, word0) = multiply_add(a, b1, sum1, carry);
        let (word2, word1) = multiply_add(a, b2, sum2, carry);
        [word2, word1, word0]
    }
    row(row(row([0; 3], a0, b), a1, b), a2, b)
}

/// a b + c + d as its upper and its lower word.
const fn multiply_add(a: u64, b: u64, c: u64, d: u64) -> (u64, u64) {
    let sum = a as u128 * b as u128 + c as u128 + d as u128;
    ((sum >> 64) as u64, sum as u64)
}

/// a − b, where b is not above a.
const fn difference(&[a2, a1, a0]: &Fraction, &[b2, b1, b0]: &Fraction) -> Fraction {
    let (word0, borrow0) = a0.overflowing_sub(b0);
    let (word1, borrow1) = a1.overflowing_sub(b1);
    let (word1, borrow2) = word1.overflowing_sub(borrow0 as u64);
    let word2 = a2.wrapping_sub(b2).wrapping_sub((borrow1 | borrow2) as u64);
    [word2, word1, word0]
}
