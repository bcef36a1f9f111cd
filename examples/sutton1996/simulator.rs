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
