//! What a controller needs: the deviation from a state, and a regulator.

use acrobot::physics::Pendulum;
use acrobot::physics::control::{discretize, lqr};
use acrobot::{Fast, State};

use crate::data::acrobot_state_t;
use crate::memory::{get, get_or_explain, read};
use crate::single::acrobot_t;
use crate::status::{acrobot_error_t, acrobot_status_t};

/// The weights of a regulator: on the squares of the deviations and of the torque. Only their ratios matter.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_weights_t {
    /// Of the angle of link 1, 1/rad²; 0 or more.
    pub theta1: f32,
    /// Of the angle of link 2, 1/rad²; 0 or more.
    pub theta2: f32,
    /// Of the velocity of link 1, s²/rad²; 0 or more.
    pub dtheta1: f32,
    /// Of the velocity of link 2, s²/rad²; 0 or more.
    pub dtheta2: f32,
    /// R, of the torque, 1/(N m)²; above 0.
    pub torque: f32,
}

/// The gain of a regulator. Its torque is −(gain.theta1 · x.theta1 + gain.theta2 · x.theta2 + gain.dtheta1 · x.dtheta1 +
/// gain.dtheta2 · x.dtheta2) for a deviation x. Clamp it to that of your motor.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_gain_t {
    /// For the angle of link 1, N m/rad.
    pub theta1: f32,
    /// For the angle of link 2, N m/rad.
    pub theta2: f32,
    /// For the velocity of link 1, N m s/rad.
    pub dtheta1: f32,
    /// For the velocity of link 2, N m s/rad.
    pub dtheta2: f32,
}

/// The deviation of the state from `target`. Angles are wrapped to ±π, so it is continuous upright.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_deviation(
    acrobot: *const acrobot_t,
    target: *const acrobot_state_t,
    deviation: *mut acrobot_state_t,
) -> acrobot_status_t {
    get(acrobot, deviation, |acrobot| {
        let target = read(target)?.into();
        Ok(State::from(acrobot.inner().pendulum().deviation(target)).into())
    })
}

/// The gain of the linear-quadratic regulator that holds an acrobot with these parameters at `target` if it decides once
/// each dt. Call it once. `target` must be in equilibrium without a torque, such as upright. ACROBOT_ERROR_OUT_OF_RANGE
/// also means that these weights have no regulator. `error` may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_lqr(
    acrobot: *const acrobot_t,
    target: *const acrobot_state_t,
    weights: *const acrobot_weights_t,
    gain: *mut acrobot_gain_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    get_or_explain(acrobot, gain, error, |acrobot| {
        let target = read(target)?.into();
        let weights = read(weights)?;
        let pendulum = Pendulum::<Fast>::new(*acrobot.params(), target)?;
        let q = [
            [weights.theta1, 0.0, 0.0, 0.0],
            [0.0, weights.theta2, 0.0, 0.0],
            [0.0, 0.0, weights.dtheta1, 0.0],
            [0.0, 0.0, 0.0, weights.dtheta2],
        ];
        let regulator = lqr(&discretize(&pendulum, 0.0)?, &q, weights.torque)?;
        let [theta1, theta2, dtheta1, dtheta2] = regulator.gain;
        Ok(acrobot_gain_t {
            theta1,
            theta2,
            dtheta1,
            dtheta2,
        })
    })
}
