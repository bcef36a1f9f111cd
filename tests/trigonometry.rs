//! Promises 1 and 3: the error of every sine and cosine, over every argument. Exhaustive in release for
//! `Fast` (`cargo test --release --test trigonometry`), one argument in 257 otherwise.

use acrobot::{Arithmetic, Fast, Host, Micro, Portable};

const EVERY: usize = if cfg!(debug_assertions) { 257 } else { 1 };

/// The largest errors of sine and cosine over each `stride`-th `f32` from `start` to `end`, and of
/// the same with the sign changed, which must be exactly mirrored where `MIRRORED`.
fn largest_errors<A: Arithmetic<Scalar = f32>, const MIRRORED: bool>(
    start: f32,
    end: f32,
    stride: usize,
) -> [f64; 2] {
    let (start, end) = (start.to_bits(), end.to_bits());
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let part = |thread: usize| {
        let mut largest = [0.0_f64; 2];
        for bits in (start..=end)
            .skip(thread * stride)
            .step_by(threads * stride)
        {
            let x = f32::from_bits(bits);
            let (sin, cos) = A::sin_cos(x);
            let (true_sin, true_cos) = Host::sin_cos(x.into());
            assert!(sin.abs() <= 1.0 && cos.abs() <= 1.0, "{x:e}: {sin} {cos}");
            let errors = [f64::from(sin) - true_sin, f64::from(cos) - true_cos];
            for (largest, error) in largest.iter_mut().zip(errors) {
                *largest = largest.max(error.abs());
            }
            let (mirrored_sin, mirrored_cos) = A::sin_cos(-x);
            if MIRRORED {
                assert_eq!(-sin, mirrored_sin, "sin of {x:e}");
                assert_eq!(cos, mirrored_cos, "cos of {x:e}");
            } else {
                let errors = [
                    f64::from(mirrored_sin) + true_sin,
                    f64::from(mirrored_cos) - true_cos,
                ];
                for (largest, error) in largest.iter_mut().zip(errors) {
                    *largest = largest.max(error.abs());
                }
            }
        }
        largest
    };
    let part = &part;
    std::thread::scope(|scope| {
        let parts: Vec<_> = (0..threads)
            .map(|thread| scope.spawn(move || part(thread)))
            .collect();
        parts
            .into_iter()
            .map(|part| part.join().unwrap())
            .reduce(|x, y| [x[0].max(y[0]), x[1].max(y[1])])
            .unwrap()
    })
}

#[test]
fn fast_is_within_its_budget() {
    let [sin, cos] = largest_errors::<Fast, true>(0.0, 64.0, EVERY);
    println!("sin {sin:e}, cos {cos:e}");
    assert!(sin.max(cos) <= 1.17e-7);
}

/// Beyond its own range an angle is first brought within a turn, which costs a rounding at 2π.
#[test]
fn fast_is_right_far_outside() {
    let [sin, cos] = largest_errors::<Fast, true>(64.0, 1e6, 17 * EVERY);
    println!("sin {sin:e}, cos {cos:e}");
    assert!(sin <= 2.6e-7, "{sin:e}");
    assert!(cos <= 2.6e-7, "{cos:e}");
}

#[test]
fn micro_is_within_its_error() {
    let [sin, cos] = largest_errors::<Micro, false>(0.0, 1e6, 17 * EVERY);
    println!("sin {sin:e}, cos {cos:e}");
    assert!(sin <= 1.1e-3, "{sin:e}");
    assert!(cos <= 1.1e-3, "{cos:e}");
}

/// So that a start or a state that was set anywhere has an observation.
#[test]
fn every_finite_angle_has_a_sine_and_a_cosine() {
    fn holds<A: Arithmetic<Scalar = f32>>() {
        for bits in
            (0..f32::INFINITY.to_bits()).step_by(if cfg!(debug_assertions) { 10_007 } else { 101 })
        {
            for x in [f32::from_bits(bits), -f32::from_bits(bits)] {
                let (sin, cos) = A::sin_cos(x);
                assert!(sin.abs() <= 1.0 && cos.abs() <= 1.0, "{x:e}: {sin} {cos}");
            }
        }
    }
    holds::<Fast>();
    holds::<Micro>();
}

/// The design's claim about `libm`, on which `Portable`'s closeness rests.
#[test]
fn portable_is_within_one_ulp_of_the_host() {
    for i in 0..1_000_000 {
        let x = f64::from(i - 500_000) * 1e-4;
        let (sin, cos) = Portable::sin_cos(x);
        let (host_sin, host_cos) = Host::sin_cos(x);
        assert_eq!(Portable::cos(x).to_bits(), cos.to_bits());
        assert!((sin - host_sin).abs() <= f64::EPSILON / 2.0, "sin of {x}");
        assert!((cos - host_cos).abs() <= f64::EPSILON / 2.0, "cos of {x}");
    }
}
