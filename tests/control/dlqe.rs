//! Kalman filters equal those of 200 digits and of python-control. Models and noise without a
//! filter are errors.

use acrobot::Error;
use acrobot::arithmetic::Real;
use acrobot::control::model::StepModel;
use acrobot::control::regulator::{Lqe, dlqe};
use common::{lines, numbers, text_of};

use crate::regulators::{IDENTITY, diagonal, matrix};
use crate::{cast, relative};

/// As the regulators of `gains_are_exact_over_many_decades`. A random model's covariance has
/// elements from 1e7 to 1e15, and no exact gain.
#[test]
fn gains_and_covariances_are_exact() {
    fn check<S: Real>(limit: f64) {
        let text = text_of("tests/data/control.txt");
        let [mut exact, mut ill] = [0; 2];
        for line in lines(&text, "dlqe") {
            let (kind, given) = line.split_once(' ').unwrap();
            let mut x = numbers(given);
            // Short texts of `f32`.
            x[..34].iter_mut().for_each(|x| *x = f64::from(*x as f32));
            let [a, w] = [&x[..16], &x[16..32]].map(|m| matrix(m).map(cast));
            match dlqe(&StepModel { a, b: cast([0.0; 4]) }, &w, cast::<S, 2>([x[32], x[33]])) {
                Ok(Lqe { gain, prior_covariance }) => {
                    for (found, expected) in [
                        (gain.as_flattened(), &x[34..42]),
                        (prior_covariance.as_flattened(), &x[42..]),
                    ] {
                        let error = relative(found, expected);
                        assert!(error < limit, "{error:e} {line}");
                    }
                    exact += 1;
                }
                Err(Error::IllConditioned { .. }) if kind == "any" => ill += 1,
                Err(error) => panic!("{error} {line}"),
            }
        }
        assert_eq!([exact, ill], [199, 1]);
    }
    check::<f64>(1e-15);
    check::<f32>(1e-7);
}

/// By hand: an angle that stays, with variances of 2 and 1, has the covariance 2 before a
/// measurement and 1 after it.
#[test]
fn a_constant_angle_is_averaged() {
    let model = StepModel { a: diagonal([1.0, 1.0, 0.5, 0.5]), b: [0.0; 4] };
    let w = diagonal([1.0, 4.0, 0.0, 0.0]);
    let lqe = dlqe(&model, &w, [2.0, 8.0]).unwrap();
    assert_eq!(lqe.prior_covariance, diagonal([2.0, 8.0, 0.0, 0.0]));
    assert_eq!(lqe.gain, [[0.5, 0.0], [0.0, 0.5], [0.0; 2], [0.0; 2]]);

    let lqe = Lqe { gain: [[0.5, 0.1], [0.0, 0.5], [2.0, 0.0], [0.0, 4.0]], ..lqe };
    let x = lqe.correct([1.0, 2.0, 3.0, 4.0], [2.0, 4.0]);
    assert!(relative(&x, &[1.7, 3.0, 5.0, 12.0]) < 1e-15, "{x:?}");
}

#[test]
fn the_unit_of_the_noise_changes_no_digit() {
    let model = StepModel { a: diagonal([0.5, 1.4, 0.3, 0.2]), b: [0.0; 4] };
    let of = |unit: f64| {
        let lqe = dlqe(&model, &diagonal([unit; 4]), [unit, 3.0 * unit]).unwrap();
        (lqe.gain, lqe.prior_covariance.map(|row| row.map(|x| x / unit)))
    };
    for exponent in [-1000, -1, 1, 1000] {
        assert_eq!(of(2.0_f64.powi(exponent)), of(1.0));
    }
}

/// The second encoder measures an angle without noise, so its own noise must not matter.
#[test]
fn a_precise_encoder_spoils_no_gain() {
    let model = StepModel { a: diagonal([1.2, 0.5, 0.5, 0.5]), b: [0.0; 4] };
    let w = diagonal([1.0, 0.0, 0.0, 0.0]);
    let gain = |s2: f64| dlqe(&model, &w, [1.0, s2]).unwrap().gain;
    assert_eq!(gain(2.0_f64.powi(-100)), gain(1.0));
}

#[test]
fn a_filter_that_cannot_exist_is_an_error() {
    let model = |a| StepModel { a: diagonal(a), b: [0.0; 4] };
    let none = diagonal([0.0; 4]);
    let (observable, excited) = (Error::NotObservable, Error::NotExcited);
    for (a, w, expected) in [
        // No angle depends on a velocity.
        ([0.5, 0.5, 1.1, 0.5], IDENTITY, observable),
        ([0.5, 0.5, 0.5, 1.0], IDENTITY, observable),
        ([1.0, 0.5, 0.5, 0.5], none, excited),
        ([1.0, 1.5, 0.5, 0.5], diagonal([0.0, 1.0, 1.0, 1.0]), excited),
    ] {
        assert_eq!(dlqe(&model(a), &w, [1.0; 2]).unwrap_err(), expected, "{a:?}");
    }
    assert!(dlqe(&model([1.5, 0.5, 0.5, 0.5]), &none, [1.0; 2]).is_ok());

    let message = |a, w, s| dlqe(&model(a), &w, s).unwrap_err().to_string();
    let small = [0.5; 4];
    for (s, got) in [([0.0, 1.0], "0"), ([1.0, -1.0], "-1"), ([f64::NAN, 1.0], "NaN")] {
        let expected = format!("s must be finite and above 0 rad², got {got}");
        assert_eq!(message(small, IDENTITY, s), expected);
    }
    let rule = "w must be positive semidefinite, got ";
    assert!(message(small, diagonal([-1.0; 4]), [1.0; 2]).starts_with(rule));
    let expected = "a must be finite in each element, got inf";
    assert_eq!(message([f64::INFINITY; 4], IDENTITY, [1.0; 2]), expected);
}

/// Rounded to `f32`, the gain no longer follows this model's fast motions.
#[test]
fn a_gain_that_rounding_makes_useless_is_an_error() {
    fn found<S: Real>() -> Result<(), Error> {
        let a = [
            [-652.0, 0.0, 0.0, -95.0],
            [0.0, -185.0, 0.0, 1.0],
            [-2554.0, 583.0, 0.0, 0.0],
            [0.0, 5.0, -3911.0, 0.0],
        ];
        let model = StepModel { a: a.map(cast::<S, 4>), b: cast([0.0; 4]) };
        dlqe(&model, &IDENTITY.map(cast), cast([1.0; 2])).map(drop)
    }
    assert_eq!(found::<f64>(), Ok(()));
    let error = f64::from(f32::EPSILON);
    assert_eq!(found::<f32>(), Err(Error::IllConditioned { error }));
}
