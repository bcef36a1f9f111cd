//! The tables of docs/control.md: what a regulator holds upright.

use std::f64::consts::PI;

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::control::regulator::Lqr;
use acrobot::physics::{Pendulum, saturate};
use acrobot::{Error, Fast, Params, Portable, State};
use common::{assert_says, in_every_arithmetic};

use crate::cast;
use crate::regulators::diagonal;

/// A pendulum in `target`, and its regulator under a torque, all computed in `A`. All numbers of a
/// state have the same weight.
fn regulated<A: Arithmetic>(
    params: Params,
    target: State,
    torque: f64,
    weight: f64,
) -> (Pendulum<A>, Result<Lqr<A::Scalar>, Error>) {
    let pendulum = Pendulum::new(params.cast(), target.cast()).unwrap();
    let q = diagonal([weight; 4]).map(cast);
    let regulator = pendulum.regulator(Real::from_f64(torque), &q, Real::from_f64(1.0));
    (pendulum, regulator)
}

/// The default parameters with this `dt`.
fn every(dt: f64) -> Params {
    Params { dt, ..Params::DEFAULT }
}

/// How far link 1 may lean, mrad, at 100 Hz, so that a motor of `limit` brings it back from rest.
fn largest_lean(params: Params, limit: f64, weight: f64) -> usize {
    let (pendulum, regulator) = regulated::<Portable>(params, State::UPRIGHT, 0.0, weight);
    let regulator = regulator.unwrap();
    let holds = |&lean: &u32| {
        let mut pendulum = pendulum.clone();
        let mut state = State::UPRIGHT;
        state.theta1 -= f64::from(lean) / 1000.0;
        pendulum.set_state(state).unwrap();
        for _ in 0..2000 {
            let torque = regulator.torque(pendulum.state().deviation_from(State::UPRIGHT));
            pendulum.step(saturate(torque, limit)).unwrap();
        }
        let left = pendulum.state().deviation_from(State::UPRIGHT);
        left.iter().all(|x| x.abs() < 1e-3)
    };
    (1..1000).take_while(holds).count()
}

#[test]
fn a_weak_motor_holds_as_little_as_the_docs_say() {
    let default = every(0.01);
    let heavy = Params { mass2: 2.0, ..default };
    let rows = [1.0, 2.0, 5.0, 10.0].map(|limit| {
        let leans = [(default, 1.0), (default, 0.01), (default, 100.0), (heavy, 1.0)]
            .map(|(params, weight)| largest_lean(params, limit, weight).to_string());
        format!("| {limit} | {} |", leans.join(" | "))
    });
    assert_says("docs/control.md", &rows.join("\n"));
}

/// The largest deviation of an angle in the tenth second, mrad, of a regulator that begins at 10
/// mrad.
fn deviation_held<A: Arithmetic>(params: Params, target: State) -> f64 {
    let (mut pendulum, regulator) = regulated::<A>(params, target, 0.0, 1.0);
    let regulator = regulator.unwrap();
    let target = target.cast();
    let mut state = target;
    state.theta1 = state.theta1 - Real::from_f64(0.01);
    pendulum.set_state(state).unwrap();
    let (steps, mut most) = ((10.0 / params.dt) as u32, 0.0_f64);
    for step in 0..steps {
        let x = pendulum.state().deviation_from(target);
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
        let inverted = Params { gravity: -params.gravity, ..params };
        let upright = deviation_held::<Fast>(params, State::UPRIGHT);
        let hanging = deviation_held::<Fast>(inverted, State::HANGING);
        let portable = deviation_held::<Portable>(params, State::UPRIGHT);
        assert!(hanging < 1e-3 && portable < 1e-3);
        format!("| {rate} | {upright:.2} | {hanging:.2} | {portable:.2} |")
    });
    assert_says("docs/control.md", &rows.join("\n"));
}

/// What counts as an equilibrium is the machine's own: a lean of 1.5 mrad, not of 3, whatever the
/// lengths.
#[test]
fn an_equilibrium_is_as_near_for_machines_of_any_size() {
    for length in [1e-3, 0.1, 1.0, 100.0] {
        let inertia = length * length;
        let params = Params {
            length1: length,
            center_of_mass1: length / 2.0,
            center_of_mass2: length / 2.0,
            inertia1: inertia,
            inertia2: inertia,
            dt: 0.02 * f64::sqrt(length),
            ..Params::DEFAULT
        };
        let lean = |lean, gravity| {
            let state = State { theta1: PI + lean, ..State::HANGING };
            let pendulum = Pendulum::<Portable>::new(Params { gravity, ..params }, state).unwrap();
            pendulum.regulator(0.0, &diagonal([1.0; 4]), 1.0).map(drop)
        };
        assert_eq!(lean(1.5e-3, 9.8), Ok(()));
        let error = lean(3e-3, 9.8).unwrap_err();
        let Error::NotInEquilibrium { rate, largest } = error else { panic!("{error}") };
        assert!(
            rate.abs() > largest && (largest * length * 4.5 / 19.6 / 2.5e-3 - 1.0).abs() < 1e-12
        );
        // At rest without gravity, but no motor holds it.
        assert_eq!(lean(1.0, 0.0), Err(Error::NotStabilizable));
    }
}

/// A regulator holds equilibria only, also bent ones, which need a torque.
#[test]
fn a_regulator_needs_an_equilibrium() {
    fn check<A: Arithmetic>() {
        let regulate = |state, torque| {
            let (_, regulator) = regulated::<A>(Params::DEFAULT, state, torque, 1.0);
            regulator.map(drop).map_err(|error| error.to_string())
        };
        // Link 2 is horizontal, and link 1 leans to the other side.
        let theta1 = PI - f64::asin(1.0 / 3.0);
        let bent = State::from([theta1, -PI / 2.0 - theta1, 0.0, 0.0]);
        let pendulum = Pendulum::<Portable>::new(Params::DEFAULT, bent).unwrap();
        let [_, torque] = pendulum.inverse_dynamics([0.0; 2]).unwrap().torques;
        assert!(torque.abs() > 2.0);
        for (state, torque) in [(State::HANGING, 0.0), (State::UPRIGHT, 0.0), (bent, torque)] {
            assert_eq!(regulate(state, torque), Ok(()), "{state:?}");
            let rule = "the state must be in equilibrium: at rest, accelerating at most 0.25 % of \
                a fall, got ";
            let moving = State { dtheta2: 0.25, ..state };
            assert_eq!(regulate(moving, torque), Err(format!("{rule}0.25")));
            let leaning = State { theta1: state.theta1 + 0.1, ..state };
            assert!(regulate(leaning, torque).unwrap_err().starts_with(rule));
            assert!(regulate(state, torque + 0.1).is_err());
        }
    }
    in_every_arithmetic!(check);
}
