//! Makes environments from their ids.

use core::fmt;
use std::boxed::Box;
use std::string::String;

use super::acrobot_env::{AcrobotEnv, DynAcrobot};
use super::error::Error;
use super::rendering::{RenderMode, Rendering};
use super::space::{BoxSpace, DiscreteSpace};
use super::wrapper::forward;
use super::{Env, Info};
use crate::acrobot::Step;
use crate::action::Action;
use crate::arithmetic::{Arithmetic, Fast, Host, Micro, Portable, Reference};
use crate::physics::Params;
use crate::task::{Gymnasium, ResetOptions, Task};
use crate::time_limit::{TimeLimit, V0_MAX_STEPS};

/// The arithmetic that [`make_with`] computes in.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ArithmeticKind {
    /// [`Host`]: Gymnasium's own bits.
    #[default]
    Host,
    /// [`Reference`].
    Reference,
    /// [`Portable`].
    Portable,
    /// [`Fast`].
    Fast,
    /// [`Micro`].
    Micro,
}

/// The options of an environment.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// What `render` returns.
    pub render_mode: RenderMode,
    /// The arithmetic. [`acrobot_v1`] and [`acrobot_v0`] take it as a type and ignore this field.
    pub arithmetic: ArithmeticKind,
    /// The parameters.
    pub params: Params,
}

/// The environment that [`make`] returns, of either version and in any arithmetic.
pub type DynEnv = dyn Env<
        Observation = DynObservation,
        Action = Action,
        ObservationSpace = BoxSpace<DynObservation>,
        ActionSpace = DiscreteSpace<Action>,
        Unwrapped = dyn DynAcrobot,
    > + Send;

/// `Acrobot-v1`: observations with sines and cosines, and 500 steps.
///
/// # Errors
///
/// [`Error::Invalid`] for invalid parameters.
pub fn acrobot_v1<A: Arithmetic>(
    options: Options,
) -> Result<TimeLimit<AcrobotEnv<A, [f32; 6]>>, Error> {
    let env = AcrobotEnv::new(options.params, options.render_mode)?;
    Ok(TimeLimit::new(env, Gymnasium::MAX_STEPS))
}

/// `Acrobot-v0`: observations with the angles, and 200 steps. Its errors are those of
/// [`acrobot_v1`].
pub fn acrobot_v0<A: Arithmetic>(
    options: Options,
) -> Result<TimeLimit<AcrobotEnv<A, [f32; 4]>>, Error> {
    let env = AcrobotEnv::new(options.params, options.render_mode)?;
    Ok(TimeLimit::new(env, V0_MAX_STEPS))
}

impl fmt::Debug for DynEnv {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DynEnv").field("state", &self.unwrapped().state()).finish_non_exhaustive()
    }
}

/// Gymnasium's `make(id)`: `"Acrobot-v1"` or `"Acrobot-v0"`, with seed 0.
///
/// # Errors
///
/// [`Error::UnknownId`] for another id.
pub fn make(id: &str) -> Result<Box<DynEnv>, Error> {
    make_with(id, Options::default())
}

/// [`make`] with options: [an example with pictures](crate::guide::rust#spaces-wrappers-rendering).
///
/// # Errors
///
/// [`Error::UnknownId`] for another id, and [`Error::Invalid`] for invalid parameters.
pub fn make_with(id: &str, options: Options) -> Result<Box<DynEnv>, Error> {
    match options.arithmetic {
        ArithmeticKind::Host => make_in::<Host>(id, options),
        ArithmeticKind::Reference => make_in::<Reference>(id, options),
        ArithmeticKind::Portable => make_in::<Portable>(id, options),
        ArithmeticKind::Fast => make_in::<Fast>(id, options),
        ArithmeticKind::Micro => make_in::<Micro>(id, options),
    }
}

fn make_in<A: Arithmetic>(id: &str, options: Options) -> Result<Box<DynEnv>, Error> {
    match id {
        "Acrobot-v0" => Ok(Box::new(Erased(acrobot_v0::<A>(options)?))),
        "Acrobot-v1" => Ok(Box::new(Erased(acrobot_v1::<A>(options)?))),
        _ => {
            let mut start: String = id.chars().take(64).collect();
            if start.len() < id.len() {
                start.push('…');
            }
            Err(Error::UnknownId(start))
        }
    }
}

/// The observation of either version.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum DynObservation {
    /// Four numbers, in `Acrobot-v0`.
    V0([f32; 4]),
    /// Six numbers, in `Acrobot-v1`.
    V1([f32; 6]),
}

impl DynObservation {
    /// The numbers: six or four.
    #[must_use]
    pub fn as_slice(&self) -> &[f32] {
        self.as_ref()
    }
}

impl From<[f32; 4]> for DynObservation {
    fn from(observation: [f32; 4]) -> Self {
        Self::V0(observation)
    }
}

impl From<[f32; 6]> for DynObservation {
    fn from(observation: [f32; 6]) -> Self {
        Self::V1(observation)
    }
}

impl AsRef<[f32]> for DynObservation {
    fn as_ref(&self) -> &[f32] {
        match self {
            Self::V0(observation) => observation.as_ref(),
            Self::V1(observation) => observation.as_ref(),
        }
    }
}

impl AsMut<[f32]> for DynObservation {
    fn as_mut(&mut self) -> &mut [f32] {
        match self {
            Self::V0(observation) => observation.as_mut(),
            Self::V1(observation) => observation.as_mut(),
        }
    }
}

/// An environment with its types erased to those of [`DynEnv`].
struct Erased<E>(E);

impl<E, O> Env for Erased<E>
where
    E: Env<
            Observation = O,
            Action = Action,
            ObservationSpace = BoxSpace<O>,
            ActionSpace = DiscreteSpace<Action>,
            Unwrapped: DynAcrobot + Sized + 'static,
        >,
    O: AsRef<[f32]> + AsMut<[f32]> + Clone + Into<DynObservation>,
{
    type Observation = DynObservation;
    type Action = Action;
    type ObservationSpace = BoxSpace<DynObservation>;
    type ActionSpace = DiscreteSpace<Action>;
    type Unwrapped = dyn DynAcrobot;

    fn reset_with(&mut self, options: ResetOptions) -> (DynObservation, Info) {
        let (observation, info) = self.0.reset_with(options);
        (observation.into(), info)
    }

    fn step(&mut self, action: Action) -> Step<DynObservation, Info> {
        let step = self.0.step(action);
        Step {
            observation: step.observation.into(),
            reward: step.reward,
            terminated: step.terminated,
            truncated: step.truncated,
            info: step.info,
        }
    }

    fn observation_space(&self) -> BoxSpace<DynObservation> {
        self.0.observation_space().map(Into::into)
    }

    forward!(unobserved self, self.0);
}
