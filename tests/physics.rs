//! The equations of motion are right, in both forms, and so are positions, mass matrix and energy.

use acrobot::arithmetic::{Arithmetic, Damped, Form, Reference};
use acrobot::batch::VecBatch;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::{Dynamics, Pendulum};
use acrobot::task::{Draw, Draws};
use acrobot::{Acrobot, Params, Portable, State, TimeLimit};

/// `Portable`'s scalar and sines with Gymnasium's form of the equations, where `Portable` has the
/// lean one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct GymnasiumF64;

impl Arithmetic for GymnasiumF64 {
    const NAME: &'static str = "gymnasium f64";
    type Scalar = f64;
    const FORM: Form = Form::Gymnasium;

    fn sin_cos(x: f64) -> (f64, f64) {
        Portable::sin_cos(x)
    }
}

/// Random parameters, states and torques.
fn random_cases() -> impl Iterator<Item = (Params, State, f64)> {
    let mut rng = Pcg64::new(1);
    let mut draw = move |low, high| uniform(&mut rng, low, high);
    (0..10_000).map(move |_| {
        let params = Params {
            length1: draw(0.2, 3.0),
            length2: draw(0.2, 3.0),
            mass1: draw(0.2, 5.0),
            mass2: draw(0.2, 5.0),
            center_of_mass1: draw(0.0, 2.0),
            center_of_mass2: draw(0.0, 2.0),
            inertia1: draw(0.1, 3.0),
            inertia2: draw(0.1, 3.0),
            gravity: draw(-20.0, 20.0),
            ..Params::DEFAULT
        };
        params.validate().unwrap();
        let state =
            State::from([draw(-4.0, 4.0), draw(-4.0, 4.0), draw(-12.0, 12.0), draw(-28.0, 28.0)]);
        (params, state, draw(-5.0, 5.0))
    })
}

/// The largest |x − y|, relative to the largest number of both.
fn relative(x: [f64; 2], y: [f64; 2]) -> f64 {
    let scale = x.into_iter().chain(y).fold(1.0, |scale: f64, z| scale.max(z.abs()));
    (x[0] - y[0]).abs().max((x[1] - y[1]).abs()) / scale
}

/// Hundreds of roundings of terms that are up to a thousand times the result.
const ROUNDING: f64 = 1e-11;

/// Newton and Euler's recursion shares no formula with the equations. `cargo test --test control`
/// compares its torques with Lagrange's equations.
#[test]
fn the_equations_are_the_inverse_of_newton_and_eulers() {
    fn check<A: Arithmetic<Scalar = f64>>(params: Params, state: State, torque: f64) {
        let pendulum = Pendulum::<A>::new(params, state).unwrap();
        let torques = |accelerations| pendulum.inverse_dynamics(accelerations).unwrap().torques;
        let [_, _, ddtheta1, ddtheta2] = pendulum.derivative(torque);
        let [joint, motor] = torques([ddtheta1, ddtheta2]);
        let scale = torques([0.0; 2]).into_iter().fold(1.0, |scale: f64, x| scale.max(x.abs()));
        let error = joint.abs().max((motor - torque).abs()) / scale;
        assert!(error <= ROUNDING, "{}: {error:e}: {params:?} {state:?}", A::NAME);
    }
    for (params, state, torque) in random_cases() {
        for dynamics in [Dynamics::Book, Dynamics::Nips] {
            let params = Params { dynamics, ..params };
            check::<Portable>(params, state, torque);
            check::<GymnasiumF64>(params, state, torque);
            let params = Params { damping1: 0.3, damping2: 0.7, ..params };
            let params = Params { coulomb1: 0.2, coulomb2: 0.1, ..params }.with_rotor(0.002, 6.0);
            check::<Damped<Portable>>(params, state, torque);
            check::<Damped<Reference>>(params, state, torque);
            check::<Damped<GymnasiumF64>>(params, state, torque);
        }
    }
}

