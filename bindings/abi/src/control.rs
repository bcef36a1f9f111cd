//! The model of a step, and a linear-quadratic regulator.

use acrobot::arithmetic::Damped;
use acrobot::control::model::StepModel;
use acrobot::physics::Pendulum;
use acrobot::{Fast, State};

use crate::data::acrobot_state_t;
use crate::memory::{change, check, get, read};
use crate::single::acrobot_t;
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t};

/// The deviation of the state from a finite `target`, with angles wrapped to ±π.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_deviation_from(
    acrobot: *const acrobot_t,
    target: *const acrobot_state_t,
    deviation: *mut acrobot_state_t,
) -> acrobot_status_t {
    get(acrobot, deviation, |acrobot| {
        let target = State::from(read(target)?);
        target.validate()?;
        Ok(State::from(acrobot.inner().pendulum().state().deviation_from(target)).into())
    })
}

/// One step, linearized: deviations x of the state and u of the torque become A x + B u.
#[repr(C)]
pub struct acrobot_step_model_t {
    /// A by rows, and B.
    pub a: [[f32; 4]; 4],
    pub b: [f32; 4],
}

/// Linearizes one step of the acrobot about any state and torque, N m.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_linearize_step(
    acrobot: *mut acrobot_t,
    state: *const acrobot_state_t,
    torque: f32,
    model: *mut acrobot_step_model_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(acrobot, model, error, |acrobot| {
        check(model)?;
        let pendulum = Pendulum::<Damped<Fast>>::new(*acrobot.params(), read(state)?.into())?;
        let StepModel { a, b } = pendulum.linearize_step(torque)?;
        Ok(acrobot_step_model_t { a, b })
    })
}

/// The gain of the linear-quadratic regulator that holds the acrobot at `target`. The torque is
/// −gain · x for a deviation x, a sum of four products; clamp it to that of your motor.
///
/// `target` must be in equilibrium without a torque, such as upright: velocities of 0, and
/// accelerations of at most 0.25 % of that of the straight acrobot that falls from horizontal. `q`
/// has the weights of the four squared deviations, 0 or more, in 1/rad² and s²/rad², and `r` that
/// of the squared torque, above 0, in 1/(N m)². Where no regulator exists, `error` names the
/// `gain`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_regulator(
    acrobot: *mut acrobot_t,
    target: *const acrobot_state_t,
    q: *const acrobot_state_t,
    r: f32,
    gain: *mut acrobot_state_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    const NAMES: [&str; 4] = ["q.theta1", "q.theta2", "q.dtheta1", "q.dtheta2"];

    change(acrobot, gain, error, |acrobot| {
        check(gain)?;
        let pendulum = Pendulum::<Damped<Fast>>::new(*acrobot.params(), read(target)?.into())?;
        let mut weights = [[0.0; 4]; 4];
        let diagonal: [f32; 4] = State::from(read(q)?).into();
        let elements = weights.as_flattened_mut().iter_mut().step_by(5);
        for ((to, weight), name) in elements.zip(diagonal).zip(NAMES) {
            if !(0.0..f32::INFINITY).contains(&weight) {
                let rule = "finite and at least 0";
                return Err(Rejected::number(name, weight.into(), "", rule));
            }
            *to = weight;
        }
        let regulator = pendulum.regulator(0.0, &weights, r)?;
        Ok(State::from(regulator.gain).into())
    })
}
