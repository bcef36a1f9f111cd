//! `physics::control` is right: derivatives, forces and velocities equal those of automatic differentiation, and gains
//! those of SciPy, both recorded by `tests/data/control.py`.

use std::array::from_fn;

use acrobot::arithmetic::{Arithmetic, Host, Micro, Real, Reference};
use acrobot::physics::control::{
    Discrete, Forces, Lqr, difference, discretize, inverse_dynamics, linearize, lqr, velocities,
};
use acrobot::physics::{Dynamics, Pendulum};
use acrobot::{Error, Fast, Params, Portable, State};
use common::text_of;

/// The rest of each line of the recording that starts with this word.
fn lines<'a>(text: &'a str, word: &'a str) -> impl Iterator<Item = &'a str> {
    text.lines()
        .filter_map(move |line| line.strip_prefix(word)?.strip_prefix(' '))
}

fn numbers(line: &str) -> Vec<f64> {
    line.split(' ').map(|x| x.parse().unwrap()).collect()
}

fn cast<T: Real, const N: usize>(x: [f64; N]) -> [T; N] {
    x.map(T::from_f64)
}

fn matrix(elements: &[f64]) -> [[f64; 4]; 4] {
    elements.as_chunks().0.try_into().unwrap()
}

fn vector<const N: usize>(elements: &[f64]) -> [f64; N] {
    elements.try_into().unwrap()
}

const IDENTITY: [[f64; 4]; 4] = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

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

/// A pendulum, a torque and accelerations of the recording, and what autograd computed for them.
struct Case {
    params: Params,
    state: State,
    torque: f64,
    accelerations: [f64; 2],
    continuous: Vec<f64>,
    discrete: Vec<f64>,
    motion: Vec<f64>,
}

fn cases() -> Vec<Case> {
    let text = text_of("tests/data/control.txt");
    let results = |word| lines(&text, word).map(numbers).collect::<Vec<_>>();
    let [continuous, discrete, motion] = ["continuous", "discrete", "motion"].map(results);
    let cases = lines(&text, "case")
        .zip(continuous)
        .zip(discrete.into_iter().zip(motion));
    cases
        .map(|((line, continuous), (discrete, motion))| {
            let (dynamics, given) = line.split_once(' ').unwrap();
            let x: [f64; 17] = vector(&numbers(given));
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
                    dynamics: match dynamics {
                        "book" => Dynamics::Book,
                        _ => Dynamics::Nips,
                    },
                    ..Params::DEFAULT
                },
                state: State::from(vector(&x[10..14])),
                torque: x[14],
                accelerations: vector(&x[15..]),
                continuous,
                discrete,
                motion,
            }
        })
        .collect()
}

/// The largest error of each function over all cases, with the arithmetic `A`.
fn errors<A: Arithmetic>() -> [f64; 4] {
    let mut worst = [0.0_f64; 4];
    let cases = cases();
    assert_eq!(cases.len(), 40);
    for case in cases {
        let pendulum = Pendulum::<A>::new(case.params.cast(), case.state.cast()).unwrap();
        let torque = Real::from_f64(case.torque);
        let continuous = linearize(&pendulum, torque).unwrap();
        let discrete = discretize(&pendulum, torque).unwrap();
        let Forces {
            torques,
            reaction,
            elbow,
        } = inverse_dynamics(&pendulum, cast(case.accelerations)).unwrap();
        let pairs = [
            (
                [continuous.a.as_flattened(), &continuous.b].concat(),
                &case.continuous[..],
            ),
            (
                [discrete.a.as_flattened(), &discrete.b].concat(),
                &case.discrete,
            ),
            ([torques, reaction, elbow].concat(), &case.motion[..6]),
            (velocities(&pendulum).unwrap().concat(), &case.motion[6..]),
        ];
        for (worst, (found, expected)) in worst.iter_mut().zip(pairs) {
            *worst = worst.max(relative(&found, expected));
        }
    }
    println!("{}: {worst:?}", A::NAME);
    worst
}

