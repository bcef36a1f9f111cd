//! The environment that [`make`](super::make) wraps: an acrobot with a kind of observation and a
//! render mode.

use core::f32::consts::PI;
use core::fmt;
use core::marker::PhantomData;

use super::error::Error;
use super::rendering::{RenderMode, Rendering};
use super::space::{BoxSpace, DiscreteSpace};
use super::{Env, Info};
use crate::acrobot::{Acrobot, Step};
use crate::action::Action;
use crate::arithmetic::Arithmetic;
use crate::error::Error as Rejected;
use crate::physics::{Params, State, check_params};
use crate::render::Figure;
use crate::task::ResetBounds;
use crate::task::ResetOptions;

/// A kind of observation of an acrobot: those of `Acrobot-v1` and of `Acrobot-v0`, or one of yours.
pub trait ObservationKind:
    AsRef<[f32]> + AsMut<[f32]> + Clone + fmt::Debug + PartialEq + 'static
{
    /// The observation of an acrobot's state.
    fn of<A: Arithmetic>(acrobot: &Acrobot<A>) -> Self;

    /// The space of these observations. Its velocity bounds are those of `params`, but at least 0.1
    /// rad/s, for the initial states.
    fn space(params: &Params<f32>) -> BoxSpace<Self>;
}

impl ObservationKind for [f32; 6] {
    fn of<A: Arithmetic>(acrobot: &Acrobot<A>) -> Self {
        acrobot.observation()
    }

    fn space(params: &Params<f32>) -> BoxSpace<Self> {
        let [dtheta1, dtheta2] = highest_velocities(params);
        BoxSpace::symmetric([1.0, 1.0, 1.0, 1.0, dtheta1, dtheta2])
    }
}

impl ObservationKind for [f32; 4] {
    fn of<A: Arithmetic>(acrobot: &Acrobot<A>) -> Self {
        acrobot.state().cast().into()
    }

    fn space(params: &Params<f32>) -> BoxSpace<Self> {
        let [dtheta1, dtheta2] = highest_velocities(params);
        BoxSpace::symmetric([PI, PI, dtheta1, dtheta2])
    }
}

/// The largest velocities after a step or a reset with the default bounds, rad/s.
fn highest_velocities(params: &Params<f32>) -> [f32; 2] {
    let initial = ResetBounds::DEFAULT.high() as f32;
    [params.max_velocity1, params.max_velocity2].map(|limit| limit.max(initial))
}

/// Gymnasium's Acrobot without its wrappers, with observations `O` and in the arithmetic `A`.
#[derive(Clone, Debug)]
pub struct AcrobotEnv<A: Arithmetic, O> {
    acrobot: Acrobot<A>,
    render_mode: RenderMode,
    view: PhantomData<O>,
}

impl<A: Arithmetic, O: ObservationKind> AcrobotEnv<A, O> {
    /// An environment in the initial state of seed 0, with the errors of
    /// [`DynAcrobot::set_params`].
    pub fn new(params: Params, render_mode: RenderMode) -> Result<Self, Rejected> {
        let mut env = Self { render_mode, ..Self::default() };
        DynAcrobot::set_params(&mut env.acrobot, params)?;
        Ok(env)
    }
}

impl<A: Arithmetic, O> Default for AcrobotEnv<A, O> {
    /// Gymnasium's parameters, and no render mode.
    fn default() -> Self {
        Self { acrobot: Acrobot::new(0), render_mode: RenderMode::None, view: PhantomData }
    }
}

impl<A: Arithmetic, O: ObservationKind> Env for AcrobotEnv<A, O> {
    type Observation = O;
    type Action = Action;
    type ObservationSpace = BoxSpace<O>;
    type ActionSpace = DiscreteSpace<Action>;
    type Unwrapped = Acrobot<A>;

    fn reset_with(&mut self, options: ResetOptions) -> (O, Info) {
        self.acrobot.reset_with(options);
        self.render_mode.show(&self.acrobot);
        (O::of(&self.acrobot), Info::default())
    }

    fn step(&mut self, action: Action) -> Step<O, Info> {
        let step = self.acrobot.step(action);
        self.render_mode.show(&self.acrobot);
        Step {
            observation: O::of(&self.acrobot),
            reward: step.reward,
            terminated: step.terminated,
            truncated: step.truncated,
            info: Info::default(),
        }
    }

    fn action_space(&self) -> DiscreteSpace<Action> {
        DiscreteSpace::ACTIONS
    }

    fn observation_space(&self) -> BoxSpace<O> {
        O::space(&self.acrobot.params().cast())
    }

    fn render(&mut self) -> Result<Rendering, Error> {
        self.render_mode.render(&self.acrobot)
    }

    fn close(&mut self) {
        self.render_mode = RenderMode::None;
    }

    fn unwrapped(&self) -> &Acrobot<A> {
        &self.acrobot
    }

    fn unwrapped_mut(&mut self) -> &mut Acrobot<A> {
        &mut self.acrobot
    }
}

/// An acrobot in any arithmetic, to change it through a [`DynEnv`](super::DynEnv).
///
/// ```
/// use acrobot::Params;
/// use acrobot::env::{Env, Error, make};
///
/// let mut env = make("Acrobot-v1")?;
/// let acrobot = env.unwrapped_mut();
/// acrobot.set_params(Params { torque_noise: 0.1, ..acrobot.params() })?;
/// # Ok::<(), Error>(())
/// ```
pub trait DynAcrobot {
    /// The state, converted to `f64` exactly.
    fn state(&self) -> State;

    /// [`Acrobot::set_state`] with the state rounded to the scalar, and its errors, for the state
    /// as given and as rounded.
    fn set_state(&mut self, state: State) -> Result<(), Rejected>;

    /// The parameters, converted to `f64` exactly.
    fn params(&self) -> Params;

    /// As [`set_state`](Self::set_state), by [`Acrobot::set_params`].
    fn set_params(&mut self, params: Params) -> Result<(), Rejected>;

    /// The figure to draw.
    fn figure(&self) -> Figure;
}

impl<A: Arithmetic> DynAcrobot for Acrobot<A> {
    fn state(&self) -> State {
        Self::state(self).cast()
    }

    fn set_state(&mut self, state: State) -> Result<(), Rejected> {
        state.validate()?;
        let fields = state.fields().map(|(name, value, _)| (name, value));
        Self::set_state(self, state.cast()).map_err(|error| as_given(error, &fields))
    }

    fn params(&self) -> Params {
        Self::params(self).cast()
    }

    fn set_params(&mut self, params: Params) -> Result<(), Rejected> {
        check_params::<A>(&params)?;
        let fields = params.fields().map(|(name, value, ..)| (name, value));
        Self::set_params(self, params.cast()).map_err(|error| as_given(error, &fields))
    }

    fn figure(&self) -> Figure {
        Figure::new(self)
    }
}

/// The error of a number that is valid as `given`, and not after it was rounded to `f32`.
fn as_given(error: Rejected, given: &[(&'static str, f64)]) -> Rejected {
    let Rejected::OutOfRange { name, value: rounded, unit, .. } = error else {
        return error;
    };
    match given.iter().find(|(other, _)| *other == name) {
        Some(&(_, value)) if value != rounded => {
            Rejected::OutOfRange { name, value, unit, rule: "within its range as f32, in" }
        }
        _ => error,
    }
}
