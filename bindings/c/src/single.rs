//! One acrobot in arithmetic `Damped<Fast>`.

use core::ffi::c_int;
use core::num::NonZeroU32;
use core::ptr;

use acrobot::arithmetic::Damped;
use acrobot::task::{Balance, ResetBounds, Task};
use acrobot::{Acrobot, Action, Fast, TimeLimit};

use crate::data::{
    acrobot_draws_t, acrobot_observation_t, acrobot_params_t, acrobot_state_t, acrobot_step_t,
};
use crate::memory::{Holder, change, check, get, read};
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t, acrobot_status_t::*, status};
use crate::task::AnyTask;

pub const ACROBOT_SIZE: usize = 272;

pub const ACROBOT_ALIGN: usize = 16;

#[repr(C, align(16))]
pub struct acrobot_t {
    bytes: [u8; ACROBOT_SIZE],
}

impl Holder for acrobot_t {
    type Value = TimeLimit<Acrobot<Damped<Fast>, AnyTask>>;

    const TAG: u32 = u32::from_le_bytes(*b"acro");
}

const _: () = assert!(align_of::<acrobot_t>() == ACROBOT_ALIGN);

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_init(acrobot: *mut acrobot_t, seed: u64) -> acrobot_status_t {
    status(|| Holder::init(acrobot, TimeLimit::with_task_limit(Acrobot::new(seed))))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_init_balance(
    acrobot: *mut acrobot_t,
    seed: u64,
) -> acrobot_status_t {
    status(|| {
        let mut balance = Acrobot::new(seed);
        balance.set_task(AnyTask::Balance);
        balance.set_params(Balance::PARAMS.cast())?;
        balance.reset_with_seed(seed);
        Holder::init(acrobot, TimeLimit::with_task_limit(balance))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_reset(
    acrobot: *mut acrobot_t,
    observation: *mut acrobot_observation_t,
) -> acrobot_status_t {
    change(acrobot, observation, ptr::null_mut(), |acrobot| Ok(acrobot.reset().into()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_reset_with_seed(
    acrobot: *mut acrobot_t,
    seed: u64,
    observation: *mut acrobot_observation_t,
) -> acrobot_status_t {
    change(acrobot, observation, ptr::null_mut(), |acrobot| {
        Ok(acrobot.reset_with_seed(seed).into())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_reset_within(
    acrobot: *mut acrobot_t,
    low: f64,
    high: f64,
    observation: *mut acrobot_observation_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(acrobot, observation, error, |acrobot| {
        let bounds = ResetBounds::new(low, high)?;
        Ok(acrobot.reset_with(bounds.into()).into())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_step(
    acrobot: *mut acrobot_t,
    action: c_int,
    step: *mut acrobot_step_t,
) -> acrobot_status_t {
    change(acrobot, step, ptr::null_mut(), |acrobot| {
        check(step)?;
        let action = u8::try_from(action).map_err(|_| ACROBOT_ERROR_UNKNOWN_ACTION)?;
        Ok(acrobot.step(Action::try_from(action)?).into())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_step_torque(
    acrobot: *mut acrobot_t,
    torque: f32,
    step: *mut acrobot_step_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(acrobot, step, error, |acrobot| {
        check(step)?;
        Ok(acrobot.step_torque(torque)?.into())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_observe(
    acrobot: *const acrobot_t,
    observation: *mut acrobot_observation_t,
) -> acrobot_status_t {
    get(acrobot, observation, |acrobot| Ok(acrobot.observation().into()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_elapsed_steps(
    acrobot: *const acrobot_t,
    steps: *mut u32,
) -> acrobot_status_t {
    get(acrobot, steps, |acrobot| Ok(acrobot.elapsed_steps()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_set_max_steps(
    acrobot: *mut acrobot_t,
    max_steps: u32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(acrobot, ptr::null_mut(), error, |acrobot| {
        acrobot.set_max_steps(check_max_steps(max_steps)?);
        Ok(())
    })
}

pub fn check_max_steps(max_steps: u32) -> Result<NonZeroU32, Rejected> {
    NonZeroU32::new(max_steps).ok_or(Rejected::number("max_steps", 0.0, "steps", "above 0"))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_state(
    acrobot: *const acrobot_t,
    state: *mut acrobot_state_t,
) -> acrobot_status_t {
    get(acrobot, state, |acrobot| Ok(acrobot.state().into()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_set_state(
    acrobot: *mut acrobot_t,
    state: *const acrobot_state_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(acrobot, ptr::null_mut(), error, |acrobot| {
        Ok(acrobot.inner_mut().set_state(read(state)?.into())?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_params(
    acrobot: *const acrobot_t,
    params: *mut acrobot_params_t,
) -> acrobot_status_t {
    get(acrobot, params, |acrobot| Ok((*acrobot.params()).into()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_set_params(
    acrobot: *mut acrobot_t,
    params: *const acrobot_params_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(acrobot, ptr::null_mut(), error, |acrobot| {
        Ok(acrobot.inner_mut().set_params(read(params)?.try_into()?)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_draw_params(
    acrobot: *mut acrobot_t,
    draws: *const acrobot_draws_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(acrobot, ptr::null_mut(), error, |acrobot| {
        Ok(acrobot.inner_mut().draw_params(&read(draws)?.try_into()?)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_energy(
    acrobot: *const acrobot_t,
    energy: *mut f32,
) -> acrobot_status_t {
    get(acrobot, energy, |acrobot| Ok(acrobot.pendulum().energy()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_tip_height(
    acrobot: *const acrobot_t,
    height: *mut f32,
) -> acrobot_status_t {
    get(acrobot, height, |acrobot| Ok(acrobot.pendulum().tip_height()))
}
