//! Truncation: a limit on the steps of an episode.

use core::num::NonZeroU32;
use core::ops::Deref;

use rand_core::Rng;

use crate::acrobot::{Acrobot, Step};
use crate::action::Action;
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::numpy::SeedSequence;
use crate::task::{ResetOptions, Task, episode};

/// Gymnasium's `TimeLimit`: counts the steps since the last reset and sets `truncated` from the
/// limit on.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TimeLimit<E> {
    pub(crate) inner: E,
    max_steps: NonZeroU32,
    pub(crate) elapsed_steps: u32,
}

impl<E> TimeLimit<E> {
    /// Truncates episodes after `max_steps` steps.
    #[must_use]
    pub const fn new(inner: E, max_steps: NonZeroU32) -> Self {
        Self { inner, max_steps, elapsed_steps: 0 }
    }

    /// The number of steps after which episodes are truncated.
    #[must_use]
    pub const fn max_steps(&self) -> NonZeroU32 {
        self.max_steps
    }

    /// Sets the number of steps after which episodes are truncated. The count does not change.
    pub const fn set_max_steps(&mut self, max_steps: NonZeroU32) {
        self.max_steps = max_steps;
    }

    /// The number of steps since the last reset.
    #[must_use]
    #[inline]
    pub const fn elapsed_steps(&self) -> u32 {
        self.elapsed_steps
    }

    /// The wrapped environment.
    #[must_use]
    #[inline]
    pub const fn inner(&self) -> &E {
        &self.inner
    }

    /// The wrapped environment, to change it. Resetting it does not reset the count.
    #[must_use]
    #[inline]
    pub fn inner_mut(&mut self) -> &mut E {
        &mut self.inner
    }

    /// Counts a step. Returns whether the episode is truncated.
    #[inline]
    pub(crate) fn count(&mut self) -> bool {
        episode::count(&mut self.elapsed_steps, self.max_steps)
    }
}

impl<A: Arithmetic, T: Task> TimeLimit<Acrobot<A, T>> {
    /// As [`Acrobot::MAX_SNAPSHOT_SIZE`], with limit and count.
    #[cfg(feature = "serde")]
    pub const MAX_SNAPSHOT_SIZE: usize = Acrobot::<A, T>::MAX_SNAPSHOT_SIZE + 2 * 5;

    /// Calls [`Acrobot::reset_with_seed`] and sets the count of steps to 0.
    pub fn reset_with_seed(&mut self, seed: impl Into<SeedSequence>) -> T::Observation {
        self.elapsed_steps = 0;
        self.inner.reset_with_seed(seed)
    }

    /// Calls [`Acrobot::reset_with`] and sets the count of steps to 0.
    pub fn reset_with(&mut self, options: ResetOptions) -> T::Observation {
        self.elapsed_steps = 0;
        self.inner.reset_with(options)
    }
}

impl<A: Arithmetic, T: Task, R> TimeLimit<Acrobot<A, T, R>> {
    /// Truncates episodes after the steps that [the task has](Task::max_steps): 500 in Gymnasium's.
    #[must_use]
    pub fn with_task_limit(inner: Acrobot<A, T, R>) -> Self {
        let max_steps = inner.task().max_steps();
        Self::new(inner, max_steps)
    }
}

/// To read the acrobot. To change it, there is [`inner_mut`](TimeLimit::inner_mut): with `DerefMut`
/// a function that takes an acrobot could step it past the counter.
///
/// ```compile_fail,E0596
/// # use acrobot::{Acrobot, Action, Fast, TimeLimit};
/// fn step(acrobot: &mut Acrobot<Fast>) {
///     acrobot.step(Action::Zero);
/// }
///
/// step(&mut TimeLimit::with_task_limit(Acrobot::new(42)));
/// ```
// Not for any `E`: the methods of another wrapper would step past the counter.
impl<A: Arithmetic, T: Task, R> Deref for TimeLimit<Acrobot<A, T, R>> {
    type Target = Acrobot<A, T, R>;

    #[inline]
    fn deref(&self) -> &Self::Target {
        &self.inner
    }
}

impl<A: Arithmetic, T: Task, R: Rng> TimeLimit<Acrobot<A, T, R>> {
    /// Calls [`Acrobot::reset`] and sets the count of steps to 0.
    pub fn reset(&mut self) -> T::Observation {
        self.elapsed_steps = 0;
        self.inner.reset()
    }

    /// Calls [`Acrobot::step`] and counts the step.
    #[inline]
    pub fn step(&mut self, action: Action) -> Step<T::Observation> {
        let step = self.inner.step(action);
        let truncated = self.count();
        Step { truncated, ..step }
    }

    /// Calls [`Acrobot::step_torque`], with its errors, and counts the step.
    #[inline]
    pub fn step_torque(&mut self, torque: A::Scalar) -> Result<Step<T::Observation>, Error> {
        let step = self.inner.step_torque(torque)?;
        let truncated = self.count();
        Ok(Step { truncated, ..step })
    }
}
