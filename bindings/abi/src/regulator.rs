//! Linear-quadratic regulators, and Kalman filters.

use acrobot::control::model::{LinearModel, StepModel};
use acrobot::control::regulator::{self, Lqe, Lqr};

use crate::data::{acrobot_params_t, acrobot_state_t};
use crate::memory::{Span, array, check, check_apart, read};
use crate::model::{acrobot_linear_model_t, acrobot_step_model_t, compute, pendulum};
use crate::status::{acrobot_error_t, acrobot_status_t};

/// What a regulator weighs: xᵀ Q x + R u² for a deviation x of the state and u of the torque.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_weights_t {
    /// Q by rows, 1/rad² and s²/rad²: symmetric and positive semidefinite.
    pub q: [[f32; 4]; 4],
    /// R, 1/(N m)²; above 0.
    pub r: f32,
}

/// A linear-quadratic regulator.
#[repr(C)]
pub struct acrobot_lqr_t {
    /// K of u = −K x, N m per rad and per rad/s.
    pub gain: acrobot_state_t,
    /// P by rows: xᵀ P x is the cost from x on.
    pub cost_to_go: [[f32; 4]; 4],
}

impl From<Lqr<f32>> for acrobot_lqr_t {
    fn from(Lqr { gain, cost_to_go }: Lqr<f32>) -> Self {
        let [theta1, theta2, dtheta1, dtheta2] = gain;
        Self { gain: acrobot_state_t { theta1, theta2, dtheta1, dtheta2 }, cost_to_go }
    }
}

/// The regulator that holds a machine at `target`, which must be in equilibrium under `torque`,
/// N m, such as upright and 0: velocities of 0, and accelerations of at most 0.25 % of that with
/// which the straight machine, when it is horizontal, falls and is turned by the torque. Decisions
/// are `dt` apart. The torque is then `torque` − K x, a sum of four products; clamp it to that of
/// your motor.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_regulator(
    params: *const acrobot_params_t,
    target: *const acrobot_state_t,
    torque: f32,
    weights: *const acrobot_weights_t,
    lqr: *mut acrobot_lqr_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(lqr, error, || {
        let acrobot_weights_t { q, r } = read(weights)?;
        Ok(pendulum(params, target)?.regulator(torque, &q, r)?.into())
    })
}

/// The regulator of a model in continuous time: the least integral of the weights.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_lqr(
    model: *const acrobot_linear_model_t,
    weights: *const acrobot_weights_t,
    lqr: *mut acrobot_lqr_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(lqr, error, || {
        let acrobot_linear_model_t { a, b } = read(model)?;
        let acrobot_weights_t { q, r } = read(weights)?;
        Ok(regulator::lqr(&LinearModel { a, b }, &q, r)?.into())
    })
}

/// The regulator of a model of steps: the least sum of the weights.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_dlqr(
    model: *const acrobot_step_model_t,
    weights: *const acrobot_weights_t,
    lqr: *mut acrobot_lqr_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(lqr, error, || {
        let acrobot_step_model_t { a, b } = read(model)?;
        let acrobot_weights_t { q, r } = read(weights)?;
        Ok(regulator::dlqr(&StepModel { a, b }, &q, r)?.into())
    })
}

/// The regulator along a trajectory: `models` and `gains` have an element for each step. P of
/// xᵀ P x, the cost after the last step, becomes that before the first. Rejected calls may change
/// gains.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_tvlqr(
    models: *const acrobot_step_model_t,
    weights: *const acrobot_weights_t,
    cost_to_go: *mut [[f32; 4]; 4],
    gains: *mut acrobot_state_t,
    count: usize,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(cost_to_go, error, || {
        // Both are `repr(C)` and have the same fields.
        let models = array(models.cast::<StepModel<f32>>().cast_mut(), count)?;
        let gains = array(gains.cast::<[f32; 4]>(), count)?;
        check(cost_to_go)?;
        check_apart(&[Span::of(models), Span::of(gains), Span::new(cost_to_go, 1)])?;
        let acrobot_weights_t { q, r } = read(weights)?;
        Ok(regulator::tvlqr(&*models, &q, r, &*cost_to_go, &mut *gains)?)
    })
}

/// The noise of a model of steps whose angles are measured.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_covariances_t {
    /// W, that of the noise that each step adds to x, by rows, rad², rad²/s and rad²/s²: symmetric
    /// and positive semidefinite.
    pub w: [[f32; 4]; 4],
    /// The variances of both measurements, rad²; above 0.
    pub s: [f32; 2],
}

/// A steady-state Kalman filter.
#[repr(C)]
pub struct acrobot_lqe_t {
    /// L by rows: the correction of x by L (y − [x1, x2]) for the measured angles y.
    pub gain: [[f32; 2]; 4],
    /// P by rows: the covariance of the errors before the correction.
    pub prior_covariance: [[f32; 4]; 4],
}

/// The Kalman filter of a model of steps: the least variances of its errors after many steps.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_dlqe(
    model: *const acrobot_step_model_t,
    covariances: *const acrobot_covariances_t,
    lqe: *mut acrobot_lqe_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(lqe, error, || {
        let acrobot_step_model_t { a, b } = read(model)?;
        let acrobot_covariances_t { w, s } = read(covariances)?;
        let Lqe { gain, prior_covariance } = regulator::dlqe(&StepModel { a, b }, &w, s)?;
        Ok(acrobot_lqe_t { gain, prior_covariance })
    })
}
