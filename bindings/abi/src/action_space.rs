//! Random actions.

use core::ptr;

use acrobot::Action;
use acrobot::numpy::Pcg64;

use crate::SNAPSHOTS;
use crate::memory::{Holder, change, check};
use crate::status::{acrobot_status_t, status};

/// Bytes of an acrobot_action_space_t. The header has this number, too.
pub const ACROBOT_ACTION_SPACE_SIZE: usize = if SNAPSHOTS { 96 } else { 48 };

/// Draws random actions: Gymnasium's `action_space`. You may copy and move it.
#[repr(C, align(16))]
pub struct acrobot_action_space_t {
    bytes: [u8; ACROBOT_ACTION_SPACE_SIZE],
}

impl Holder for acrobot_action_space_t {
    type Value = Pcg64;

    const TAG: u32 = u32::from_le_bytes(*b"acts");
}

/// Gymnasium's `action_space.seed(seed)`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_action_space_init(
    action_space: *mut acrobot_action_space_t,
    seed: u64,
) -> acrobot_status_t {
    status(|| Holder::init(action_space, Pcg64::new(seed)))
}

/// Draws an action, all equally likely: Gymnasium's `action_space.sample()`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_action_space_sample(
    action_space: *mut acrobot_action_space_t,
    action: *mut u8,
) -> acrobot_status_t {
    change(action_space, action, ptr::null_mut(), |action_space| {
        check(action)?;
        Ok(Action::sample(action_space).into())
    })
}
