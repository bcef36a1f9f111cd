//! Gymnasium's interface: environments, wrappers and spaces of observations, with [an
//! example](crate::guide::rust#spaces-wrappers-rendering).

mod space;

use std::boxed::Box;
use std::vec::Vec;

pub use space::BoxSpace;

use crate::acrobot::{Acrobot, Step};
use crate::action::Action;
use crate::arithmetic::Arithmetic;
use crate::numpy::SeedSequence;
use crate::task::{ResetOptions, Task};
use crate::time_limit::TimeLimit;

/// Gymnasium's `Env`: an acrobot of any arithmetic and task, or a wrapper around another
/// environment, such as [`TimeLimit`]. Wrappers of yours implement it:
///
/// ```
/// use acrobot::env::{BoxSpace, Env};
/// use acrobot::{Acrobot, Action, Portable, ResetOptions, Step, TimeLimit};
///
/// /// Rewards whose sum is at least −1.
/// struct Scaled<E>(E);
///
/// impl<E: Env> Env for Scaled<E> {
///     fn reset_with(&mut self, options: ResetOptions) -> Vec<f32> {
///         self.0.reset_with(options)
///     }
///
///     fn step(&mut self, action: Action) -> Step<Vec<f32>> {
///         let step = self.0.step(action);
///         Step { reward: step.reward / 500.0, ..step }
///     }
///
///     fn observation_space(&self) -> BoxSpace {
///         self.0.observation_space()
///     }
/// }
///
/// let mut env = Scaled(TimeLimit::with_task_limit(Acrobot::<Portable>::new(42)));
/// assert_eq!(env.step(Action::Zero).reward, -0.002);
/// ```
pub trait Env: Send {
    /// Gymnasium's `reset(seed=…, options=…)`: begins an episode and returns the observation of its
    /// initial state. Without a seed the generator continues its stream.
    fn reset_with(&mut self, options: ResetOptions) -> Vec<f32>;

    /// Takes one step.
    fn step(&mut self, action: Action) -> Step<Vec<f32>>;

    /// The set of all observations.
    fn observation_space(&self) -> BoxSpace;

    /// Gymnasium's `reset()`.
    fn reset(&mut self) -> Vec<f32> {
        self.reset_with(ResetOptions::default())
    }

    /// Gymnasium's `reset(seed=seed)`. For a `&mut dyn Env`: `reset_with(seed.into())`.
    fn reset_with_seed(&mut self, seed: impl Into<SeedSequence>) -> Vec<f32>
    where
        Self: Sized,
    {
        self.reset_with(seed.into().into())
    }
}

impl<A: Arithmetic, T: Task> Env for Acrobot<A, T> {
    fn reset_with(&mut self, options: ResetOptions) -> Vec<f32> {
        Self::reset_with(self, options).as_ref().into()
    }

    fn step(&mut self, action: Action) -> Step<Vec<f32>> {
        let Step { observation, reward, terminated, truncated } = Self::step(self, action);
        Step { observation: observation.as_ref().into(), reward, terminated, truncated }
    }

    /// The task's [bounds](Task::observation_high).
    fn observation_space(&self) -> BoxSpace {
        let high = self.task().observation_high(&self.params().cast());
        BoxSpace::symmetric(high.as_ref().into())
    }
}

/// Sets `truncated` once the limit is reached, and keeps what the inner environment sets.
impl<E: Env> Env for TimeLimit<E> {
    fn reset_with(&mut self, options: ResetOptions) -> Vec<f32> {
        self.elapsed_steps = 0;
        self.inner.reset_with(options)
    }

    fn step(&mut self, action: Action) -> Step<Vec<f32>> {
        let mut step = self.inner.step(action);
        step.truncated |= self.count();
        step
    }

    fn observation_space(&self) -> BoxSpace {
        self.inner.observation_space()
    }
}

/// An environment or wrappers that are chosen at run time.
impl<E: Env + ?Sized> Env for Box<E> {
    fn reset_with(&mut self, options: ResetOptions) -> Vec<f32> {
        (**self).reset_with(options)
    }

    fn step(&mut self, action: Action) -> Step<Vec<f32>> {
        (**self).step(action)
    }

    fn observation_space(&self) -> BoxSpace {
        (**self).observation_space()
    }
}
