//! Wrappers that are environments too: `TimeLimit`, `&mut E` and `Box<E>`.

use std::boxed::Box;

use super::error::Error;
use super::rendering::Rendering;
use super::{Env, Info};
use crate::acrobot::Step;
use crate::task::ResetOptions;
use crate::time_limit::TimeLimit;

/// Forwards parts of [`Env`] to the wrapped one: its types; an episode, which is `reset_with` and
/// `step`; all other methods; or only those of them without an observation.
macro_rules! forward {
    (types $inner:ident) => {
        type Observation = $inner::Observation;
        type Action = $inner::Action;
        type ObservationSpace = $inner::ObservationSpace;
        type ActionSpace = $inner::ActionSpace;
        type Unwrapped = $inner::Unwrapped;
    };
    (episode $self:ident, $inner:expr) => {
        fn reset_with(&mut $self, options: ResetOptions) -> (Self::Observation, Info) {
            $inner.reset_with(options)
        }

        fn step(&mut $self, action: Self::Action) -> Step<Self::Observation, Info> {
            $inner.step(action)
        }
    };
    ($self:ident, $inner:expr) => {
        fn observation_space(&$self) -> Self::ObservationSpace {
            $inner.observation_space()
        }

        forward!(unobserved $self, $inner);
    };
    (unobserved $self:ident, $inner:expr) => {
        fn action_space(&$self) -> Self::ActionSpace {
            $inner.action_space()
        }

        fn render(&mut $self) -> Result<Rendering, Error> {
            $inner.render()
        }

        fn close(&mut $self) {
            $inner.close();
        }

        fn unwrapped(&$self) -> &Self::Unwrapped {
            $inner.unwrapped()
        }

        fn unwrapped_mut(&mut $self) -> &mut Self::Unwrapped {
            $inner.unwrapped_mut()
        }
    };
}

pub(super) use forward;

/// Sets `truncated` once the limit is reached, and keeps what the wrapped environment sets.
impl<E: Env> Env for TimeLimit<E> {
    forward!(types E);

    fn reset_with(&mut self, options: ResetOptions) -> (E::Observation, Info) {
        self.elapsed_steps = 0;
        self.inner.reset_with(options)
    }

    fn step(&mut self, action: E::Action) -> Step<E::Observation, Info> {
        let mut step = self.inner.step(action);
        step.truncated |= self.count();
        step
    }

    forward!(self, self.inner);
}

/// A borrowed environment.
impl<E: Env + ?Sized> Env for &mut E {
    forward!(types E);
    forward!(episode self, (**self));
    forward!(self, (**self));
}

/// A boxed environment, such as the result of [`make`](super::make).
impl<E: Env + ?Sized> Env for Box<E> {
    forward!(types E);
    forward!(episode self, (**self));
    forward!(self, (**self));
}
