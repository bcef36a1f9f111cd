//! Environments by their names.

use core::fmt;
use core::ops::Deref;
use std::borrow::ToOwned;
use std::boxed::Box;

use super::{
    AcrobotEnv, BoxSpace, Discrete, Env, EnvStep, Error, Info, LiveAcrobot, RenderMode, Rendering,
};
use crate::arithmetic::{Arithmetic, Fast, Host, Micro, Portable};
use crate::params::Params;
use crate::seed::SeedSequence;
use crate::state::StartBounds;
use crate::time_limit::TimeLimit;
use crate::{Action, Observation};

/// Which arithmetic [`make_with`] computes in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ArithmeticKind {
    /// [`Host`]: Gymnasium's episodes.
    #[default]
    Host,
    /// [`Portable`].
    Portable,
    /// [`Fast`].
    Fast,
    /// [`Micro`].
    Micro,
}

/// How an environment is made; the default is Gymnasium's `make(id)`.
#[derive(Clone, Debug)]
pub struct Options {
    /// What `render` returns.
    pub render_mode: RenderMode,
    /// What it computes in; the typed constructors have it as a type.
    pub arithmetic: ArithmeticKind,
    /// Dynamics, time step, noise, masses and all the rest.
    pub params: Params,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            render_mode: RenderMode::None,
            arithmetic: ArithmeticKind::Host,
            params: Params::DEFAULT,
        }
    }
}

/// The environment that [`make`] returns, of either version and any arithmetic.
///
/// ```
/// use acrobot::env::{DynEnv, Env, Reading, make};
///
/// fn start(env: &mut DynEnv) -> Reading {
///     env.reset(Some(42.into()), None).0
/// }
///
/// assert!(matches!(start(&mut *make("Acrobot-v0")?), Reading::V0(_)));
/// assert_eq!(start(&mut *make("Acrobot-v1")?).len(), 6);
/// # Ok::<(), acrobot::env::Error>(())
/// ```
pub type DynEnv = dyn Env<
        Observation = Reading,
        Action = Action,
        ObservationSpace = BoxSpace<Reading>,
        ActionSpace = Discrete<Action>,
        Unwrapped = dyn LiveAcrobot,
    > + Send;

/// `Acrobot-v1`: sines and cosines of the angles, and 500 steps.
///
/// # Errors
///
/// [`Error::Invalid`] for parameters that are refused.
pub fn acrobot_v1<A: Arithmetic>(
    options: Options,
) -> Result<TimeLimit<AcrobotEnv<A, Observation<6>>>, Error> {
    Ok(TimeLimit::v1(AcrobotEnv::new(
        options.params,
        options.render_mode,
    )?))
}

/// `Acrobot-v0`: the angles themselves, and 200 steps.
///
/// # Errors
///
/// [`Error::Invalid`] for parameters that are refused.
pub fn acrobot_v0<A: Arithmetic>(
    options: Options,
) -> Result<TimeLimit<AcrobotEnv<A, Observation<4>>>, Error> {
    Ok(TimeLimit::v0(AcrobotEnv::new(
        options.params,
        options.render_mode,
    )?))
}

impl fmt::Debug for DynEnv {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DynEnv")
            .field("state", &self.unwrapped().state())
            .finish_non_exhaustive()
    }
}

/// Gymnasium's `make(id)`: `"Acrobot-v1"` or `"Acrobot-v0"`. Until it is seeded it is at seed 0.
///
/// # Errors
///
/// [`Error::UnknownId`] for another name, with the known ones and the nearest.
///
/// ```
/// use acrobot::env::make;
///
/// let error = make("Acrobat-v1").unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     r#"there is no environment "Acrobat-v1"; did you mean "Acrobot-v1"? Known are Acrobot-v0 and Acrobot-v1"#
/// );
/// ```
pub fn make(id: &str) -> Result<Box<DynEnv>, Error> {
    make_with(id, Options::default())
}

/// [`make`] with options.
///
/// ```
/// use acrobot::env::{Env, Options, RenderMode, Rendering, make_with};
/// use acrobot::{Dynamics, Params};
///
/// let mut env = make_with(
///     "Acrobot-v1",
///     Options { render_mode: RenderMode::RgbArray, ..Options::default() },
/// )?;
/// env.reset(Some(42.into()), None);
/// assert!(matches!(env.render()?, Rendering::Frame(frame) if frame.width() == 500));
///
/// // env.unwrapped.book_or_nips = "nips"
/// let params = env.unwrapped().params();
/// env.unwrapped_mut().set_params(Params { dynamics: Dynamics::Nips, ..params })?;
/// # Ok::<(), acrobot::env::Error>(())
/// ```
///
/// # Errors
///
/// [`Error::UnknownId`] for another name, [`Error::Invalid`] for parameters that are refused.
pub fn make_with(id: &str, options: Options) -> Result<Box<DynEnv>, Error> {
    match options.arithmetic {
        ArithmeticKind::Host => make_in::<Host>(id, options),
        ArithmeticKind::Portable => make_in::<Portable>(id, options),
        ArithmeticKind::Fast => make_in::<Fast>(id, options),
        ArithmeticKind::Micro => make_in::<Micro>(id, options),
    }
}

