//! Promises 1 and 3: the error of every sine and cosine, over every argument. `cargo test --release
//! --test trigonometry` tries every `f32` for `Fast`, and without `--release` one argument in 257.

use std::f32::consts::PI;

use acrobot::arithmetic::{Arithmetic, Fast, Host, Micro, Portable};
use rayon::prelude::*;

const EVERY: usize = if cfg!(debug_assertions) { 257 } else { 1 };

/// The largest errors of sine and cosine over each `stride`-th `f32` from `start` to `end`. The
/// negative arguments must give the exact mirror image, except for the sign of zero.
fn largest_errors<A: Arithmetic<Scalar = f32>>(start: f32, end: f32, stride: usize) -> [f64; 2] {
    let arguments = (start.to_bits()..end.to_bits() + 1).into_par_iter().step_by(stride);
    let errors = arguments.map(|bits| {
        let x = f32::from_bits(bits);
        let (sin, cos) = A::sin_cos(x);
        let (true_sin, true_cos) = Host::sin_cos(x.into());
        assert!(sin.abs() <= 1.0 && cos.abs() <= 1.0, "{x:e}: {sin} {cos}");
        assert_eq!(A::sin_cos(-x), (-sin, cos), "{x:e}");
        [f64::from(sin) - true_sin, f64::from(cos) - true_cos].map(f64::abs)
    });
    errors.reduce(|| [0.0; 2], |x, y| [x[0].max(y[0]), x[1].max(y[1])])
}

#[test]
fn fast_is_within_its_error() {
    let [sin, cos] = largest_errors::<Fast>(0.0, 64.0, EVERY);
    println!("sin {sin:e}, cos {cos:e}");
    assert!(sin.max(cos) <= 1.17e-7);
}

#[test]
fn micro_is_within_its_error() {
    for (end, error) in [(PI, 8.0e-7), (64.0, 4.0e-6)] {
        let [sin, cos] = largest_errors::<Micro>(0.0, end, 17 * EVERY);
        println!("up to {end}: sin {sin:e}, cos {cos:e}");
        assert!(sin.max(cos) <= error);
    }
}

/// Beyond 64 rad the rounding of the angle to `f32` dominates the error.
#[test]
fn far_angles_have_the_error_of_their_rounding() {
    fn check<A: Arithmetic<Scalar = f32>>(of_angle: f64) {
        for end in (7..=19).map(|power| (1_u32 << power) as f32) {
            let [sin, cos] = largest_errors::<A>(end / 2.0, end, 257 * EVERY);
            println!("up to {end}: sin {sin:e}, cos {cos:e}");
            assert!(sin.max(cos) <= of_angle * f64::from(end));
        }
    }
    check::<Fast>(1.2e-7);
    check::<Micro>(2.0e-7);
}

/// `Portable`'s error against Gymnasium follows from this property of `libm`.
#[test]
fn portable_is_within_one_ulp_of_host() {
    for i in 0..1_000_000 {
        let x = f64::from(i - 500_000) * 1e-4;
        let (sin, cos) = Portable::sin_cos(x);
        let (host_sin, host_cos) = Host::sin_cos(x);
        assert_eq!(Portable::cos_near(x).to_bits(), cos.to_bits());
        assert!((sin - host_sin).abs() <= f64::EPSILON / 2.0, "sin of {x}");
        assert!((cos - host_cos).abs() <= f64::EPSILON / 2.0, "cos of {x}");
    }
}
