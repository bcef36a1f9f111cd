//! Gains in continuous time equal those of 200 digits and Drake's, in any unit of time. Models
//! without a regulator are errors.

use acrobot::arithmetic::{Damped, Real};
use acrobot::control::model::LinearModel;
use acrobot::control::regulator::{Lqr, lqr};
use acrobot::physics::Pendulum;
use acrobot::{Error, Params, Portable, State};
use common::{lines, numbers, text_of};

use crate::regulators::{IDENTITY, diagonal, matrix};
use crate::{cast, relative, vector};

/// The regulator of A, B, Q and R, as a line of the recording has them.
fn regulate<S: Real>(x: &[f64]) -> Result<Lqr<S>, Error> {
    let [a, q] = [&x[..16], &x[20..36]].map(|m| matrix(m).map(cast));
    lqr(&LinearModel { a, b: cast(vector(&x[16..20])) }, &q, S::from_f64(x[36]))
}

/// All numbers are exact in both scalars, so only the gain is rounded. The regulators of three
/// random models are so much faster than the models that no gain is exact.
#[test]
fn gains_are_exact() {
    fn check<S: Real>(limit: f64) {
        let text = text_of("tests/data/control.txt");
        let [mut exact, mut ill] = [0; 2];
        for line in lines(&text, "care") {
            let (kind, given) = line.split_once(' ').unwrap();
            let mut x = numbers(given);
            // Short texts of `f32`.
            x[..37].iter_mut().for_each(|x| *x = f64::from(*x as f32));
            match regulate::<S>(&x) {
                Ok(regulator) => {
                    let error = relative(&regulator.gain, &x[37..]);
                    assert!(error < limit, "{error:e} {line}");
                    exact += 1;
                }
                Err(Error::IllConditioned { .. }) if kind == "any" => ill += 1,
                Err(error) => panic!("{error} {line}"),
            }
        }
        assert_eq!([exact, ill], [197, 3]);
    }
    check::<f64>(1e-15);
    check::<f32>(1e-7);
}

/// Drake's example of the acrobot, R. Tedrake, *Underactuated Robotics*.
#[test]
fn drakes_gain_is_found() {
    let params = Params {
        length2: 2.0,
        center_of_mass2: 1.0,
        inertia1: 0.083,
        inertia2: 0.33,
        gravity: 9.81,
        damping1: 0.1,
        damping2: 0.1,
        ..Params::DEFAULT
    };
    let upright = Pendulum::<Damped<Portable>>::new(params, State::UPRIGHT).unwrap();
    let model = upright.linearize(0.0).unwrap();
    let Lqr { gain, cost_to_go } = lqr(&model, &diagonal([10.0, 10.0, 1.0, 1.0]), 1.0).unwrap();
    for (found, expected) in gain.into_iter().zip([-278.44, -112.29, -119.72, -56.83]) {
        assert!((found - expected).abs() <= 0.005, "{gain:?}");
    }
    // K = B P / R.
    let from_cost = cost_to_go.map(|row| (0..4).map(|i| row[i] * model.b[i]).sum::<f64>());
    assert!(relative(&from_cost, &gain) < 1e-12, "{from_cost:?}");
}

/// For the recorded acrobots, in motion, too: a positive definite P that solves the equation is
/// that of the regulator.
#[test]
fn costs_solve_the_equation() {
    let text = text_of("tests/data/control.txt");
    let q = [10.0, 10.0, 1.0, 1.0];
    let count = lines(&text, "continuous").count();
    assert_eq!(count, 120, "rows `continuous` in tests/data/control.txt: edit this count");
    for x in lines(&text, "continuous").map(numbers) {
        let (a, b) = (matrix(&x[..16]), vector(&x[16..]));
        let Lqr { gain, cost_to_go: p } = lqr(&LinearModel { a, b }, &diagonal(q), 1.0).unwrap();
        for i in 0..4 {
            for j in 0..=i {
                let terms = (0..4).flat_map(|k| [a[k][i] * p[k][j], p[i][k] * a[k][j]]);
                let others = [if i == j { q[i] } else { 0.0 }, -gain[i] * gain[j]];
                let terms = terms.chain(others);
                let (sum, most) =
                    terms.fold((0.0, 0.0_f64), |(sum, most), x| (sum + x, most + x.abs()));
                assert!(sum.abs() <= 1e-13 * most, "{sum:e} {most:e} {x:?}");
            }
        }
        // The pivots of an elimination.
        let mut rest = p;
        for i in 0..4 {
            let row = rest[i];
            assert!(row[i] > 0.0, "{x:?}");
            for other in &mut rest[i + 1..] {
                let factor = other[i] / row[i];
                *other = std::array::from_fn(|j| other[j] - factor * row[j]);
            }
        }
    }
}

