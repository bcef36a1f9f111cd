//! Promise 2, bits defined by mathematics: `Reference`'s sines and cosines are correctly rounded.
//! `data/sines.py` recorded MPFR's results.

use std::f64::consts::{FRAC_PI_2, PI};

use acrobot::arithmetic::{Arithmetic, Reference};
use acrobot::numpy::{Pcg64, uniform};
use rand_core::Rng;

/// Arguments that each digest covers.
const CHUNK: usize = 250_000;

fn recorded() -> impl Iterator<Item = Vec<&'static str>> {
    let lines = include_str!("data/sines.txt").lines();
    lines.filter(|line| !line.starts_with('#')).map(|line| line.split(' ').collect())
}

/// The next argument of a family, as `data/sines.py` draws it.
fn argument(family: &str, rng: &mut Pcg64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    let sign = |u: u64| u & 1 << 63;
    let exponent = |u: u64| u >> 52 & 1023;
    match family {
        "pi" => uniform(rng, -PI, PI),
        "64" => uniform(rng, -64.0, 64.0),
        "2^20" => uniform(rng, -1_048_576.0, 1_048_576.0),
        "tiny" => {
            let u = rng.next_u64();
            f64::from_bits(u & MANTISSA | sign(u) | (1023 - 64 + exponent(u) % 45) << 52)
        }
        "subnormal" => {
            let u = rng.next_u64();
            f64::from_bits((u & MANTISSA) >> (exponent(u) % 52) | sign(u))
        }
        "quarters" => {
            let u = rng.next_u64();
            let multiple = (u >> 12 >> ((u & 63) % 52)).max(1) as f64 * FRAC_PI_2;
            f64::from_bits(multiple.to_bits() + (u >> 6 & 3) - 1)
        }
        "any" => {
            let any = f64::from_bits(rng.next_u64());
            if any.is_finite() { any } else { f64::from_bits(any.to_bits() & !(1 << 62)) }
        }
        _ => panic!("unknown family {family}"),
    }
}

/// With optimization these are 21 million.
#[test]
fn millions_of_sines_are_correctly_rounded() {
    const EVERY: usize = if cfg!(debug_assertions) { 5 } else { 1 };

    let mut count = 0;
    for fields in recorded().step_by(EVERY) {
        let ["family", family, chunk, expected] = fields[..] else {
            continue;
        };
        let mut rng = Pcg64::new(chunk.parse().unwrap());
        let mut digest = 0_u64;
        for _ in 0..CHUNK {
            let x = argument(family, &mut rng);
            let (sin, cos) = Reference::sin_cos(x);
            for y in [sin, cos] {
                digest = digest.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(y.to_bits());
            }
        }
        assert_eq!(format!("{digest:016x}"), expected, "{family}, chunk {chunk}");
        count += CHUNK;
    }
    // 84 families, which come first.
    let expected = 84_usize.div_ceil(EVERY) * CHUNK;
    assert_eq!(count, expected, "sines of families in tests/data/sines.txt: edit this count");
}

/// Results next to half way between two `f64`, arguments next to multiples of π/2 of every size,
/// and the ends of each method.
#[test]
fn hard_cases_are_correctly_rounded() {
    let mut count = 0;
    for fields in recorded() {
        let [x, sin, cos] = fields[..] else { continue };
        let [x, sin, cos] =
            [x, sin, cos].map(|bits| f64::from_bits(u64::from_str_radix(bits, 16).unwrap()));
        let (found_sin, found_cos) = Reference::sin_cos(x);
        assert_eq!(found_sin.to_bits(), sin.to_bits(), "sin {x:e}: {found_sin:e}");
        assert_eq!(found_cos.to_bits(), cos.to_bits(), "cos {x:e}: {found_cos:e}");
        assert_eq!(Reference::cos_near(x).to_bits(), cos.to_bits(), "cos {x:e} alone");
        count += 1;
    }
    assert!(count > 2000, "tests/data/sines.txt has {count} hard cases: record again");
}

#[test]
fn the_sine_of_infinity_and_nan_is_nan() {
    for x in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        let (sin, cos) = Reference::sin_cos(x);
        assert!(sin.is_nan() && cos.is_nan() && Reference::cos_near(x).is_nan());
    }
}
