//! Gymnasium's interface: [`make`], environments, spaces, wrappers and render modes.
//!
//! ```
//! use acrobot::Action;
//! use acrobot::env::{Env, make};
//! use acrobot::numpy::Pcg64;
//!
//! let mut env = make("Acrobot-v1")?;
//! let mut rng = Pcg64::new(42); // env.action_space.seed(42)
//! let observation = env.reset_with_seed(42);
//! assert_eq!(observation.len(), 6);
//! for _ in 0..1000 {
//!     if env.step(Action::sample(&mut rng)).done() {
//!         env.reset();
//!     }
//! }
//! # Ok::<(), acrobot::env::Error>(())
//! ```

mod any_acrobot;
mod error;
mod make;
mod rendering;
mod space;
mod wrapper;

use core::any::Any;
use std::boxed::Box;
use std::vec::Vec;

pub use error::Error;
pub use make::{make, make_with};
pub use rendering::{Display, RenderMode, Rendering};
pub use space::BoxSpace;

use crate::acrobot::{Acrobot, Step};
use crate::action::Action;
use crate::arithmetic::Arithmetic;
use crate::error::Error as Rejected;
use crate::physics::{Params, State};
use crate::render::Figure;
use crate::task::{ResetOptions, Task};
use any_acrobot::AnyAcrobot;

/// Gymnasium's `Env`: an [`AcrobotEnv`], or a wrapper around another environment.
///
/// A wrapper has the two methods for its inner environment, and those that it changes. The others
/// are the inner environment's.
///
/// ```
/// use acrobot::env::{Env, make};
/// use acrobot::{Action, Step};
///
/// /// Rewards whose sum is at least −1.
/// #[derive(Clone)]
/// struct Scaled<E>(E);
///
/// impl<E: Env> Env for Scaled<E> {
///     fn inner(&self) -> &dyn Env {
///         &self.0
///     }
///
///     fn inner_mut(&mut self) -> &mut dyn Env {
///         &mut self.0
///     }
///
///     fn step(&mut self, action: Action) -> Step<Vec<f32>> {
///         let step = self.0.step(action);
///         Step { reward: step.reward / 500.0, ..step }
///     }
/// }
///
/// let mut env = Scaled(make("Acrobot-v1")?);
/// env.reset_with_seed(42);
/// assert_eq!(env.step(Action::Zero).reward, -0.002);
/// # Ok::<(), acrobot::env::Error>(())
/// ```
pub trait Env: Send {
    /// The environment that this one wraps; an [`AcrobotEnv`] returns itself.
    fn inner(&self) -> &dyn Env;

    /// As [`inner`](Self::inner), to change it.
    fn inner_mut(&mut self) -> &mut dyn Env;

    /// Gymnasium's `reset(seed=…, options=…)`: begins an episode and returns the observation of its
    /// initial state. Without a seed the generator continues its stream, which has seed 0 at first.
    fn reset_with(&mut self, options: ResetOptions) -> Vec<f32> {
        self.inner_mut().reset_with(options)
    }

    /// Gymnasium's `reset()`.
    fn reset(&mut self) -> Vec<f32> {
        self.reset_with(ResetOptions::default())
    }

    /// Gymnasium's `reset(seed=seed)`.
    fn reset_with_seed(&mut self, seed: u64) -> Vec<f32> {
        self.reset_with(seed.into())
    }

    /// Takes one step.
    fn step(&mut self, action: Action) -> Step<Vec<f32>> {
        self.inner_mut().step(action)
    }

    /// The set of all observations.
    fn observation_space(&self) -> BoxSpace {
        self.inner().observation_space()
    }

    /// A picture of the state, in the [`RenderMode`] that the environment was made with.
    ///
    /// # Errors
    ///
    /// [`Error::NoRenderMode`] if it was made without one.
    fn render(&mut self) -> Result<Rendering, Error> {
        self.inner_mut().render()
    }

    /// Releases resources for rendering. Afterwards nothing is rendered.
    fn close(&mut self) {
        self.inner_mut().close();
    }

    /// The environment without its wrappers.
    fn unwrapped(&self) -> &AcrobotEnv {
        self.inner().unwrapped()
    }