/// Elbow and tip are at the ends of their links, x to the right and y up. The mass matrix has the
/// torques that accelerations add. The energy is that of both centres of mass, and half of the
/// velocities times it.
#[test]
fn positions_and_energies_follow_from_states_and_torques() {
    for (params, state, _) in random_cases() {
        let moving = Pendulum::<Portable>::new(params, state).unwrap();
        let at_rest = State { dtheta1: 0.0, dtheta2: 0.0, ..state };
        let resting = Pendulum::<Portable>::new(params, at_rest).unwrap();
        let torques = |accelerations| resting.inverse_dynamics(accelerations).unwrap().torques;
        let [weight1, weight2] = torques([0.0; 2]);
        let rows = moving.mass_matrix();
        for (i, accelerations) in [[1.0, 0.0], [0.0, 1.0]].into_iter().enumerate() {
            let [torque1, torque2] = torques(accelerations);
            let added = [torque1 - weight1, torque2 - weight2];
            assert!(relative(rows.map(|row| row[i]), added) <= ROUNDING, "{params:?} {state:?}");
        }

        let [(sin1, cos1), (sin_sum, cos_sum)] =
            [state.theta1, state.theta1 + state.theta2].map(Portable::sin_cos);
        let elbow = [params.length1 * sin1, -params.length1 * cos1];
        let tip = [elbow[0] + params.length2 * sin_sum, elbow[1] - params.length2 * cos_sum];
        let found = resting.positions();
        assert!(relative(found[0], elbow).max(relative(found[1], tip)) <= ROUNDING, "{found:?}");
        assert!((resting.tip_height() - tip[1]).abs() <= ROUNDING);

        let center1 = -params.center_of_mass1 * cos1;
        let center2 = elbow[1] - params.center_of_mass2 * cos_sum;
        let potential = params.gravity * (params.mass1 * center1 + params.mass2 * center2);
        let [momentum1, momentum2] = rows.map(|[x, y]| x * state.dtheta1 + y * state.dtheta2);
        let kinetic = (momentum1 * state.dtheta1 + momentum2 * state.dtheta2) / 2.0;
        let found = [resting.energy(), moving.energy()];
        let error = relative(found, [potential, potential + kinetic]);
        assert!(error <= ROUNDING, "{error:e}: {params:?} {state:?}");
    }
}

#[test]
fn an_arithmetic_without_friction_rejects_it() {
    let rule = "damping2 must be 0 unless the arithmetic is Damped, in N m s/rad, got 0.5";
    let with = Params { damping1: -0.0, damping2: 0.5, ..Params::DEFAULT };
    let damping2 = Draw::Uniform { low: 0.0, high: 0.5 };
    let draws = Draws::new(Params { damping2, ..Draws::FIXED }).unwrap();
    let mut pendulum = Pendulum::<Portable>::hanging();
    let mut acrobot = TimeLimit::with_task_limit(Acrobot::<Portable>::new(0));
    let mut batch = VecBatch::<Portable>::new(0, 2).unwrap();
    let shared = batch.set_all_params(with);
    batch.own_params().unwrap();
    let mut member = batch.member(0).unwrap();
    member.params = with;
    let before = (pendulum.clone(), acrobot.clone(), batch.member(1), *batch.draws());
    for result in [
        shared,
        Pendulum::<Portable>::new(with, State::HANGING).map(drop),
        with.pendulum::<Portable>(State::HANGING).map(drop),
        pendulum.set_params(with),
        acrobot.inner_mut().set_params(with),
        batch.set_all_params(with),
        batch.set_params(1, with),
        batch.set_member(1, member),
        batch.set_draws(draws),
    ] {
        assert_eq!(result.unwrap_err().to_string(), rule);
    }
    let after = (pendulum, acrobot, batch.member(1), *batch.draws());
    assert_eq!(after, before);
}
