//! The acrobot of Sutton & Barto (1st edition, 11.3) as it was simulated: time steps of 0.05 s, four to a
//! decision, where Gymnasium takes one step of 0.2 s by Runge-Kutta.
//!
//! The velocities go first and the angles follow with the new ones: semi-implicit Euler, as in Sutton's
//! Lisp. Explicit Euler, angles by the old velocities, feeds energy in and is up in about half the steps.

use acrobot::{Params, Portable, State, bound, derivative, tip_height};

/// Gymnasium's acrobot, of which a decision lasts as long, in shorter time steps.
pub const PARAMS: Params = Params {
    dt: 0.05,
    ..Params::DEFAULT
};

/// Time steps under one torque.
const STEPS: u32 = 4;

/// What follows `state` after one time step under a torque in N m.
pub fn advance(state: &State, torque: f64) -> State {
    let [_, _, acceleration1, acceleration2] = derivative::<Portable>(&PARAMS, state, torque);
    let dtheta1 = bound(
        state.dtheta1 + PARAMS.dt * acceleration1,
        PARAMS.max_velocity1,
    );
    let dtheta2 = bound(
        state.dtheta2 + PARAMS.dt * acceleration2,
        PARAMS.max_velocity2,
    );
    State {
        theta1: state.theta1 + PARAMS.dt * dtheta1,
        theta2: state.theta2 + PARAMS.dt * dtheta2,
        dtheta1,
        dtheta2,
    }
}

/// Whether the tip is a link's length above the joint.
pub fn is_goal(state: &State) -> bool {
    tip_height::<Portable>(&PARAMS, state) > PARAMS.length1
}

/// What follows a decision, which the goal cuts short.
pub fn decide(mut state: State, torque: f64) -> State {
    for _ in 0..STEPS {
        state = advance(&state, torque);
        if is_goal(&state) {
            break;
        }
    }
    state
}
