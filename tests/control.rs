//! `physics::control` is right: derivatives, forces, velocities and gains equal those of automatic differentiation and of
//! 200 digits, recorded by `tests/data/control.py`.

use std::array::from_fn;

use acrobot::arithmetic::{Arithmetic, Host, Micro, Real, Reference};
use acrobot::physics::control::{
    ControlError, DiscreteModel, Forces, Lqr, difference, discretize, inverse_dynamics, linearize,
    lqr, velocities,
};
use acrobot::physics::{Dynamics, Pendulum, bound};
use acrobot::{Fast, Params, Portable, State};
use common::{assert_says, text_of};

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

/// Moderate parameters, or those over six decades.
#[derive(Clone, Copy, Debug)]
enum Spread {
    Moderate,
    Decades,
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

fn cases(spread: Spread) -> Vec<Case> {
    let text = text_of("tests/data/control.txt");
    let results = |word| lines(&text, word).map(numbers).collect::<Vec<_>>();
    let [continuous, discrete, motion] = ["continuous", "discrete", "motion"].map(results);
    assert_eq!(continuous.len(), 80);
    let first = match spread {
        Spread::Moderate => 0,
        Spread::Decades => 40,
    };
    let cases = lines(&text, "case")
        .zip(continuous)
        .zip(discrete.into_iter().zip(motion))
        .skip(first)
        .take(40);
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
fn errors<A: Arithmetic>(spread: Spread) -> [f64; 4] {
    let mut worst = [0.0_f64; 4];
    for case in cases(spread) {
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
    println!("{}, {spread:?}: {worst:?}", A::NAME);
    worst
}

#[test]
fn derivatives_forces_and_velocities_equal_automatic_differentiation() {
    use Spread::{Decades, Moderate};
    for (worst, limit) in [
        (errors::<Reference>(Moderate), 1e-14),
        (errors::<Portable>(Moderate), 1e-14),
        (errors::<Host>(Moderate), 1e-14),
        (errors::<Fast>(Moderate), 1e-6),
        (errors::<Micro>(Moderate), 5e-6),
        // The derivatives of a step amplify the rounding of these parameters by up to 8000.
        (errors::<Reference>(Decades), 1e-12),
        (errors::<Portable>(Decades), 1e-12),
        (errors::<Host>(Decades), 1e-12),
        (errors::<Fast>(Decades), 1e-3),
        (errors::<Micro>(Decades), 1e-3),
    ] {
        assert!(worst.into_iter().all(|error| error < limit), "{worst:?}");
    }
}

/// `tests/physics.rs` compares the derivative with Lagrange's equations.
#[test]
fn inverse_dynamics_inverts_the_derivative() {
    for case in cases(Spread::Moderate) {
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
    model: DiscreteModel,
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
            model: DiscreteModel {
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
fn regulate<S: Real>(Recorded { model, q, r, .. }: &Recorded) -> Result<Lqr<S>, ControlError> {
    let model = DiscreteModel {
        a: model.a.map(cast),
        b: cast(model.b),
    };
    lqr(&model, &q.map(cast), S::from_f64(*r))
}

/// The errors of the gain and of the cost to go.
fn errors_of_lqr<S: Real>(recorded: &Recorded) -> [f64; 2] {
    let found = regulate::<S>(recorded).unwrap();
    let columns: [[S; 4]; 4] = from_fn(|j| found.cost_to_go.map(|row| row[j]));
    assert_eq!(found.cost_to_go, columns, "not symmetric");
    [
        relative(&found.gain, &recorded.gain),
        relative(
            found.cost_to_go.as_flattened(),
            recorded.cost_to_go.as_flattened(),
        ),
    ]
}

#[test]
fn gains_equal_scipys() {
    let recorded = regulators();
    assert_eq!(recorded.len(), 32);
    for recorded in recorded {
        let double = errors_of_lqr::<f64>(&recorded);
        let single = errors_of_lqr::<f32>(&recorded);
        let Recorded { theta1, dt, r, .. } = recorded;
        println!("{theta1:.2} rad, {dt} s, R {r}: f64 {double:?}, f32 {single:?}");
        assert!(double.into_iter().all(|error| error < 1e-11), "{double:?}");
        // The elements of A are rounded to 6e-8, and those that matter are about dt.
        let limit = if dt < 0.01 { 5e-3 } else { 1e-3 };
        assert!(single.into_iter().all(|error| error < limit), "{single:?}");
    }
}

/// All numbers are exact in both scalars, so only the gain is rounded.
#[test]
fn gains_are_exact_over_many_decades_or_errors() {
    fn check<S: Real>(limit: f64) {
        let text = text_of("tests/data/control.txt");
        let (mut found, mut rejected) = (0, 0);
        for line in lines(&text, "model") {
            let (kind, given) = line.split_once(' ').unwrap();
            let mut x = numbers(given);
            // Short texts of `f32`.
            x[..37].iter_mut().for_each(|x| *x = f64::from(*x as f32));
            let [a, q] = [&x[..16], &x[20..36]].map(|m| matrix(m).map(cast));
            let b = cast(vector(&x[16..20]));
            match lqr::<S>(&DiscreteModel { a, b }, &q, S::from_f64(x[36])) {
                Ok(regulator) => {
                    let error = relative(&regulator.gain, &x[37..]);
                    assert!(error < limit, "{error:e} {line}");
                    found += 1;
                }
                Err(error) => {
                    assert!(
                        matches!(error, ControlError::IllConditioned { .. }),
                        "{error} {line}"
                    );
                    assert_eq!(kind, "any", "{error} {line}");
                    rejected += 1;
                }
            }
        }
        println!("{found} gains, {rejected} rejected");
        assert!(found + rejected == 240 && rejected <= 2);
    }
    check::<f64>(1e-8);
    check::<f32>(1e-7);
}

/// A pendulum at rest in `target`, and its regulator, all computed in `A`. All numbers of a state have the same weight.
fn regulated<A: Arithmetic>(
    params: Params,
    target: State,
    weight: f64,
) -> (Pendulum<A>, Lqr<A::Scalar>) {
    let pendulum = Pendulum::new(params.cast(), target.cast()).unwrap();
    let model = discretize(&pendulum, A::Scalar::ZERO).unwrap();
    let q = diagonal([weight; 4]).map(cast);
    let regulator = lqr(&model, &q, Real::from_f64(1.0)).unwrap();
    (pendulum, regulator)
}

/// The default parameters with this `dt`.
fn every(dt: f64) -> Params {
    Params {
        dt,
        ..Params::DEFAULT
    }
}

/// The gain upright.
fn gain<A: Arithmetic>(dt: f64) -> [f64; 4] {
    let (_, regulator) = regulated::<A>(every(dt), State::UPRIGHT, 1.0);
    regulator.gain.map(Real::to_f64)
}

#[test]
fn single_precision_gives_the_same_gains() {
    for dt in [0.01, 0.2] {
        let expected = gain::<Portable>(dt);
        for found in [gain::<Fast>(dt), gain::<Micro>(dt)] {
            let error = relative(&found, &expected);
            assert!(error < 1e-4, "{dt} s: {error:e}");
        }
    }
}

/// From 0.04 rad, with a motor of 20 N m.
#[test]
fn the_regulator_holds_the_acrobot_upright() {
    fn check<A: Arithmetic>(dt: f64) {
        let (mut pendulum, regulator) = regulated::<A>(every(dt), State::UPRIGHT, 1.0);
        let leaning = State {
            theta1: -3.1,
            ..State::HANGING
        };
        pendulum.set_state(leaning.cast()).unwrap();
        for _ in 0..(20.0 / dt) as u32 {
            let torque = regulator.torque(pendulum.deviation(State::UPRIGHT));
            assert!(torque.to_f64().abs() < 20.0);
            pendulum.step(torque).unwrap();
        }
        let left = pendulum.deviation(State::UPRIGHT);
        // In `f32` small velocities no longer change an angle near π, and `Micro`'s sines move the equilibrium.
        assert!(left.iter().all(|x| x.to_f64().abs() < 1e-3), "{left:?}");
    }
    for dt in [0.01, 0.2] {
        check::<Reference>(dt);
        check::<Portable>(dt);
        check::<Fast>(dt);
        check::<Micro>(dt);
    }
}

/// How far link 1 may lean, mrad, at 100 Hz, so that a motor of `limit` brings it back from rest.
fn largest_lean(params: Params, limit: f64, weight: f64) -> usize {
    let (pendulum, regulator) = regulated::<Portable>(params, State::UPRIGHT, weight);
    let holds = |&lean: &u32| {
        let mut pendulum = pendulum.clone();
        let mut state = State::UPRIGHT;
        state.theta1 -= f64::from(lean) / 1000.0;
        pendulum.set_state(state).unwrap();
        for _ in 0..2000 {
            let torque = regulator.torque(pendulum.deviation(State::UPRIGHT));
            pendulum.step(bound(torque, limit)).unwrap();
        }
        let left = pendulum.deviation(State::UPRIGHT);
        left.iter().all(|x| x.abs() < 1e-3)
    };
    (1..1000).take_while(holds).count()
}

#[test]
fn a_weak_motor_holds_as_little_as_the_docs_say() {
    let default = every(0.01);
    let heavy = Params {
        mass2: 2.0,
        ..default
    };
    let rows = [1.0, 2.0, 5.0, 10.0].map(|limit| {
        let leans = [
            (default, 1.0),
            (default, 0.01),
            (default, 100.0),
            (heavy, 1.0),
        ]
        .map(|(params, weight)| largest_lean(params, limit, weight).to_string());
        format!("| {limit} | {} |", leans.join(" | "))
    });
    println!("{}", rows.join("\n"));
    assert_says("docs/control.md", &rows.join("\n"));
}

/// The largest deviation of an angle in the tenth second, mrad, of a regulator that begins at 10 mrad.
fn deviation_held<A: Arithmetic>(params: Params, target: State) -> f64 {
    let (mut pendulum, regulator) = regulated::<A>(params, target, 1.0);
    let target = target.cast();
    let mut state = target;
    state.theta1 = state.theta1 - Real::from_f64(0.01);
    pendulum.set_state(state).unwrap();
    let (steps, mut most) = ((10.0 / params.dt) as u32, 0.0_f64);
    for step in 0..steps {
        let x = pendulum.deviation(target);
        pendulum.step(regulator.torque(x)).unwrap();
        if step >= steps / 10 * 9 {
            most = most.max(x[0].to_f64().abs()).max(x[1].to_f64().abs());
        }
    }
    most * 1000.0
}

#[test]
fn single_precision_loses_upright_what_the_docs_say() {
    let rows = [100, 1000, 10_000].map(|rate| {
        let params = every(1.0 / f64::from(rate));
        let inverted = Params {
            gravity: -params.gravity,
            ..params
        };
        let upright = deviation_held::<Fast>(params, State::UPRIGHT);
        let hanging = deviation_held::<Fast>(inverted, State::HANGING);
        let portable = deviation_held::<Portable>(params, State::UPRIGHT);
        assert!(hanging < 1e-3 && portable < 1e-3);
        format!("| {rate} | {upright:.2} | {hanging:.2} | {portable:.2} |")
    });
    println!("{}", rows.join("\n"));
    assert_says("docs/control.md", &rows.join("\n"));
}

/// Central differences of steps, from states that are no equilibrium.
#[test]
fn a_step_moves_as_its_derivatives_say() {
    const H: f64 = 1e-6;
    for case in cases(Spread::Moderate) {
        let wide = f64::from(f32::MAX);
        let params = Params {
            max_velocity1: wide,
            max_velocity2: wide,
            ..case.params
        };
        let after = |y: [f64; 4], torque: f64| {
            let mut pendulum = Pendulum::<Portable>::new(params, y.into()).unwrap();
            pendulum.step(torque).unwrap();
            pendulum.state()
        };
        let pendulum = Pendulum::<Portable>::new(params, case.state).unwrap();
        let model = discretize(&pendulum, case.torque).unwrap();
        let y = <[f64; 4]>::from(case.state);
        for j in 0..5 {
            let moved = |h: f64| {
                let moved = from_fn(|i| if i == j { y[i] + h } else { y[i] });
                after(moved, if j == 4 { case.torque + h } else { case.torque })
            };
            let slope = difference::<Portable>(moved(H), moved(-H)).map(|x| x / (2.0 * H));
            let expected = from_fn::<_, 4, _>(|i| if j == 4 { model.b[i] } else { model.a[i][j] });
            let error = relative(&slope, &expected);
            assert!(error < 1e-7, "{error:e}");
        }
    }
}

fn upright() -> DiscreteModel {
    discretize(
        &Pendulum::<Portable>::new(Params::DEFAULT, State::UPRIGHT).unwrap(),
        0.0,
    )
    .unwrap()
}

fn diagonal(x: [f64; 4]) -> [[f64; 4]; 4] {
    from_fn(|i| from_fn(|j| if i == j { x[i] } else { 0.0 }))
}

#[test]
fn wrong_weights_are_rejected() {
    let message = |q, r| lqr(&upright(), &q, r).unwrap_err().to_string();
    for (r, got) in [
        (0.0, "0"),
        (-1.0, "-1"),
        (f64::NAN, "NaN"),
        (f64::INFINITY, "inf"),
    ] {
        let expected = format!("r must be finite and above 0 per (N m)², got {got}");
        assert_eq!(message(IDENTITY, r), expected);
    }
    assert_eq!(
        message(diagonal([1.0, f64::NAN, 1.0, 1.0]), 1.0),
        "q must be finite in each element, got NaN"
    );
    let mut q = IDENTITY;
    q[1][3] = 0.5;
    assert_eq!(
        message(q, 1.0),
        "q must be symmetric, got 0.5 and 0 on both sides of the diagonal"
    );
    q[3][1] = 0.5;
    assert!(lqr(&upright(), &q, 1.0).is_ok());
    [q[1][3], q[3][1]] = [2.0, 2.0];
    let rule = "q must be positive semidefinite, got ";
    assert!(message(q, 1.0).starts_with(rule));
    assert!(message(diagonal([1.0, 1.0, -1e-3, 1.0]), 1.0).starts_with(rule));
    assert!(message(diagonal([-1.0; 4]), 1.0).starts_with(rule));

    // Of rank 1, and so up to rounding.
    let row = [0.1, 0.7, -0.3, 0.9];
    assert!(lqr(&upright(), &row.map(|x| row.map(|y| x * y)), 1.0).is_ok());
}

#[test]
fn a_regulator_that_cannot_exist_is_an_error() {
    let growing = diagonal([1.1, 0.5, 0.4, 0.3]);
    let persistent = diagonal([1.0, 0.5, 0.4, 0.3]);
    let (none, all) = (diagonal([0.0; 4]), [1.0; 4]);
    let not_first = [0.0, 1.0, 1.0, 1.0];
    let (stabilizable, detectable) = (ControlError::NotStabilizable, ControlError::NotDetectable);
    for (a, b, q, expected) in [
        (growing, not_first, IDENTITY, stabilizable),
        (persistent, not_first, IDENTITY, stabilizable),
        (growing, [0.0; 4], IDENTITY, stabilizable),
        (diagonal([1.1, 1.1, 0.5, 0.3]), all, IDENTITY, stabilizable),
        (persistent, all, none, detectable),
        (
            diagonal([1.0, 1.5, 0.5, 0.5]),
            all,
            diagonal([0.0, 1.0, 1.0, 1.0]),
            detectable,
        ),
    ] {
        let error = lqr(&DiscreteModel { a, b }, &q, 1.0).unwrap_err();
        assert_eq!(error, expected, "{a:?} {b:?} {q:?}");
    }

    // A link on its centre of mass: gravity and the motor do not move link 1.
    let params = Params {
        center_of_mass1: 0.0,
        center_of_mass2: 0.0,
        gravity: 0.0,
        ..Params::DEFAULT
    };
    let pendulum = Pendulum::<Portable>::new(params, State::HANGING).unwrap();
    let model = discretize(&pendulum, 0.0).unwrap();
    let error = lqr(&model, &IDENTITY, 1.0).unwrap_err();
    assert_eq!(error, ControlError::NotStabilizable);

    // What `f32` cannot hold has a name.
    let model = DiscreteModel {
        a: growing.map(cast::<f32, 4>),
        b: [1e-30; 4],
    };
    let error = lqr(&model, &IDENTITY.map(cast), 1.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "cost_to_go must be finite in each element, got inf"
    );
}

/// Of all gains that stabilize, the regulator has the cheapest, even where the weights do not ask for one.
#[test]
fn a_motion_that_grows_is_stopped_without_weights() {
    let gain = |a, b, q| lqr(&DiscreteModel { a, b }, &q, 1.0).unwrap().gain;
    let (none, all) = (diagonal([0.0; 4]), [1.0; 4]);
    // The cheapest way mirrors 1.1 in the unit circle: 1.1 − k = 1 / 1.1.
    let found = gain(diagonal([1.1, 0.5, 0.4, 0.3]), all, none);
    assert!(
        relative(&found, &[1.1 - 1.0 / 1.1, 0.0, 0.0, 0.0]) < 1e-9,
        "{found:?}"
    );
    // Elements below 1, whose powers grow as 1.2.
    let found = gain([[0.3; 4]; 4], all, none);
    assert!(
        relative(&found, &[(1.2 - 1.0 / 1.2) / 4.0; 4]) < 1e-9,
        "{found:?}"
    );
    assert_eq!(gain(diagonal([0.5; 4]), all, none), [0.0; 4]);
    assert_eq!(gain(diagonal([0.5; 4]), [0.0; 4], IDENTITY), [0.0; 4]);
    assert_eq!(gain(none, all, IDENTITY), [0.0; 4]);
}

#[test]
fn inputs_that_are_not_finite_are_rejected() {
    let pendulum = Pendulum::<Fast>::hanging();
    let torque = "torque must be a finite number of N m, got NaN";
    assert_eq!(
        linearize(&pendulum, f32::NAN).unwrap_err().to_string(),
        torque
    );
    assert_eq!(
        discretize(&pendulum, f32::NAN).unwrap_err().to_string(),
        torque
    );
    let error = inverse_dynamics(&pendulum, [0.0, f32::INFINITY]).unwrap_err();
    let rule = "ddtheta2 must be a finite number of rad/s², got inf";
    assert_eq!(error.to_string(), rule);
}
