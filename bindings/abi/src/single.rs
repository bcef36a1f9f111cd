//! One acrobot in arithmetic `Damped<Fast>`.

use core::ffi::c_int;
use core::num::NonZeroU32;
use core::ptr;

use acrobot::arithmetic::Damped;
use acrobot::task::{Gymnasium, Task};
use acrobot::{Acrobot, Action, Fast, TimeLimit};

use crate::data::{
    acrobot_draws_t, acrobot_observation_t, acrobot_params_t, acrobot_state_t, acrobot_step_t,
};
use crate::linked::Linked;
use crate::memory::{Holder, Span, change, check, get, init, read};
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t, acrobot_status_t::*, status};
use crate::task::{acrobot_reset_options_t, read_options, task_of};

/// Whether there are snapshots: not on microcontrollers, where they would take 64 bytes of each
/// acrobot.
pub const SNAPSHOTS: bool = cfg!(any(target_pointer_width = "64", target_family = "wasm"));

/// Bytes of an acrobot_t. The header has this number, too.
pub const ACROBOT_SIZE: usize = if SNAPSHOTS { 304 } else { 240 };

/// Its alignment. malloc may align less, on microcontrollers to 8 bytes.
pub const ACROBOT_ALIGN: usize = 16;

/// One acrobot: Gymnasium's `Acrobot-v1`. Call acrobot_init first. You may copy and move it.
#[repr(C, align(16))]
pub struct acrobot_t {
    bytes: [u8; ACROBOT_SIZE],
}

type Limited = TimeLimit<Acrobot<Damped<Fast>, Linked>>;

impl Holder for acrobot_t {
    type Value = Limited;

    const TAG: u32 = u32::from_le_bytes(*b"acro");
}

const _: () = assert!(align_of::<acrobot_t>() == ACROBOT_ALIGN);

/// Gymnasium's `Acrobot-v1` in the state of `reset(seed=seed)`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_init(acrobot: *mut acrobot_t, seed: u64) -> acrobot_status_t {
    status(|| Holder::init(acrobot, TimeLimit::new(Acrobot::new(seed), Gymnasium::MAX_STEPS)))
}

/// As acrobot_init, for an ACROBOT_TASK with its parameters and its limit of steps.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_init_task(
    acrobot: *mut acrobot_t,
    task: c_int,
    seed: u64,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    init(acrobot, error, || {
        Ok(TimeLimit::with_task_limit(Acrobot::with_task(seed, Linked::new(task_of(task)?))?))
    })
}

/// Begins an episode in a drawn initial state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_reset(
    acrobot: *mut acrobot_t,
    observation: *mut acrobot_observation_t,
) -> acrobot_status_t {
    change(acrobot, observation, ptr::null_mut(), |acrobot| Ok(acrobot.reset().into()))
}

/// As acrobot_reset after seeding: Gymnasium's `reset(seed=seed)`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_reset_with_seed(
    acrobot: *mut acrobot_t,
    seed: u64,
    observation: *mut acrobot_observation_t,
) -> acrobot_status_t {
    let reset = |acrobot: &mut Limited| Ok(acrobot.reset_with_seed(seed).into());
    change(acrobot, observation, ptr::null_mut(), reset)
}

/// As acrobot_reset, with a seed of any size, or bounds of the initial state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_reset_with(
    acrobot: *mut acrobot_t,
    options: *const acrobot_reset_options_t,
    observation: *mut acrobot_observation_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    let span = Span::new(acrobot, 1);
    change(acrobot, observation, error, |acrobot| {
        Ok(acrobot.reset_with(read_options(options, span)?).into())
    })
}

/// Applies the torque of an ACROBOT_ACTION for one dt. After the end of an episode call
/// acrobot_reset; otherwise the acrobot steps on, as in Gymnasium.
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

/// Applies any finite torque, N m, for one dt. The `torques` of the parameters do not limit it.
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

/// Steps since the last reset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_elapsed_steps(
    acrobot: *const acrobot_t,
    steps: *mut u32,
) -> acrobot_status_t {
    get(acrobot, steps, |acrobot| Ok(acrobot.elapsed_steps()))
}

/// Its ACROBOT_TASK.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_task(
    acrobot: *const acrobot_t,
    task: *mut c_int,
) -> acrobot_status_t {
    get(acrobot, task, |acrobot| Ok(acrobot.task().task() as c_int))
}

/// Episodes are truncated after so many steps.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_max_steps(
    acrobot: *const acrobot_t,
    max_steps: *mut u32,
) -> acrobot_status_t {
    get(acrobot, max_steps, |acrobot| Ok(acrobot.max_steps().get()))
}

/// Sets the limit of steps, above 0.
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

/// The number of steps stays.
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

/// Sets the parameters of the next steps. The state stays.
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

/// Draws parameters from the acrobot's generator: call it after a reset.
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

/// The total energy of the state, J.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_energy(
    acrobot: *const acrobot_t,
    energy: *mut f32,
) -> acrobot_status_t {
    get(acrobot, energy, |acrobot| Ok(acrobot.pendulum().energy()))
}

/// The height of the tip above the fixed joint, m.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_tip_height(
    acrobot: *const acrobot_t,
    height: *mut f32,
) -> acrobot_status_t {
    get(acrobot, height, |acrobot| Ok(acrobot.pendulum().tip_height()))
}
