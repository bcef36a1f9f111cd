//! Model-predictive control: from encoder counts to torques.

use core::ptr;

use acrobot::control::mpc::{Controller, Replanner, Report, Settings};

use crate::data::{acrobot_params_t, acrobot_state_t};
use crate::memory::{Holder, Span, change, check, check_apart, get, init, read};
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t};

/// The decisions of a plan.
const DECISIONS: usize = 100;

/// A machine with encoders.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_settings_t {
    /// `dt` is the time from a tick to the next.
    pub params: acrobot_params_t,
    /// The motor's largest torque, N m.
    pub limit: f32,
    /// The counts of each encoder for a turn, above 0.
    pub counts: [i32; 2],
    /// The time from a torque of a tick until it acts, s, with the time constant of the motor: 0 if
    /// it acts at once.
    pub delay: f32,
    /// The torque is 0 while the plan is older than this, s, such as 1; INFINITY for never.
    pub plan_timeout: f32,
}

/// What a controller knows beside the state and the parameters.
#[repr(C)]
pub struct acrobot_report_t {
    /// What the encoders are estimated to say where the angles are 0, rad.
    pub zeros: [f32; 2],
    /// The torque that is estimated to act, divided by the one that is sent.
    pub torque_factor: f32,
    /// How many of the last hundred ticks have angles that no motion of the machine explains: a few
    /// after a push. And 4 for each radian that a joint has turned since the other one's encoder
    /// counted. Above 8 a tick is rejected.
    pub misses: f32,
    /// The time since the last plan, s. It is 0 before the first one.
    pub plan_age: f32,
}

impl TryFrom<acrobot_settings_t> for Settings {
    type Error = Rejected;

    fn try_from(settings: acrobot_settings_t) -> Result<Self, Rejected> {
        let acrobot_settings_t { params, limit, counts, delay, plan_timeout } = settings;
        Ok(Self { params: params.try_into()?, limit, counts, delay, plan_timeout })
    }
}

/// Bytes of an acrobot_controller_t.
pub const ACROBOT_CONTROLLER_SIZE: usize = 5808;

/// What a timer's interrupt does: it estimates the state, and follows a plan of 100 decisions. Call
/// acrobot_controller_init first. You may copy and move it.
#[repr(C, align(16))]
pub struct acrobot_controller_t {
    bytes: [u8; ACROBOT_CONTROLLER_SIZE],
}

impl Holder for acrobot_controller_t {
    type Value = Controller<DECISIONS>;

    const TAG: u32 = u32::from_le_bytes(*b"ctrl");
}

/// Bytes of an acrobot_replanner_t.
pub const ACROBOT_REPLANNER_SIZE: usize = 5392;

/// What the main loop does: it plans for the estimated machine while this moves. Call
/// acrobot_replanner_init first. You may copy and move it.
#[repr(C, align(16))]
pub struct acrobot_replanner_t {
    bytes: [u8; ACROBOT_REPLANNER_SIZE],
}

impl Holder for acrobot_replanner_t {
    type Value = Replanner<DECISIONS>;

    const TAG: u32 = u32::from_le_bytes(*b"repl");
}

/// A controller without a plan: its torque is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_controller_init(
    controller: *mut acrobot_controller_t,
    settings: *const acrobot_settings_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    init(controller, error, || Ok(Controller::new(read(settings)?.try_into()?)?))
}

/// The torque from now to the next tick, N m, from what both encoders count. It is short. If it is
/// rejected, switch the motor off: a number is not finite, or no motion of the machine explains
/// what the encoders count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_controller_tick(
    controller: *mut acrobot_controller_t,
    count1: i32,
    count2: i32,
    torque: *mut f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(controller, torque, error, |value| {
        check(torque)?;
        Ok(value.tick([count1, count2])?)
    })
}

/// The estimated state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_controller_state(
    controller: *const acrobot_controller_t,
    state: *mut acrobot_state_t,
) -> acrobot_status_t {
    get(controller, state, |value| Ok(value.state().into()))
}

/// The estimated parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_controller_params(
    controller: *const acrobot_controller_t,
    params: *mut acrobot_params_t,
) -> acrobot_status_t {
    get(controller, params, |value| Ok((*value.params()).into()))
}

/// What the controller knows beside the state and the parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_controller_report(
    controller: *const acrobot_controller_t,
    report: *mut acrobot_report_t,
) -> acrobot_status_t {
    get(controller, report, |value| {
        let Report { zeros, torque_factor, misses, plan_age } = value.report();
        Ok(acrobot_report_t { zeros, torque_factor, misses, plan_age })
    })
}

/// A replanner without a plan.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_replanner_init(
    replanner: *mut acrobot_replanner_t,
    settings: *const acrobot_settings_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    init(replanner, error, || Ok(Replanner::new(read(settings)?.try_into()?)?))
}

/// Gives the controller the plan once it is due, and takes the estimates. It is short, and no tick
/// may come meanwhile: switch the interrupt off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_replanner_exchange(
    replanner: *mut acrobot_replanner_t,
    controller: *mut acrobot_controller_t,
) -> acrobot_status_t {
    change(replanner, ptr::null_mut(), ptr::null_mut(), |value| {
        check_apart(&[Span::new(replanner, 1), Span::new(controller, 1)])?;
        value.exchange(Holder::value_mut(controller)?);
        Ok(())
    })
}

/// Plans for some milliseconds to tens of them: once after each acrobot_replanner_exchange. The
/// interrupt may stop it anywhere.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_replanner_work(
    replanner: *mut acrobot_replanner_t,
) -> acrobot_status_t {
    change(replanner, ptr::null_mut(), ptr::null_mut(), |value| {
        value.work();
        Ok(())
    })
}
