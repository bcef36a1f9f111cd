//! `physics::control` is right: derivatives, forces, velocities and gains equal those of 200
//! digits, recorded by `tests/data/control.py`.

mod balance;
mod regulators;

use acrobot::arithmetic::{Arithmetic, Damped, Host, Micro, Real, Reference};
use acrobot::physics::control::{Forces, discretize, inverse_dynamics, linearize, velocities};
use acrobot::physics::{Pendulum, Viscous};
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
    let largest = |x: &mut dyn Iterator<Item = f64>| {
        x.fold(0.0_f64, |most, x| {
            assert!(x.is_finite());
            most.max(x.abs())
        })
    };
    let differences = &mut found.iter().zip(expected).map(|(x, y)| x.to_f64() - y);
    largest(differences) / largest(&mut expected.iter().copied())
}

/// The first of forty cases with moderate parameters, with those over six decades, and with
/// moderate ones and friction.
const MODERATE: usize = 0;
const DECADES: usize = 40;
const DAMPED: usize = 80;

/// A pendulum, a torque and accelerations of the recording, and what 200 digits give for them.
struct Case {
    params: Params,
    state: State,
    torque: f64,
    accelerations: [f64; 2],
    continuous: Vec<f64>,
    discrete: Vec<f64>,
    motion: Vec<f64>,
}

fn cases(first: usize) -> Vec<Case> {
    let text = text_of("tests/data/control.txt");
    let results = |word| lines(&text, word).map(numbers).collect::<Vec<_>>();
    let [continuous, discrete, motion] = ["continuous", "discrete", "motion"].map(results);
    assert_eq!(continuous.len(), 120);
    let cases = lines(&text, "case")
        .zip(continuous)
        .zip(discrete.into_iter().zip(motion))
        .skip(first)
        .take(40);
    cases
        .map(|((line, continuous), (discrete, motion))| {
            let (dynamics, given) = line.split_once(' ').unwrap();
            let x: [f64; 19] = vector(&numbers(given));
            Case {
                params: Params {
                    length1: x[0],
                    length2: x[1],
                    mass1: x[2],
                    mass2: x[3],
                    center_of_mass1: x[4],
                    center_of_mass2: x[5],
                    inertia1: x[6],
                    inertia2: x[7],
                    gravity: x[8],
                    dt: x[9],
                    dynamics: dynamics_of(dynamics),
                    friction: Viscous { joint1: x[10], joint2: x[11] },
                    ..Params::default()
                },
                state: State::from(vector(&x[12..16])),
                torque: x[16],
                accelerations: vector(&x[17..]),
                continuous,
                discrete,
                motion,
            }
        })
        .collect()
}

/// The largest error of each function over all cases, with the arithmetic `A`.
fn errors<A: Arithmetic>(first: usize) -> [f64; 4] {
    let mut worst = [0.0_f64; 4];
    for case in cases(first) {
        let pendulum = Pendulum::<A>::new(case.params.cast(), case.state.cast()).unwrap();
        let torque = Real::from_f64(case.torque);
        let continuous = linearize(&pendulum, torque).unwrap();
        let discrete = discretize(&pendulum, torque).unwrap();
        let Forces { torques, reaction, elbow } =
            inverse_dynamics(&pendulum, cast(case.accelerations)).unwrap();
        let pairs = [
            ([continuous.a.as_flattened(), &continuous.b].concat(), &case.continuous[..]),
            ([discrete.a.as_flattened(), &discrete.b].concat(), &case.discrete),
            ([torques, reaction, elbow].concat(), &case.motion[..6]),
            (velocities(&pendulum).unwrap().concat(), &case.motion[6..]),
        ];
        for (worst, (found, expected)) in worst.iter_mut().zip(pairs) {
            *worst = worst.max(relative(&found, expected));
        }
    }
    println!("{}, cases from {first}: {worst:?}", A::NAME);
    worst
}

#[test]
fn derivatives_forces_and_velocities_equal_those_of_200_digits() {
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
fn inputs_that_are_not_finite_are_rejected() {
    let pendulum = Pendulum::<Fast>::hanging();
    let torque = "torque must be a finite number of N m, got NaN";
    assert_eq!(linearize(&pendulum, f32::NAN).unwrap_err().to_string(), torque);
    assert_eq!(discretize(&pendulum, f32::NAN).unwrap_err().to_string(), torque);
    let error = inverse_dynamics(&pendulum, [0.0, f32::INFINITY]).unwrap_err();
    let rule = "ddtheta2 must be a finite number of rad/s², got inf";
    assert_eq!(error.to_string(), rule);
}
