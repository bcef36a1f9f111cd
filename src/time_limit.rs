//! Truncation: an episode that has lasted long enough is over.

use core::num::NonZeroU32;

use rand_core::Rng;

use crate::acrobot::{Acrobot, Step};
use crate::action::Action;
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::observation::Observation;
use crate::seed::SeedSequence;
use crate::state::StartBounds;

pub(crate) const V1: NonZeroU32 = NonZeroU32::new(500).unwrap();
const V0: NonZeroU32 = NonZeroU32::new(200).unwrap();

/// What a step under a [`TimeLimit`] returns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LimitedStep {
    /// What the agent sees of the new state.
    pub observation: Observation,
    /// −1, or 0 for the step that reaches the goal.
    pub reward: f32,
    /// Whether the new state is in the goal.
    pub terminated: bool,
    /// Whether the episode has had its steps, whatever the last of them reached.
    pub truncated: bool,
}

impl LimitedStep {
    /// Whether the episode is over, for either reason.
    #[must_use]
    #[inline]
    pub fn ended(&self) -> bool {
        self.terminated || self.truncated
    }
}

/// Gymnasium's `TimeLimit`: counts the steps since the last reset and reports truncation from the
/// limit on, apart from termination.
///
/// ```
/// use acrobot::{Acrobot, Action, Fast, TimeLimit};
///
/// let mut acrobot = TimeLimit::v1(Acrobot::<Fast>::new(42));
/// let mut length = 1;
/// while !acrobot.step(Action::Zero).ended() {
///     length += 1;
/// }
/// assert_eq!(length, 500);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TimeLimit<E = Acrobot> {
    pub(crate) inner: E,
    limit: NonZeroU32,
    elapsed: u32,
}

impl<E> TimeLimit<E> {
    /// Truncates after `limit` steps.
    #[must_use]
    pub fn new(inner: E, limit: NonZeroU32) -> Self {
        Self {
            inner,
            limit,
            elapsed: 0,
        }
    }

    /// Truncates after 500 steps, as `Acrobot-v1`.
    #[must_use]
    pub fn v1(inner: E) -> Self {
        Self::new(inner, V1)
    }

    /// Truncates after 200 steps, as `Acrobot-v0`.
    #[must_use]
    pub fn v0(inner: E) -> Self {
        Self::new(inner, V0)
    }

    /// The steps after which it truncates.
    #[must_use]
    pub fn limit(&self) -> NonZeroU32 {
        self.limit
    }

    /// The steps since the last reset.
    #[must_use]
    #[inline]
    pub fn elapsed(&self) -> u32 {
        self.elapsed
    }

    /// What it wraps.
    #[must_use]
    #[inline]
    pub fn inner(&self) -> &E {
        &self.inner
    }

    /// What it wraps, for live changes; a reset there does not reset the count here.
    #[must_use]
    #[inline]
    pub fn inner_mut(&mut self) -> &mut E {
        &mut self.inner
    }

    /// An episode begins.
    #[inline]
    pub(crate) fn restart(&mut self) {
        self.elapsed = 0;
    }

    /// A step was taken; whether it was the last.
    #[inline]
    pub(crate) fn count(&mut self) -> bool {
        self.elapsed = self.elapsed.saturating_add(1);
        self.elapsed >= self.limit.get()
    }
}

impl<A: Arithmetic> TimeLimit<Acrobot<A>> {
    /// [`Acrobot::reset_seeded`], and the count starts anew.
    pub fn reset_seeded(&mut self, seed: impl Into<SeedSequence>) -> Observation {
        self.restart();
        self.inner.reset_seeded(seed)
    }
}

impl<A: Arithmetic, R: Rng> TimeLimit<Acrobot<A, R>> {
    /// [`Acrobot::reset`], and the count starts anew.
    pub fn reset(&mut self) -> Observation {
        self.reset_within(StartBounds::DEFAULT)
    }

    /// [`Acrobot::reset_within`], and the count starts anew.
    pub fn reset_within(&mut self, bounds: StartBounds) -> Observation {
        self.restart();
        self.inner.reset_within(bounds)
    }

    /// [`Acrobot::step`], counted.
    #[inline]
    pub fn step(&mut self, action: Action) -> LimitedStep {
        let step = self.inner.step(action);
        self.limited(step)
    }

    /// [`Acrobot::step_torque`], counted.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a torque that is not finite; nothing is stepped or counted then.
    #[inline]
    pub fn step_torque(&mut self, torque: A::Scalar) -> Result<LimitedStep, Error> {
        let step = self.inner.step_torque(torque)?;
        Ok(self.limited(step))
    }

    #[inline]
    fn limited(&mut self, step: Step) -> LimitedStep {
        let Step {
            observation,
            reward,
            terminated,
        } = step;
        LimitedStep {
            observation,
            reward,
            terminated,
            truncated: self.count(),
        }
    }
}
