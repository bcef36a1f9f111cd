//! The settings of a batch, and its acrobots one by one.

use core::ffi::c_int;
use core::ptr;

use acrobot::batch::Autoreset;

use crate::batch::{
    ACROBOT_AUTORESET_DISABLED, ACROBOT_AUTORESET_NEXT_STEP, ACROBOT_AUTORESET_SAME_STEP,
    acrobot_batch_t,
};
use crate::data::{acrobot_draws_t, acrobot_params_t, acrobot_state_t};
use crate::memory::{change, get, read};
use crate::single::check_max_steps;
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t};

/// When acrobots are reset whose episode has ended: an ACROBOT_AUTORESET.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_autoreset(
    batch: *mut acrobot_batch_t,
    autoreset: c_int,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        placed.batch.set_autoreset(match autoreset {
            ACROBOT_AUTORESET_NEXT_STEP => Autoreset::NextStep,
            ACROBOT_AUTORESET_SAME_STEP => Autoreset::SameStep,
            ACROBOT_AUTORESET_DISABLED => Autoreset::Disabled,
            other => return Err(Rejected::number("autoreset", other.into(), "", "0, 1 or 2")),
        });
        Ok(())
    })
}

/// As acrobot_set_max_steps, for all acrobots.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_max_steps(
    batch: *mut acrobot_batch_t,
    max_steps: u32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        placed.batch.set_max_steps(check_max_steps(max_steps)?);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_state(
    batch: *const acrobot_batch_t,
    index: usize,
    state: *mut acrobot_state_t,
) -> acrobot_status_t {
    get(batch, state, |placed| Ok(placed.batch.state(index)?.into()))
}

/// The number of its steps stays.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_state(
    batch: *mut acrobot_batch_t,
    index: usize,
    state: *const acrobot_state_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        Ok(placed.batch.set_state(index, read(state)?.into())?)
    })
}

/// The steps of an acrobot since its last reset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_elapsed_steps(
    batch: *const acrobot_batch_t,
    index: usize,
    steps: *mut u32,
) -> acrobot_status_t {
    get(batch, steps, |placed| Ok(placed.batch.elapsed_steps(index)?))
}

/// Whether the episode of an acrobot has ended and it waits for a reset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_is_done(
    batch: *const acrobot_batch_t,
    index: usize,
    is_done: *mut bool,
) -> acrobot_status_t {
    get(batch, is_done, |placed| Ok(placed.batch.is_done(index)?))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_params(
    batch: *const acrobot_batch_t,
    index: usize,
    params: *mut acrobot_params_t,
) -> acrobot_status_t {
    get(batch, params, |placed| Ok(placed.batch.params(index)?.into()))
}

/// As acrobot_set_params, for one acrobot of a batch with own parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_params(
    batch: *mut acrobot_batch_t,
    index: usize,
    params: *const acrobot_params_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        Ok(placed.batch.set_params(index, read(params)?.try_into()?)?)
    })
}

/// As acrobot_set_params, for all acrobots.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_all_params(
    batch: *mut acrobot_batch_t,
    params: *const acrobot_params_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        Ok(placed.batch.set_all_params(read(params)?.try_into()?)?)
    })
}

/// From now on each reset of a batch with own parameters draws them, after the initial state and
/// from the same random numbers. Zeros end it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_draws(
    batch: *mut acrobot_batch_t,
    draws: *const acrobot_draws_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        Ok(placed.batch.set_draws(read(draws)?.try_into()?)?)
    })
}
