//! Models of a machine: its equations of motion, linear models, and inverse dynamics.

use core::ffi::c_int;

use acrobot::arithmetic::Damped;
use acrobot::control::model::{Forces, LinearModel, StepModel};
use acrobot::physics::Pendulum;
use acrobot::task::Task;
use acrobot::{Error, Fast, State};

use crate::data::{acrobot_params_t, acrobot_state_t};
use crate::memory::{check, read};
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t, status};
use crate::task::task_of;

/// Writes a result, or why a number was rejected, where not null.
pub unsafe fn compute<T>(
    result: *mut T,
    error: *mut acrobot_error_t,
    call: impl FnOnce() -> Result<T, Rejected>,
) -> acrobot_status_t {
    status(|| {
        check(result)?;
        if !error.is_null() {
            check(error)?;
        }
        result.write(call().inspect_err(|rejected| rejected.explain(error))?);
        Ok(())
    })
}

/// The default parameters of an ACROBOT_TASK.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_task_params(
    task: c_int,
    params: *mut acrobot_params_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(params, error, || Ok(task_of(task)?.params().cast::<f32>().into()))
}

/// A machine in a state, which is checked.
pub unsafe fn pendulum(
    params: *const acrobot_params_t,
    state: *const acrobot_state_t,
) -> Result<Pendulum<Damped<Fast>>, Rejected> {
    Ok(Pendulum::new(read(params)?.try_into()?, read(state)?.into())?)
}

/// The deviation of a state from a `target`, with angles wrapped to ±π.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_deviation_from(
    state: *const acrobot_state_t,
    target: *const acrobot_state_t,
    deviation: *mut acrobot_state_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(deviation, error, || {
        let [state, target] = [read(state)?, read(target)?].map(State::from);
        let deviation = State::from(state.deviation_from(target));
        // A difference is finite only if both numbers are.
        deviation.validate()?;
        Ok(deviation.into())
    })
}

/// How fast a state changes: angular velocities, rad/s, and accelerations, rad/s².
#[repr(C)]
pub struct acrobot_rates_t {
    pub dtheta1: f32,
    pub dtheta2: f32,
    pub ddtheta1: f32,
    pub ddtheta2: f32,
}

/// The rates of a state under a torque, N m, by the equations of motion.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_derivative(
    params: *const acrobot_params_t,
    state: *const acrobot_state_t,
    torque: f32,
    rates: *mut acrobot_rates_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(rates, error, || {
        let pendulum = pendulum(params, state)?;
        if !torque.is_finite() {
            return Err(Rejected::number("torque", torque.into(), "N m", "a finite number of"));
        }
        let [dtheta1, dtheta2, ddtheta1, ddtheta2] = finite("rates", pendulum.derivative(torque))?;
        Ok(acrobot_rates_t { dtheta1, dtheta2, ddtheta1, ddtheta2 })
    })
}

/// The mass matrix M by rows, kg m²: the kinetic energy is half of vᵀ M v for the velocities v.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_mass_matrix(
    params: *const acrobot_params_t,
    state: *const acrobot_state_t,
    mass_matrix: *mut [[f32; 2]; 2],
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(mass_matrix, error, || {
        let [row1, row2] = pendulum(params, state)?.mass_matrix();
        Ok([finite("mass_matrix", row1)?, finite("mass_matrix", row2)?])
    })
}

fn finite<const N: usize>(name: &'static str, numbers: [f32; N]) -> Result<[f32; N], Rejected> {
    match numbers.iter().find(|x| !x.is_finite()) {
        Some(&value) => Err(Error::NotFinite { name, value: value.into() }.into()),
        None => Ok(numbers),
    }
}

/// The torques and forces of a motion.
#[repr(C)]
pub struct acrobot_forces_t {
    /// The torques on θ1 and θ2 that the motion needs, N m. The second is that of the motor. The
    /// first joint has none, so an acrobot's first torque is 0.
    pub torques: [f32; 2],
    /// The force of the fixed joint on link 1, to the right and up, N.
    pub reaction: [f32; 2],
    /// The same of link 1 on link 2 in the elbow.
    pub elbow: [f32; 2],
}

/// What accelerations, rad/s², need in a state: the inverse of acrobot_derivative.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_inverse_dynamics(
    params: *const acrobot_params_t,
    state: *const acrobot_state_t,
    ddtheta1: f32,
    ddtheta2: f32,
    forces: *mut acrobot_forces_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(forces, error, || {
        let Forces { torques, reaction, elbow } =
            pendulum(params, state)?.inverse_dynamics([ddtheta1, ddtheta2])?;
        Ok(acrobot_forces_t { torques, reaction, elbow })
    })
}

/// The equations of motion, linearized: deviations x of the state and u of the torque have the
/// rates A x + B u.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_linear_model_t {
    /// A by rows, and B.
    pub a: [[f32; 4]; 4],
    pub b: [f32; 4],
}

/// Linearizes the equations of motion about any state and torque, N m.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_linearize(
    params: *const acrobot_params_t,
    state: *const acrobot_state_t,
    torque: f32,
    model: *mut acrobot_linear_model_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(model, error, || {
        let LinearModel { a, b } = pendulum(params, state)?.linearize(torque)?;
        Ok(acrobot_linear_model_t { a, b })
    })
}

/// One step of `dt`, linearized: deviations x of the state and u of the torque become A x + B u.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_step_model_t {
    /// A by rows, and B.
    pub a: [[f32; 4]; 4],
    pub b: [f32; 4],
}

/// Linearizes one step about any state and torque, N m.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_linearize_step(
    params: *const acrobot_params_t,
    state: *const acrobot_state_t,
    torque: f32,
    model: *mut acrobot_step_model_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(model, error, || {
        let StepModel { a, b } = pendulum(params, state)?.linearize_step(torque)?;
        Ok(acrobot_step_model_t { a, b })
    })
}
