//! The acrobot of Sutton & Barto (1st edition, 11.3) as it was simulated: four time steps of 0.05 s for each decision,
//! where Gymnasium takes one Runge-Kutta step of 0.2 s.
//!
//! The integrator is semi-implicit Euler, as in Sutton's Lisp: it updates the velocities first, and the angles with the
//! new velocities. Explicit Euler, which uses the old ones, adds energy and reaches the goal in about half the steps.

use acrobot::physics::{bound, derivative, tip_height};
use acrobot::{Params, Portable, State};

/// Gymnasium's parameters with shorter time steps. A decision lasts as long as Gymnasium's.
pub const PARAMS: Params = Params {
    dt: 0.05,
    ..Params::DEFAULT
};

/// The time steps of a decision.
const STEPS: u32 = 4;

/// The state one time step after `state`, under a torque in N m.
pub fn advance(state: &State, torque: f64) -> State {
    let [_, _, acceleration1, acceleration2] = derivative::<Portable>(&PARAMS, state, torque);
    let velocity = |old, acceleration, limit| bound(old + PARAMS.dt * acceleration, limit);
    let dtheta1 = velocity(state.dtheta1, acceleration1, PARAMS.max_velocity1);
    let dtheta2 = velocity(state.dtheta2, acceleration2, PARAMS.max_velocity2);
    State {
        theta1: state.theta1 + PARAMS.dt * dtheta1,
        theta2: state.theta2 + PARAMS.dt * dtheta2,
        dtheta1,
        dtheta2,
    }
}

/// Whether the tip is more than a link's length above the joint.
pub fn is_goal(state: &State) -> bool {
    tip_height::<Portable>(&PARAMS, state) > PARAMS.length1
}

/// The state after a decision. The goal ends it early.
pub fn decide(mut state: State, torque: f64) -> State {
    for _ in 0..STEPS {
        state = advance(&state, torque);
        if is_goal(&state) {
            break;
        }
    }
    state
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use acrobot::physics::energy;

    use super::*;

    /// Updates both angles with the old velocities.
    fn explicit_euler(state: &State) -> State {
        let rates = derivative::<Portable>(&PARAMS, state, 0.0);
        let y = <[f64; 4]>::from(*state);
        std::array::from_fn::<f64, 4, _>(|i| y[i] + PARAMS.dt * rates[i]).into()
    }

    #[test]
    fn the_simulator_keeps_the_energy_where_explicit_euler_does_not() {
        let start = State::from([1.0, -0.5, 0.0, 0.0]);
        let of = |state: &State| energy::<Portable>(&PARAMS, state);
        let farthest = |step: fn(&State) -> State| {
            let mut state = start;
            let errors = (0..2000).map(|_| {
                state = step(&state);
                (of(&state) - of(&start)).abs()
            });
            errors.fold(0.0, f64::max)
        };
        // In 100 s without torque; from hanging to upright are 39.2 J.
        let [kept, fed] = [
            farthest(|state| advance(state, 0.0)),
            farthest(explicit_euler),
        ];
        assert!(kept < 2.0, "{kept} J");
        assert!(fed > 10.0, "{fed} J");
    }

    #[test]
    fn the_simulator_updates_the_velocities_first_and_bounds_them() {
        let state = State::from([0.3, -0.2, 1.0, -2.0]);
        let [_, _, acceleration1, acceleration2] = derivative::<Portable>(&PARAMS, &state, 1.0);
        let next = advance(&state, 1.0);
        assert_eq!(next.dtheta1, 1.0 + 0.05 * acceleration1);
        assert_eq!(next.dtheta2, -2.0 + 0.05 * acceleration2);
        assert_eq!(next.theta1, 0.3 + 0.05 * next.dtheta1);
        assert_eq!(next.theta2, -0.2 + 0.05 * next.dtheta2);

        let whirling = advance(&State::from([0.0, 0.0, 50.0, -50.0]), 0.0);
        assert_eq!([whirling.dtheta1, whirling.dtheta2], [4.0 * PI, -9.0 * PI]);
    }

    #[test]
    fn the_goal_ends_a_decision_early() {
        let rising = State::from([2.0, 0.0, 1.0, 0.0]);
        assert!(!is_goal(&rising));
        let (mut state, mut steps) = (rising, 0);
        while !is_goal(&state) {
            state = advance(&state, 0.0);
            steps += 1;
        }
        assert!(steps < 4, "{steps}");
        assert_eq!(decide(rising, 0.0), state);
        let hanging = State::default();
        let four = (0..4).fold(hanging, |state, _| advance(&state, 1.0));
        assert_eq!(decide(hanging, 1.0), four);
    }
}
