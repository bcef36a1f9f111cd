//! Swinging up without a plan.

use acrobot::Fast;
use acrobot::arithmetic::Damped;
use acrobot::control::plan::SwingUp;

use crate::data::{acrobot_params_t, acrobot_state_t};
use crate::memory::{Holder, change, check, init, read};
use crate::status::{acrobot_error_t, acrobot_status_t};

/// Bytes of an acrobot_swing_up_t.
pub const ACROBOT_SWING_UP_SIZE: usize = 496;

/// Swings up without a plan. Call acrobot_swing_up_init first. You may copy and move it.
#[repr(C, align(16))]
pub struct acrobot_swing_up_t {
    bytes: [u8; ACROBOT_SWING_UP_SIZE],
}

impl Holder for acrobot_swing_up_t {
    type Value = SwingUp<Damped<Fast>>;

    const TAG: u32 = u32::from_le_bytes(*b"swup");
}

/// For a machine with these parameters, whose `dt` is the time between two decisions, and a largest
/// torque, N m.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_swing_up_init(
    swing_up: *mut acrobot_swing_up_t,
    params: *const acrobot_params_t,
    limit: f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    init(swing_up, error, || Ok(SwingUp::new(read(params)?.try_into()?, limit)?))
}

/// The torque without a plan, N m, at most the largest. It pumps energy until the regulator holds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_swing_up_torque(
    swing_up: *mut acrobot_swing_up_t,
    state: *const acrobot_state_t,
    torque: *mut f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(swing_up, torque, error, |value| {
        check(torque)?;
        Ok(value.torque(read(state)?.into())?)
    })
}
