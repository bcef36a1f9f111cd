//! An acrobot whose arithmetic and task are known only at run time.

use core::any::Any;
use core::fmt;
use std::boxed::Box;
use std::vec::Vec;

use crate::acrobot::{Acrobot, Step};
use crate::action::Action;
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::physics::{Params, State, check_params};
use crate::render::Figure;
use crate::task::{ResetOptions, Task};

/// The methods of an [`Acrobot`], with states and parameters in `f64`.
pub trait AnyAcrobot: Any + fmt::Debug + Send + Sync {
    fn boxed(&self) -> Box<dyn AnyAcrobot>;
    fn reset_with(&mut self, options: ResetOptions) -> Vec<f32>;
    fn step(&mut self, action: Action) -> Step<Vec<f32>>;
    fn observation_high(&self) -> Vec<f32>;
    fn state(&self) -> State;
    fn set_state(&mut self, state: State) -> Result<(), Error>;
    fn params(&self) -> Params;
    fn set_params(&mut self, params: Params) -> Result<(), Error>;
    fn figure(&self) -> Figure;
}

impl<A: Arithmetic, T: Task> AnyAcrobot for Acrobot<A, T> {
    fn boxed(&self) -> Box<dyn AnyAcrobot> {
        Box::new(self.clone())
    }

    fn reset_with(&mut self, options: ResetOptions) -> Vec<f32> {
        Self::reset_with(self, options).as_ref().into()
    }

    fn step(&mut self, action: Action) -> Step<Vec<f32>> {
        let Step { observation, reward, terminated, truncated } = Self::step(self, action);
        Step { observation: observation.as_ref().into(), reward, terminated, truncated }
    }

    fn observation_high(&self) -> Vec<f32> {
        self.task().observation_high(&Self::params(self).cast()).as_ref().into()
    }

    fn state(&self) -> State {
        Self::state(self).cast()
    }

    fn set_state(&mut self, state: State) -> Result<(), Error> {
        state.validate()?;
        let fields = state.fields().map(|(name, value, _)| (name, value));
        Self::set_state(self, state.cast()).map_err(|error| as_given(error, &fields))
    }

    fn params(&self) -> Params {
        Self::params(self).cast()
    }

    fn set_params(&mut self, params: Params) -> Result<(), Error> {
        check_params::<A>(&params)?;
        Self::set_params(self, params.cast()).map_err(|error| as_given(error, &params.numbers()))
    }

    fn figure(&self) -> Figure {
        Figure::new(self)
    }
}

/// The error of a number that is valid as `given`, and not after it was rounded to `f32`.
fn as_given(error: Error, given: &[(&'static str, f64)]) -> Error {
    let Error::OutOfRange { name, value: rounded, unit, .. } = error else {
        return error;
    };
    match given.iter().find(|(other, _)| *other == name) {
        Some(&(_, value)) if value != rounded => {
            Error::OutOfRange { name, value, unit, rule: "within its range as f32, in" }
        }
        _ => error,
    }
}
