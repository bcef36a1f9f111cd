//! Estimates of a machine from its angles alone.

use core::mem::transmute;
use core::ptr;

use acrobot::arithmetic::Damped;
use acrobot::control::estimate::{
    Estimator, KalmanFilter, Noise, ParameterEstimator, ParameterStd,
};
use acrobot::{Fast, State};

use crate::data::{acrobot_params_t, acrobot_state_t};
use crate::memory::{Holder, change, get, init, read};
use crate::status::{acrobot_error_t, acrobot_status_t};

/// The noise of a machine.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_noise_t {
    /// The standard deviation of a measured angle, rad; above 0 and at most 2. An encoder with n
    /// counts for a turn has 1.8 / n.
    pub angle_std: f32,
    /// The standard deviation of the torque that acts, N m; above 0, and so small that a step
    /// changes θ̇2 by at most 1 / `dt`.
    pub torque_std: f32,
}

impl From<acrobot_noise_t> for Noise<f32> {
    fn from(acrobot_noise_t { angle_std, torque_std }: acrobot_noise_t) -> Self {
        Self { angle_std, torque_std }
    }
}

/// The standard deviations of parameters, each in its unit: 0 for one that is known.
// derive.py writes the fields.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_parameter_std_t {
    /// Of the mass of link 1, kg.
    pub mass1: f32,
    /// Of the mass of link 2, kg.
    pub mass2: f32,
    /// Of the length of link 1, m.
    pub length1: f32,
    /// Of the moment of inertia of link 1, kg m².
    pub inertia1: f32,
    /// Of the moment of inertia of link 2, kg m².
    pub inertia2: f32,
    /// Of the viscous friction of joint 1, N m s/rad.
    pub damping1: f32,
    /// Of the viscous friction of joint 2, N m s/rad.
    pub damping2: f32,
    /// Of the Coulomb friction of joint 1, N m.
    pub coulomb1: f32,
    /// Of the Coulomb friction of joint 2, N m.
    pub coulomb2: f32,
    /// Of the rotor, kg m².
    pub rotor: f32,
    /// Of what the first encoder says where θ1 is 0, rad. It is given as 0.
    pub zero1: f32,
    /// Of what the second encoder says where θ2 is 0, rad. It is given as 0.
    pub zero2: f32,
    /// Of the torque that acts, divided by the one that is sent. It is given as 1.
    pub torque_factor: f32,
}

/// Bytes of an acrobot_estimator_t.
pub const ACROBOT_ESTIMATOR_SIZE: usize = 304;

/// Estimates the state of a machine: an extended Kalman filter. Call acrobot_estimator_init first,
/// and then in each `dt` correct, decide and predict. You may copy and move it.
#[repr(C, align(16))]
pub struct acrobot_estimator_t {
    bytes: [u8; ACROBOT_ESTIMATOR_SIZE],
}

impl Holder for acrobot_estimator_t {
    type Value = Estimator<Damped<Fast>>;

    const TAG: u32 = u32::from_le_bytes(*b"esti");
}

/// Bytes of an acrobot_parameter_estimator_t.
pub const ACROBOT_PARAMETER_ESTIMATOR_SIZE: usize = 1344;

/// As acrobot_estimator_t, and estimates parameters.
#[repr(C, align(16))]
pub struct acrobot_parameter_estimator_t {
    bytes: [u8; ACROBOT_PARAMETER_ESTIMATOR_SIZE],
}

impl Holder for acrobot_parameter_estimator_t {
    type Value = ParameterEstimator<Damped<Fast>>;

    const TAG: u32 = u32::from_le_bytes(*b"pest");
}

/// Of a filter that has no measurement yet, they are infinite.
fn std_of<const K: usize>(filter: &KalmanFilter<Damped<Fast>, K>) -> acrobot_state_t {
    State::from(filter.state_std().unwrap_or([f32::INFINITY; 4])).into()
}

/// Estimates the state of a machine with these parameters. The first measurement sets it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_estimator_init(
    filter: *mut acrobot_estimator_t,
    params: *const acrobot_params_t,
    noise: *const acrobot_noise_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    init(filter, error, || Ok(Estimator::new(read(params)?.try_into()?, read(noise)?.into())?))
}

/// Corrects the estimate by measured angles, rad. The first ones are taken as they are, with
/// velocities of 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_estimator_correct(
    filter: *mut acrobot_estimator_t,
    theta1: f32,
    theta2: f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(filter, ptr::null_mut(), error, |value| Ok(value.correct([theta1, theta2])?))
}

/// Takes a step of `dt` with a torque, N m. Before a measurement it does nothing. If a joint turns
/// by more than half a turn in the step, or a number overflows, it is rejected, and the next
/// measurement begins again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_estimator_predict(
    filter: *mut acrobot_estimator_t,
    torque: f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(filter, ptr::null_mut(), error, |value| Ok(value.predict(torque)?))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_estimator_state(
    filter: *const acrobot_estimator_t,
    state: *mut acrobot_state_t,
) -> acrobot_status_t {
    get(filter, state, |value| Ok(value.state().into()))
}

/// The standard deviations of the state; INFINITY before a measurement.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_estimator_state_std(
    filter: *const acrobot_estimator_t,
    std: *mut acrobot_state_t,
) -> acrobot_status_t {
    get(filter, std, |value| Ok(std_of(value)))
}

/// Estimates the state, and the parameters whose standard deviation is not 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_parameter_estimator_init(
    filter: *mut acrobot_parameter_estimator_t,
    params: *const acrobot_params_t,
    std: *const acrobot_parameter_std_t,
    noise: *const acrobot_noise_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    init(filter, error, || {
        // SAFETY: both are `repr(C)` and have the same fields.
        let std = transmute::<acrobot_parameter_std_t, ParameterStd<f32>>(read(std)?);
        Ok(ParameterEstimator::new(read(params)?.try_into()?, std, read(noise)?.into())?)
    })
}

/// As acrobot_estimator_correct.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_parameter_estimator_correct(
    filter: *mut acrobot_parameter_estimator_t,
    theta1: f32,
    theta2: f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(filter, ptr::null_mut(), error, |value| Ok(value.correct([theta1, theta2])?))
}

/// As acrobot_estimator_predict.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_parameter_estimator_predict(
    filter: *mut acrobot_parameter_estimator_t,
    torque: f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(filter, ptr::null_mut(), error, |value| Ok(value.predict(torque)?))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_parameter_estimator_state(
    filter: *const acrobot_parameter_estimator_t,
    state: *mut acrobot_state_t,
) -> acrobot_status_t {
    get(filter, state, |value| Ok(value.state().into()))
}

/// As acrobot_estimator_state_std.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_parameter_estimator_state_std(
    filter: *const acrobot_parameter_estimator_t,
    std: *mut acrobot_state_t,
) -> acrobot_status_t {
    get(filter, std, |value| Ok(std_of(value)))
}

/// The estimated parameters, and those that are known.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_parameter_estimator_params(
    filter: *const acrobot_parameter_estimator_t,
    params: *mut acrobot_params_t,
) -> acrobot_status_t {
    get(filter, params, |value| Ok((*value.params()).into()))
}

/// What the encoders are estimated to say where the angles are 0, rad, and the torque that is
/// estimated to act, divided by the one of acrobot_parameter_estimator_predict.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_parameter_estimator_errors(
    filter: *const acrobot_parameter_estimator_t,
    errors: *mut [f32; 3],
) -> acrobot_status_t {
    get(filter, errors, |value| {
        let [zero1, zero2] = value.zeros();
        Ok([zero1, zero2, value.torque_factor()])
    })
}