/// By hand.
#[test]
fn gains_of_special_models_are_exact() {
    let (none, all) = (diagonal([0.0; 4]), [1.0; 4]);
    // Four integrators become a Butterworth filter.
    let mut integrators = none;
    (integrators[0][2], integrators[2][1], integrators[1][3]) = (1.0, 1.0, 1.0);
    let (outer, inner) = (2.613_125_929_752_753, 2.0 + 2_f64.sqrt());
    for (a, b, q, expected) in [
        (
            integrators,
            [0.0, 0.0, 0.0, 1.0],
            diagonal([1.0, 0.0, 0.0, 0.0]),
            [1.0, inner, outer, outer],
        ),
        // Without weights the cheapest gain mirrors 1.1 in the imaginary axis.
        (diagonal([1.1, -0.5, -0.4, -0.3]), all, none, [2.2, 0.0, 0.0, 0.0]),
        (diagonal([-0.5; 4]), all, none, [0.0; 4]),
        (diagonal([-0.5; 4]), [0.0; 4], IDENTITY, [0.0; 4]),
        // k² = 3 for ẋ = u with weights of 3 and 1.
        (
            diagonal([0.0, -1.0, -1.0, -1.0]),
            [1.0, 0.0, 0.0, 0.0],
            diagonal([3.0, 0.0, 0.0, 0.0]),
            [3_f64.sqrt(), 0.0, 0.0, 0.0],
        ),
    ] {
        let found = lqr(&LinearModel { a, b }, &q, 1.0).unwrap().gain;
        assert!(found == expected || relative(&found, &expected) < 1e-15, "{found:?}");
    }
}

fn upright() -> LinearModel {
    Pendulum::<Portable>::new(Params::DEFAULT, State::UPRIGHT).unwrap().linearize(0.0).unwrap()
}

/// In another unit of time velocities and rates are τ times as large, and accelerations τ² times.
#[test]
fn no_unit_changes_a_digit() {
    let LinearModel { a, b } = upright();
    let regulate = |time: f64, torque: f64, cost: f64| {
        let unit = [1.0, 1.0, time, time];
        let scaled = |i: usize, j: usize| a[i][j] * unit[i] / unit[j] * time;
        let a = std::array::from_fn(|i| std::array::from_fn(|j| scaled(i, j)));
        let b = std::array::from_fn(|i| b[i] * unit[i] * time * torque);
        let q = diagonal(unit.map(|unit| cost / unit / unit));
        let Lqr { gain, cost_to_go } =
            lqr(&LinearModel { a, b }, &q, cost * torque * torque).unwrap();
        let gain: [f64; 4] = std::array::from_fn(|i| gain[i] * unit[i] * torque);
        let element = |i: usize, j: usize| cost_to_go[i][j] * unit[i] * unit[j] * time / cost;
        (gain, std::array::from_fn(|i| std::array::from_fn(|j| element(i, j))))
    };
    let found: ([f64; 4], [[f64; 4]; 4]) = regulate(1.0, 1.0, 1.0);
    for time in [2_f64.powi(-40), 2_f64.powi(-10), 2.0, 2_f64.powi(10), 2_f64.powi(40)] {
        assert_eq!(regulate(time, 1.0, 1.0), found, "{time:e}");
        assert_eq!(regulate(time, 2_f64.powi(-60), 2_f64.powi(500)), found, "{time:e}");
    }
    assert_eq!(regulate(1.0, 1.0, 2_f64.powi(-500)), found);
}

#[test]
fn a_regulator_that_cannot_exist_is_an_error() {
    let growing = diagonal([1.1, -0.5, -0.4, -0.3]);
    let persistent = diagonal([0.0, -0.5, -0.4, -0.3]);
    let mut swinging = diagonal([0.0, 0.0, -0.5, -0.4]);
    (swinging[0][1], swinging[1][0]) = (1.0, -1.0);
    let (none, all) = (diagonal([0.0; 4]), [1.0; 4]);
    let not_first = [0.0, 1.0, 1.0, 1.0];
    let (stabilizable, detectable) = (Error::NotStabilizable, Error::NotDetectable);
    for (a, b, q, expected) in [
        (growing, not_first, IDENTITY, stabilizable),
        (persistent, not_first, IDENTITY, stabilizable),
        (growing, [0.0; 4], IDENTITY, stabilizable),
        (none, [0.0; 4], IDENTITY, stabilizable),
        (diagonal([1.1, 1.1, -0.5, -0.3]), all, IDENTITY, stabilizable),
        (persistent, all, none, detectable),
        (swinging, all, none, detectable),
        (diagonal([0.0, 1.5, -0.5, -0.5]), all, diagonal([0.0, 1.0, 1.0, 1.0]), detectable),
    ] {
        let error = lqr(&LinearModel { a, b }, &q, 1.0).unwrap_err();
        assert_eq!(error, expected, "{a:?} {b:?} {q:?}");
    }

    let message = |q, r| lqr(&upright(), &q, r).unwrap_err().to_string();
    assert_eq!(message(IDENTITY, 0.0), "r must be finite and above 0 per (N m)², got 0");
    assert!(message(diagonal([-1.0; 4]), 1.0).starts_with("q must be positive semidefinite, got "));
    let LinearModel { mut a, b } = upright();
    a[0][0] = f64::NAN;
    let error = lqr(&LinearModel { a, b }, &IDENTITY, 1.0).unwrap_err();
    assert_eq!(error.to_string(), "a must be finite in each element, got NaN");
}

/// Rounded to `f32`, the gain 2⁻¹⁵⁶ is 0, which stops no motion.
#[test]
fn a_gain_that_rounding_makes_useless_is_an_error() {
    fn found<S: Real>() -> Result<(), Error> {
        let a = diagonal([2_f64.powi(-30), -0.5, -0.4, -0.3]).map(cast::<S, 4>);
        let b = cast([2_f64.powi(127), 0.0, 0.0, 0.0]);
        lqr(&LinearModel { a, b }, &diagonal([0.0; 4]).map(cast), S::from_f64(1.0)).map(drop)
    }
    assert_eq!(found::<f64>(), Ok(()));
    let error = f64::from(f32::EPSILON);
    assert_eq!(found::<f32>(), Err(Error::IllConditioned { error }));
}