fn make_in<A: Arithmetic>(id: &str, options: Options) -> Result<Box<DynEnv>, Error> {
    const KNOWN: [&str; 2] = ["Acrobot-v0", "Acrobot-v1"];
    match id {
        "Acrobot-v0" => Ok(Box::new(Erased(acrobot_v0::<A>(options)?))),
        "Acrobot-v1" => Ok(Box::new(Erased(acrobot_v1::<A>(options)?))),
        _ => {
            // Of two equally near the newer.
            let [v0, v1] = KNOWN;
            let distance = |known| strsim::levenshtein(id, known);
            let nearest = if distance(v0) < distance(v1) { v0 } else { v1 };
            Err(Error::UnknownId {
                id: id.to_owned(),
                nearest,
                known: &KNOWN,
            })
        }
    }
}

/// What an agent sees of either version: a slice of six or of four numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// Of `Acrobot-v0`.
    V0(Observation<4>),
    /// Of `Acrobot-v1`.
    V1(Observation<6>),
}

impl From<Observation<4>> for Reading {
    fn from(observation: Observation<4>) -> Self {
        Self::V0(observation)
    }
}

impl From<Observation<6>> for Reading {
    fn from(observation: Observation<6>) -> Self {
        Self::V1(observation)
    }
}

impl Deref for Reading {
    type Target = [f32];

    fn deref(&self) -> &[f32] {
        self.as_ref()
    }
}

impl AsRef<[f32]> for Reading {
    fn as_ref(&self) -> &[f32] {
        match self {
            Self::V0(observation) => observation.as_ref(),
            Self::V1(observation) => observation.as_ref(),
        }
    }
}

impl AsMut<[f32]> for Reading {
    fn as_mut(&mut self) -> &mut [f32] {
        match self {
            Self::V0(observation) => observation.as_mut(),
            Self::V1(observation) => observation.as_mut(),
        }
    }
}

/// An environment with its types erased to those of [`DynEnv`].
#[derive(Clone)]
struct Erased<E>(E);

impl<E, O> Env for Erased<E>
where
    E: Env<
            Observation = O,
            Action = Action,
            ObservationSpace = BoxSpace<O>,
            ActionSpace = Discrete<Action>,
            Unwrapped: LiveAcrobot + Sized + 'static,
        >,
    O: AsRef<[f32]> + AsMut<[f32]> + Clone + Into<Reading>,
{
    type Observation = Reading;
    type Action = Action;
    type ObservationSpace = BoxSpace<Reading>;
    type ActionSpace = Discrete<Action>;
    type Unwrapped = dyn LiveAcrobot;

    fn reset(
        &mut self,
        seed: Option<SeedSequence>,
        bounds: Option<StartBounds>,
    ) -> (Reading, Info) {
        let (observation, info) = self.0.reset(seed, bounds);
        (observation.into(), info)
    }

    fn step(&mut self, action: Action) -> EnvStep<Reading> {
        self.0.step(action).map(Into::into)
    }

    fn action_space(&self) -> Discrete<Action> {
        self.0.action_space()
    }

    fn observation_space(&self) -> BoxSpace<Reading> {
        self.0.observation_space().map(Into::into)
    }

    fn render(&mut self) -> Result<Rendering, Error> {
        self.0.render()
    }

    fn close(&mut self) {
        self.0.close();
    }

    fn unwrapped(&self) -> &(dyn LiveAcrobot + 'static) {
        self.0.unwrapped()
    }

    fn unwrapped_mut(&mut self) -> &mut (dyn LiveAcrobot + 'static) {
        self.0.unwrapped_mut()
    }
}

#[cfg(test)]
mod tests {
    use core::num::NonZeroU32;

    use super::*;
    use crate::env::check_env;

    #[test]
    fn erased_environments_keep_the_contract() {
        // Miri takes a thousand times as long.
        let limit = NonZeroU32::new(if cfg!(miri) { 30 } else { 500 }).unwrap();
        let v0 = AcrobotEnv::<Fast, Observation<4>>::default();
        let v1 = AcrobotEnv::<Portable, Observation<6>>::default();
        check_env(&Erased(TimeLimit::new(v0, limit)), 1).unwrap();
        check_env(&Erased(TimeLimit::new(v1, limit)), 1).unwrap();
    }
}