#[test]
fn derivatives_forces_and_velocities_equal_automatic_differentiation() {
    for worst in [
        errors::<Reference>(),
        errors::<Portable>(),
        errors::<Host>(),
    ] {
        assert!(worst.into_iter().all(|error| error < 1e-13), "{worst:?}");
    }
    let single = errors::<Fast>();
    assert!(single.into_iter().all(|error| error < 2e-5), "{single:?}");
    // The table of sines has an error of 3e-5.
    let table = errors::<Micro>();
    assert!(table.into_iter().all(|error| error < 2e-3), "{table:?}");
}

/// The derivative of the forward dynamics, as `tests/physics.rs` compares it with Lagrange's equations, is undone.
#[test]
fn inverse_dynamics_inverts_the_derivative() {
    for case in cases() {
        let pendulum = Pendulum::<Portable>::new(case.params, case.state).unwrap();
        let [_, _, ddtheta1, ddtheta2] = pendulum.derivative(case.torque);
        let forces = inverse_dynamics(&pendulum, [ddtheta1, ddtheta2]).unwrap();
        let [residue, torque] = forces.torques;
        let scale = forces.reaction[0].abs() + forces.reaction[1].abs() + 1.0;
        assert!(residue.abs() < 1e-12 * scale, "{residue:e}");
        assert!((torque - case.torque).abs() < 1e-12 * scale, "{torque}");
    }
}

/// What SciPy computed for one regulator.
struct Recorded {
    theta1: f64,
    dt: f64,
    model: Discrete,
    q: [[f64; 4]; 4],
    r: f64,
    gain: [f64; 4],
    cost_to_go: [[f64; 4]; 4],
}

fn regulators() -> Vec<Recorded> {
    let text = text_of("tests/data/control.txt");
    let recorded = lines(&text, "lqr").map(|line| {
        let x = numbers(line);
        assert_eq!(x.len(), 59);
        Recorded {
            theta1: x[0],
            dt: x[1],
            model: Discrete {
                a: matrix(&x[2..18]),
                b: vector(&x[18..22]),
            },
            q: matrix(&x[22..38]),
            r: x[38],
            gain: vector(&x[39..43]),
            cost_to_go: matrix(&x[43..]),
        }
    });
    recorded.collect()
}

/// The model and the weights in another scalar.
fn regulate<S: Real>(Recorded { model, q, r, .. }: &Recorded) -> Result<Lqr<S>, Error> {
    let model = Discrete {
        a: model.a.map(cast),
        b: cast(model.b),
    };
    lqr(&model, &q.map(cast), S::from_f64(*r))
}

#[test]
fn gains_equal_scipys() {
    let (mut worst, mut worst_single) = ([0.0_f64; 2], [0.0_f64; 2]);
    for recorded in regulators() {
        let (found, single) = (
            regulate::<f64>(&recorded).unwrap(),
            regulate::<f32>(&recorded).unwrap(),
        );
        let expected = recorded.cost_to_go.as_flattened();
        let errors = [
            relative(&found.gain, &recorded.gain),
            relative(found.cost_to_go.as_flattened(), expected),
        ];
        let errors_single = [
            relative(&single.gain, &recorded.gain),
            relative(single.cost_to_go.as_flattened(), expected),
        ];
        println!(
            "theta1 {:.2}, dt {}, r {}: {} and {} iterations, errors of K and P {errors:?}, in f32 {errors_single:?}",
            recorded.theta1, recorded.dt, recorded.r, found.iterations, single.iterations
        );
        for i in 0..2 {
            worst[i] = worst[i].max(errors[i]);
            worst_single[i] = worst_single[i].max(errors_single[i]);
        }
        for (i, row) in found.cost_to_go.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                assert_eq!(*x, found.cost_to_go[j][i]);
            }
        }
    }
    println!("{worst:?}, in f32 {worst_single:?}");
}
