//! Random actions.

use core::ptr;

use acrobot::Action;
use acrobot::numpy::{Pcg64, SeedSequence, uniform};

use crate::memory::{Holder, Span, array, change, check, check_apart, read_slice};
use crate::single::SNAPSHOTS;
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

/// As acrobot_action_space_init, with a seed of any size: its words of 32 bits, the lowest first.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_action_space_init_with(
    action_space: *mut acrobot_action_space_t,
    seed: *const u32,
    seed_words: usize,
) -> acrobot_status_t {
    status(|| {
        check_apart(&[Span::new(action_space, 1), Span::new(seed, seed_words)])?;
        Holder::init(action_space, SeedSequence::from_words(read_slice(seed, seed_words)?).into())
    })
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

/// Draws an action for each acrobot of a batch: `sample()` of Gymnasium's `MultiDiscrete`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_action_space_sample_each(
    action_space: *mut acrobot_action_space_t,
    actions: *mut u8,
    count: usize,
) -> acrobot_status_t {
    change(action_space, ptr::null_mut(), ptr::null_mut(), |rng| {
        let actions = array(actions, count)?;
        check_apart(&[Span::new(action_space, 1), Span::of(actions)])?;
        for index in 0..count {
            actions.cast::<u8>().add(index).write((3.0 * uniform(rng, 0.0, 1.0)) as u8);
        }
        Ok(())
    })
}
