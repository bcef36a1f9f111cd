//! Tasks, and what a reset may choose.

use core::ffi::c_int;

use acrobot::ResetOptions;
use acrobot::numpy::SeedSequence;
#[cfg(feature = "instruments")]
use acrobot::task::Measured;
use acrobot::task::{AnyTask, ResetBounds};

use crate::memory::{Span, check_apart, read, read_slice};
use crate::status::Rejected;

// derive.py writes the tasks.

/// Gymnasium's `Acrobot-v1`: swing the tip above a height within 500 steps of 0.2 s.
pub const ACROBOT_TASK_GYMNASIUM: c_int = 0;

/// dm_control's `acrobot-swingup`, with friction: from rest anywhere to upright within 1,000 steps
/// of 0.01 s. The reward is from 0 to 1. The observation has the sines of both links' angles from
/// upright, their cosines, and the velocities.
pub const ACROBOT_TASK_SWINGUP: c_int = 1;

/// Stay upright for 500 steps of 0.02 s with a motor of 10 N m, from within ±0.05 of upright. The
/// reward is 1 upright and 0 hanging.
pub const ACROBOT_TASK_BALANCE: c_int = 2;

// The end of the tasks.

/// The task of batches.
#[cfg(not(feature = "instruments"))]
pub type BatchTask = AnyTask;

/// The task of batches, which have more memory than without instruments.
#[cfg(feature = "instruments")]
pub type BatchTask = Measured<AnyTask, { crate::instruments::ACROBOT_LONGEST_DELAY }>;

/// The task of a batch without its instruments.
#[cfg(not(feature = "instruments"))]
pub fn any_task(task: &BatchTask) -> AnyTask {
    *task
}

#[cfg(feature = "instruments")]
pub fn any_task(task: &BatchTask) -> AnyTask {
    *task.task()
}

pub fn task_of(number: c_int) -> Result<AnyTask, Rejected> {
    let task = usize::try_from(number).ok().and_then(|index| AnyTask::ALL.get(index));
    task.copied().ok_or(Rejected::number("task", number.into(), "", "an ACROBOT_TASK"))
}

/// What a reset may choose. Zeros: the random numbers continue, within the task's bounds.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_reset_options_t {
    /// A seed of any size: its words of 32 bits, the lowest first. Null: none.
    pub seed: *const u32,
    pub seed_words: usize,
    /// The lowest and the highest number of an initial state, rad and rad/s, about upright in a
    /// task that begins there. Both are finite as float. Null: those of the task.
    pub bounds: *const f64,
}

/// Reads options, which must not overlap what the call changes. Null is zeros.
pub unsafe fn read_options(
    options: *const acrobot_reset_options_t,
    changed: Span,
) -> Result<ResetOptions, Rejected> {
    if options.is_null() {
        return Ok(ResetOptions::default());
    }
    let acrobot_reset_options_t { seed, seed_words, bounds } = read(options)?;
    check_apart(&[changed, Span::new(options, 1), Span::new(seed, seed_words)])?;
    let seed = match seed.is_null() {
        true => None,
        false => Some(SeedSequence::from_words(read_slice(seed, seed_words)?)),
    };
    let bounds = match bounds.is_null() {
        true => None,
        false => {
            let [low, high] = read(bounds.cast::<[f64; 2]>())?;
            Some(ResetBounds::new(low, high)?)
        }
    };
    Ok(ResetOptions { seed, bounds })
}