    /// The environment without its wrappers, to change it.
    fn unwrapped_mut(&mut self) -> &mut AcrobotEnv {
        self.inner_mut().unwrapped_mut()
    }
}

/// An acrobot without wrappers, in any arithmetic and with any task.
///
/// ```
/// use acrobot::arithmetic::{Damped, Host};
/// use acrobot::env::{AcrobotEnv, Env, RenderMode};
/// use acrobot::task::{Swingup, Task};
/// use acrobot::{Acrobot, Action, Params, TimeLimit};
///
/// let env = AcrobotEnv::new(Acrobot::<Damped<Host>, Swingup>::new(42), RenderMode::Ansi);
/// let mut env = TimeLimit::new(env, Swingup::MAX_STEPS);
/// env.step(Action::Positive);
/// let acrobot = env.unwrapped_mut();
/// acrobot.set_params(Params { torque_noise: 0.1, ..acrobot.params() })?;
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Debug)]
pub struct AcrobotEnv {
    acrobot: Box<dyn AnyAcrobot>,
    render_mode: RenderMode,
}

impl AcrobotEnv {
    /// The environment of an acrobot, in its state.
    #[must_use]
    pub fn new<A: Arithmetic, T: Task>(acrobot: Acrobot<A, T>, render_mode: RenderMode) -> Self {
        Self { acrobot: Box::new(acrobot), render_mode }
    }

    /// The acrobot. `None` if it has another arithmetic or task.
    #[must_use]
    pub fn acrobot<A: Arithmetic, T: Task>(&self) -> Option<&Acrobot<A, T>> {
        let acrobot: &dyn Any = &*self.acrobot;
        acrobot.downcast_ref()
    }

    /// As [`acrobot`](Self::acrobot), to change it. Its steps and resets are not shown.
    #[must_use]
    pub fn acrobot_mut<A: Arithmetic, T: Task>(&mut self) -> Option<&mut Acrobot<A, T>> {
        let acrobot: &mut dyn Any = &mut *self.acrobot;
        acrobot.downcast_mut()
    }

    /// The state, rad and rad/s, converted to `f64` exactly.
    #[must_use]
    pub fn state(&self) -> State {
        self.acrobot.state()
    }

    /// Calls [`Acrobot::set_state`] with the state rounded to the scalar. Its errors are for the
    /// state as given and as rounded.
    pub fn set_state(&mut self, state: State) -> Result<(), Rejected> {
        self.acrobot.set_state(state)
    }

    /// The parameters, converted to `f64` exactly.
    #[must_use]
    pub fn params(&self) -> Params {
        self.acrobot.params()
    }

    /// As [`set_state`](Self::set_state), by [`Acrobot::set_params`].
    pub fn set_params(&mut self, params: Params) -> Result<(), Rejected> {
        self.acrobot.set_params(params)
    }

    /// The figure to draw.
    #[must_use]
    pub fn figure(&self) -> Figure {
        self.acrobot.figure()
    }
}

impl Clone for AcrobotEnv {
    fn clone(&self) -> Self {
        Self { acrobot: self.acrobot.boxed(), render_mode: self.render_mode.clone() }
    }
}

impl Env for AcrobotEnv {
    fn inner(&self) -> &dyn Env {
        self
    }

    fn inner_mut(&mut self) -> &mut dyn Env {
        self
    }

    fn reset_with(&mut self, options: ResetOptions) -> Vec<f32> {
        let observation = self.acrobot.reset_with(options);
        self.render_mode.show(&*self.acrobot);
        observation
    }

    fn step(&mut self, action: Action) -> Step<Vec<f32>> {
        let step = self.acrobot.step(action);
        self.render_mode.show(&*self.acrobot);
        step
    }

    /// The task's [bounds](Task::observation_high).
    fn observation_space(&self) -> BoxSpace {
        BoxSpace::symmetric(self.acrobot.observation_high())
    }

    fn render(&mut self) -> Result<Rendering, Error> {
        self.render_mode.render(&*self.acrobot)
    }

    fn close(&mut self) {
        self.render_mode = RenderMode::None;
    }

    fn unwrapped(&self) -> &AcrobotEnv {
        self
    }

    fn unwrapped_mut(&mut self) -> &mut AcrobotEnv {
        self
    }
}
