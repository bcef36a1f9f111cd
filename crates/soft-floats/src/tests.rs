//! Compares the routines with the FPU of the build machine.

extern crate std;

use std::vec::Vec;

use super::*;

#[track_caller]
fn compare(a: u32, b: u32) {
    let (x, y) = (f32::from_bits(a), f32::from_bits(b));
    for (operator, found, expected) in
        [("+", add(a, b), x + y), ("-", sub(a, b), x - y), ("*", mul(a, b), x * y)]
    {
        let is_nan = expected.is_nan() && f32::from_bits(found).is_nan();
        assert!(
            is_nan || found == expected.to_bits(),
            "{x:e} {operator} {y:e} gave bits {found:#x}, not {expected:e}"
        );
    }
}

/// Numbers at the ends of all ranges, with short and with long runs of equal bits.
fn edges() -> Vec<u32> {
    let exponents =
        [0, 1, 2, 25, 64, 102, 103, 126, 127, 128, 134, 135, 150, 152, 153, 253, 254, 255];
    let mantissas = [
        0, 1, 2, 3, 0x3f, 0x40, 0x41, 0x7f, 0x80, 0x3f_ffff, 0x40_0000, 0x40_0001, 0x7f_fffe,
        0x7f_ffff,
    ];
    let numbers = exponents.map(|e| mantissas.map(|m| [e << 23 | m, e << 23 | m | SIGN]));
    numbers.as_flattened().as_flattened().to_vec()
}

/// xorshift64*.
fn random(state: &mut u64) -> u64 {
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    state.wrapping_mul(0x2545_f491_4f6c_dd1d)
}

#[test]
fn all_edges_and_random_numbers_are_equal() {
    const COUNT: u32 = if cfg!(debug_assertions) { 500_000 } else { 50_000_000 };

    let edges = edges();
    for &a in &edges {
        edges.iter().for_each(|&b| compare(a, b));
    }
    let mut state = 1;
    for i in 0..COUNT {
        let [bits, more] = [(); 2].map(|()| random(&mut state));
        let (a, mut b) = (bits as u32, (bits >> 32) as u32);
        match i % 4 {
            0 => {}
            // Exponents at most 31 apart, which sums align.
            1 => b = b & !INFINITY | (exponent(a) + (more % 32) as u32).min(254) << 23,
            // Few bits, so ties are frequent.
            2 => {
                b = b & !INFINITY & !(u32::MAX >> (9 + more % 23))
                    | (96 + (more >> 8) as u32 % 64) << 23
            }
            _ => b = edges[more as usize % edges.len()],
        }
        compare(a, b);
        compare(b, a);
        if (1..255).contains(&exponent(a)) && (1..255).contains(&exponent(b)) {
            // A target uses only one of the two.
            assert_eq!(wide_product(a, b), narrow_product(a, b));
        }
    }
}
