//! Gymnasium's interface: [`make`], environments, spaces, wrappers and render modes.
//!
//! ```
//! use acrobot::env::{Env, Space, make};
//! use acrobot::numpy::Pcg64;
//!
//! let mut env = make("Acrobot-v1")?;
//! let mut rng = Pcg64::new(42); // env.action_space.seed(42)
//! let (observation, _) = env.reset_with_seed(42);
//! assert_eq!(observation.as_slice().len(), 6);
//! for _ in 0..1000 {
//!     let step = env.step(env.action_space().sample(&mut rng));
//!     if step.done() {
//!         env.reset();
//!     }
//! }
//! # Ok::<(), acrobot::env::Error>(())
//! ```

mod acrobot_env;
mod check;
mod error;
mod make;
mod rendering;
mod space;
mod statistics;
mod wrapper;

use std::time::Duration;

pub use acrobot_env::{AcrobotEnv, DynAcrobot, ObservationKind};
pub use check::{Violation, check_env};
pub use error::Error;
pub use make::{
    ArithmeticKind, DynEnv, DynObservation, Options, acrobot_v0, acrobot_v1, make, make_with,
};
pub use rendering::{Display, RenderMode, Rendering};
pub use space::{BoxSpace, DiscreteSpace, Space};
pub use statistics::RecordEpisodeStatistics;

use crate::acrobot::Step;
use crate::task::ResetOptions;

/// An environment: Gymnasium's `Env`, with its types known at compile time. [`check_env`] checks an
/// implementation.
///
/// ```
/// use acrobot::env::{Env, Space};
/// use acrobot::numpy::Pcg64;
///
/// /// The steps of an episode with a random policy, in any environment.
/// fn length(mut env: impl Env) -> u32 {
///     let mut rng = Pcg64::new(42);
///     env.reset_with_seed(42);
///     let mut steps = 1;
///     while !env.step(env.action_space().sample(&mut rng)).done() {
///         steps += 1;
///     }
///     steps
/// }
/// ```
pub trait Env {
    /// The type of an observation.
    type Observation;
    /// The type of an action.
    type Action;
    /// The type of the set of all observations.
    type ObservationSpace: Space<Element = Self::Observation>;
    /// The type of the set of all actions.
    type ActionSpace: Space<Element = Self::Action>;
    /// The type of the environment without its wrappers: Gymnasium's `unwrapped`.
    type Unwrapped: ?Sized;

    /// Gymnasium's `reset(seed=…, options=…)`: begins an episode and returns the observation of its
    /// initial state. Without a seed the generator continues its stream, which has seed 0 at first.
    fn reset_with(&mut self, options: ResetOptions) -> (Self::Observation, Info);

    /// Gymnasium's `reset()`.
    fn reset(&mut self) -> (Self::Observation, Info) {
        self.reset_with(ResetOptions::default())
    }

    /// Gymnasium's `reset(seed=seed)`.
    fn reset_with_seed(&mut self, seed: u64) -> (Self::Observation, Info) {
        self.reset_with(seed.into())
    }

    /// Takes one step.
    fn step(&mut self, action: Self::Action) -> Step<Self::Observation, Info>;

    /// The set of all actions.
    fn action_space(&self) -> Self::ActionSpace;

    /// The set of all observations.
    fn observation_space(&self) -> Self::ObservationSpace;

    /// A picture of the state, in the [`RenderMode`] that the environment was made with.
    ///
    /// # Errors
    ///
    /// [`Error::NoRenderMode`] if it was made without one, and [`Error::DisplayBusy`] if a
    /// [`Display`] renders on itself.
    fn render(&mut self) -> Result<Rendering, Error> {
        Err(Error::NoRenderMode)
    }

    /// Releases resources for rendering. Afterwards nothing is rendered.
    fn close(&mut self) {}

    /// The environment without its wrappers.
    fn unwrapped(&self) -> &Self::Unwrapped;

    /// The environment without its wrappers, to change it.
    fn unwrapped_mut(&mut self) -> &mut Self::Unwrapped;
}

/// Further information from a reset or a step: Gymnasium's `info`. Acrobot itself adds none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Info {
    /// Statistics of the episode that this step ended, if [`RecordEpisodeStatistics`] records them.
    pub episode: Option<EpisodeStatistics>,
}

/// Statistics of one episode.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EpisodeStatistics {
    /// The sum of its rewards.
    pub episode_return: f32,
    /// The number of its steps.
    pub length: u32,
    /// The time from its reset to its end.
    pub elapsed: Duration,
}
