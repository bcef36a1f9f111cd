//! `control` is right: derivatives, forces and gains equal those of 200
//! digits, recorded by `tests/data/control.py`.

mod balance;
mod calibrate;
mod dlqe;
mod estimator;
mod identify;
mod lqr;
mod motions;
mod mpc;
mod planner;
mod recovery;
mod regulators;
mod side_by_side;
mod tvlqr;

use acrobot::arithmetic::{Arithmetic, Damped, Host, Micro, Real, Reference};
use acrobot::control::model::Forces;
use acrobot::physics::Pendulum;
use acrobot::{Fast, Params, Portable, State};
use common::{dynamics_of, lines, numbers, text_of};

fn cast<T: Real, const N: usize>(x: [f64; N]) -> [T; N] {
    x.map(T::from_f64)
}

fn vector<const N: usize>(elements: &[f64]) -> [f64; N] {
    elements.try_into().unwrap()
}

/// The largest |found − expected|, relative to the largest |expected|.
fn relative<S: Real>(found: &[S], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let (mut error, mut largest) = (0.0_f64, 0.0_f64);
    for (x, y) in found.iter().zip(expected) {
        assert!(x.is_finite());
        (error, largest) = (error.max((x.to_f64() - y).abs()), largest.max(y.abs()));
    }
    error / largest
}

/// The first of forty cases with moderate parameters, with those over six decades, and with
/// moderate ones, friction and a rotor.
const MODERATE: usize = 0;
const DECADES: usize = 40;
const DAMPED: usize = 80;

/// The largest error of each function over all cases, with the arithmetic `A`.
fn errors<A: Arithmetic>(first: usize) -> [f64; 3] {
    let text = text_of("tests/data/control.txt");
    let recorded = |word| lines(&text, word).skip(first).take(40);
    let count = recorded("motion").count();
    assert_eq!(count, 40, "motions of each kind in tests/data/control.txt: record again");
    let results = ["continuous", "discrete", "motion"].map(|word| recorded(word).map(numbers));
    let [continuous, discrete, motion] = results;
    let mut worst = [0.0_f64; 3];
    let cases = recorded("case").zip(continuous).zip(discrete.zip(motion));
    for ((case, by_time), (by_step, motion)) in cases {
        let (dynamics, given) = case.split_once(' ').unwrap();
        let x: [f64; 22] = vector(&numbers(given));
        let mut params = Params { dynamics: dynamics_of(dynamics), ..Params::DEFAULT };
        // The fields up to dt, then friction and the rotor.
        let [links @ .., _, _, _, _, _, _, b1, b2, c1, c2, rotor] = params.numbers_mut();
        let places = links.into_iter().chain([b1, b2, c1, c2, rotor]);
        places.zip(x).for_each(|(place, x)| *place = x);
        let state = State::from(vector(&x[15..19])).cast();
        let pendulum = Pendulum::<A>::new(params.cast(), state).unwrap();
        let torque = Real::from_f64(x[19]);
        let continuous = pendulum.linearize(torque).unwrap();
        let discrete = pendulum.linearize_step(torque).unwrap();
        let Forces { torques, reaction, elbow } =
            pendulum.inverse_dynamics(cast(vector::<2>(&x[20..]))).unwrap();
        let pairs = [
            ([continuous.a.as_flattened(), &continuous.b].concat(), &by_time[..]),
            ([discrete.a.as_flattened(), &discrete.b].concat(), &by_step),
            ([torques, reaction, elbow].concat(), &motion),
        ];
        for (worst, (found, expected)) in worst.iter_mut().zip(pairs) {
            *worst = worst.max(relative(&found, expected));
        }
    }
    worst
}

#[test]
fn derivatives_and_forces_equal_those_of_200_digits() {
    for (worst, limit) in [
        (errors::<Reference>(MODERATE), 1e-14),
        (errors::<Portable>(MODERATE), 1e-14),
        (errors::<Host>(MODERATE), 1e-14),
        (errors::<Fast>(MODERATE), 1e-6),
        (errors::<Micro>(MODERATE), 5e-6),
        // The derivatives of a step amplify the rounding of these parameters by up to 8000.
        (errors::<Reference>(DECADES), 1e-12),
        (errors::<Portable>(DECADES), 1e-12),
        (errors::<Host>(DECADES), 1e-12),
        (errors::<Fast>(DECADES), 1e-3),
        (errors::<Micro>(DECADES), 1e-3),
        (errors::<Damped<Reference>>(DAMPED), 1e-14),
        (errors::<Damped<Portable>>(DAMPED), 1e-14),
        (errors::<Damped<Fast>>(DAMPED), 1e-6),
    ] {
        assert!(worst.into_iter().all(|error| error < limit), "{worst:?}");
    }
}

#[test]
fn differences_of_angles_are_wrapped_and_those_of_velocities_are_not() {
    let [state, target] = [[3.0, -1.0, 2.0, 5.0], [-3.0, 0.5, -1.0, 7.0]].map(State::from);
    let [first, others @ ..] = state.deviation_from(target);
    assert!((first - (6.0 - std::f64::consts::TAU)).abs() < 1e-15, "{first}");
    assert_eq!(others, [-1.5, 3.0, -2.0]);
}

#[test]
fn inputs_that_are_not_finite_are_rejected() {
    let pendulum = Pendulum::<Fast>::hanging();
    let torque = "torque must be a finite number of N m, got NaN";
    assert_eq!(pendulum.linearize(f32::NAN).unwrap_err().to_string(), torque);
    assert_eq!(pendulum.linearize_step(f32::NAN).unwrap_err().to_string(), torque);
    let error = pendulum.inverse_dynamics([0.0, f32::INFINITY]).unwrap_err();
    let rule = "ddtheta2 must be a finite number of rad/s², got inf";
    assert_eq!(error.to_string(), rule);
}
