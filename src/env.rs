//! Environments for a host, as Gymnasium's users know them: spaces, [`make`], wrappers and pictures.
//!
//! ```
//! use acrobot::env::{Env, Space, make};
//! use acrobot::Pcg64;
//!
//! let mut env = make("Acrobot-v1")?;
//! let mut rng = Pcg64::new(42); // env.action_space.seed(42)
//! let (observation, _) = env.reset(Some(42.into()), None);
//! assert_eq!(observation.len(), 6);
//! for _ in 0..1000 {
//!     let step = env.step(env.action_space().sample(&mut rng));
//!     if step.ended() {
//!         env.reset(None, None);
//!     }
//! }
//! # Ok::<(), acrobot::env::Error>(())
//! ```

/// The parts of [`Env`] that a wrapper hands on: its types, its episodes, and all the rest.
macro_rules! forward {
    (types $inner:ident) => {
        type Observation = $inner::Observation;
        type Action = $inner::Action;
        type ObservationSpace = $inner::ObservationSpace;
        type ActionSpace = $inner::ActionSpace;
        type Unwrapped = $inner::Unwrapped;
    };
    (episode $self:ident, $inner:expr) => {
        fn reset(
            &mut $self,
            seed: Option<SeedSequence>,
            bounds: Option<StartBounds>,
        ) -> (Self::Observation, Info) {
            $inner.reset(seed, bounds)
        }

        fn step(&mut $self, action: Self::Action) -> EnvStep<Self::Observation> {
            $inner.step(action)
        }
    };
    ($self:ident, $inner:expr) => {
        fn action_space(&$self) -> Self::ActionSpace {
            $inner.action_space()
        }

        fn observation_space(&$self) -> Self::ObservationSpace {
            $inner.observation_space()
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

mod acrobot_env;
mod check;
mod error;
mod frame;
mod make;
mod space;
mod statistics;

use std::boxed::Box;
use std::string::String;

pub use acrobot_env::{AcrobotEnv, Display, LiveAcrobot, RenderMode, View};
pub use check::{Violation, check_env};
pub use error::Error;
pub use frame::Frame;
pub use make::{ArithmeticKind, DynEnv, Options, Reading, acrobot_v0, acrobot_v1, make, make_with};
pub use space::{BoxSpace, Discrete, Space};
pub use statistics::{EpisodeStatistics, RecordEpisodeStatistics};

use crate::acrobot::Acrobot;
use crate::arithmetic::Arithmetic;
use crate::seed::SeedSequence;
use crate::state::StartBounds;
use crate::time_limit::TimeLimit;
use crate::{Action, Observation};

/// An environment: Gymnasium's `Env`, with its types known at compile time.
///
/// It is object-safe where the types are named; [`DynEnv`] is the one that [`make`] returns.
/// [`check_env`] checks an implementation.
///
/// ```
/// use acrobot::env::{Env, Space, acrobot_v0, acrobot_v1};
/// use acrobot::{Fast, Pcg64};
///
/// /// Steps of an episode by a random policy, whatever the environment.
/// fn length(mut env: impl Env) -> u32 {
///     let mut rng = Pcg64::new(42);
///     env.reset(Some(42.into()), None);
///     let mut steps = 1;
///     while !env.step(env.action_space().sample(&mut rng)).ended() {
///         steps += 1;
///     }
///     steps
/// }
///
/// assert!(length(acrobot_v0::<Fast>(Default::default())?) <= 200);
/// assert!(length(acrobot_v1::<Fast>(Default::default())?) <= 500);
/// # Ok::<(), acrobot::env::Error>(())
/// ```
pub trait Env {
    /// What the agent sees.
    type Observation;
    /// What the agent does.
    type Action;
    /// The set of all observations.
    type ObservationSpace: Space<Element = Self::Observation>;
    /// The set of all actions.
    type ActionSpace: Space<Element = Self::Action>;
    /// What is left when all wrappers are taken off, for live changes: Gymnasium's `unwrapped`.
    type Unwrapped: ?Sized;

    /// Starts an episode and returns what the agent sees of its start.
    ///
    /// A `seed` seeds the generator anew; without one the next start of the same stream is drawn.
    /// One that was never seeded is at seed 0: where Gymnasium asks the system for entropy, nothing
    /// here differs from run to run.
    /// The start is drawn from `bounds`, or from the environment's own where there are none.
    fn reset(
        &mut self,
        seed: Option<SeedSequence>,
        bounds: Option<StartBounds>,
    ) -> (Self::Observation, Info);

    /// Takes one step.
    fn step(&mut self, action: Self::Action) -> EnvStep<Self::Observation>;

    /// The set of all actions.
    fn action_space(&self) -> Self::ActionSpace;

    /// The set of all observations.
    fn observation_space(&self) -> Self::ObservationSpace;

    /// A picture of the state, of the kind that the environment was made for.
    ///
    /// # Errors
    ///
    /// [`Error::NoRenderMode`] from one that was made for none.
    fn render(&mut self) -> Result<Rendering, Error> {
        Err(Error::NoRenderMode)
    }

    /// Lets go of what is held for rendering, such as a display; nothing is rendered afterwards.
    fn close(&mut self) {}

    /// What all wrappers wrap.
    fn unwrapped(&self) -> &Self::Unwrapped;

    /// What all wrappers wrap, for live changes.
    fn unwrapped_mut(&mut self) -> &mut Self::Unwrapped;
}

/// What a step of an [`Env`] returns.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvStep<O> {
    /// What the agent sees of the new state.
    pub observation: O,
    /// The reward of the step.
    pub reward: f32,
    /// Whether the new state ends the episode.
    pub terminated: bool,
    /// Whether the episode was cut off.
    pub truncated: bool,
    /// What else there is to know.
    pub info: Info,
}

impl<O> EnvStep<O> {
    /// Whether the episode is over, for either reason. To be called before the observation is moved
    /// out.
    #[must_use]
    pub fn ended(&self) -> bool {
        self.terminated || self.truncated
    }

    /// The same step with another observation.
    pub(crate) fn map<P>(self, observe: impl FnOnce(O) -> P) -> EnvStep<P> {
        EnvStep {
            observation: observe(self.observation),
            reward: self.reward,
            terminated: self.terminated,
            truncated: self.truncated,
            info: self.info,
        }
    }
}

/// What a reset or a step tells beside the rest; Acrobot itself has nothing to tell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Info {
    /// Of the episode that this step ended, where [`RecordEpisodeStatistics`] records it.
    pub episode: Option<EpisodeStatistics>,
}

/// What [`Env::render`] returns, by [`RenderMode`].
#[derive(Clone, Debug, PartialEq)]
pub enum Rendering {
    /// Of mode `RgbArray`.
    Frame(Frame),
    /// Of mode `Ansi`.
    Text(String),
    /// Of mode `Human`: the frame has been shown.
    Shown,
}

/// Gymnasium's `Acrobot-v1` without its wrappers, and with nothing to render. Its own methods of the
/// same names come first: this one is `Env::reset(&mut acrobot, seed, bounds)`.
impl<A: Arithmetic> Env for Acrobot<A> {
    type Observation = Observation;
    type Action = Action;
    type ObservationSpace = BoxSpace<Observation>;
    type ActionSpace = Discrete<Action>;
    type Unwrapped = Self;

    fn reset(
        &mut self,
        seed: Option<SeedSequence>,
        bounds: Option<StartBounds>,
    ) -> (Observation, Info) {
        if let Some(seed) = seed {
            self.reseed(seed);
        }
        (
            self.reset_within(bounds.unwrap_or_default()),
            Info::default(),
        )
    }

    fn step(&mut self, action: Action) -> EnvStep<Observation> {
        let step = Self::step(self, action);
        EnvStep {
            observation: step.observation,
            reward: step.reward,
            terminated: step.terminated,
            truncated: false,
            info: Info::default(),
        }
    }

    fn action_space(&self) -> Discrete<Action> {
        Discrete::ACTIONS
    }

    fn observation_space(&self) -> BoxSpace<Observation> {
        <Observation as View>::space(&self.params().cast())
    }

    fn unwrapped(&self) -> &Self {
        self
    }

    fn unwrapped_mut(&mut self) -> &mut Self {
        self
    }
}

/// Truncates whatever it wraps, and reports it beside what that reports. Around a bare `Acrobot` its
/// own methods of the same names come first.
impl<E: Env> Env for TimeLimit<E> {
    forward!(types E);

    fn reset(
        &mut self,
        seed: Option<SeedSequence>,
        bounds: Option<StartBounds>,
    ) -> (E::Observation, Info) {
        self.restart();
        self.inner.reset(seed, bounds)
    }

    fn step(&mut self, action: E::Action) -> EnvStep<E::Observation> {
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

/// A boxed environment, so that what [`make`] returns can be wrapped and handed to generic code.
impl<E: Env + ?Sized> Env for Box<E> {
    forward!(types E);
    forward!(episode self, (**self));
    forward!(self, (**self));
}
