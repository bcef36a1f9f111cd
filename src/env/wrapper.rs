//! `TimeLimit`, and environments that are borrowed or boxed.

use std::boxed::Box;
use std::vec::Vec;

use super::Env;
use crate::acrobot::Step;
use crate::action::Action;
use crate::task::ResetOptions;
use crate::time_limit::TimeLimit;

/// Sets `truncated` once the limit is reached, and keeps what the inner environment sets.
impl<E: Env> Env for TimeLimit<E> {
    fn inner(&self) -> &dyn Env {
        &self.inner
    }

    fn inner_mut(&mut self) -> &mut dyn Env {
        &mut self.inner
    }

    fn reset_with(&mut self, options: ResetOptions) -> Vec<f32> {
        self.elapsed_steps = 0;
        self.inner.reset_with(options)
    }

    fn step(&mut self, action: Action) -> Step<Vec<f32>> {
        let mut step = self.inner.step(action);
        step.truncated |= self.count();
        step
    }
}

/// A borrowed environment.
impl<E: Env> Env for &mut E {
    fn inner(&self) -> &dyn Env {
        &**self
    }

    fn inner_mut(&mut self) -> &mut dyn Env {
        &mut **self
    }
}

/// Wrappers that are chosen at run time.
impl Env for Box<dyn Env> {
    fn inner(&self) -> &dyn Env {
        &**self
    }

    fn inner_mut(&mut self) -> &mut dyn Env {
        &mut **self
    }
}
