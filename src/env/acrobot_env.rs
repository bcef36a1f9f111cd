//! The environment that [`make`](super::make) wraps: an acrobot, how it is seen and how it is shown.

use core::fmt;
use core::marker::PhantomData;
use std::sync::{Arc, Mutex, PoisonError};

use super::{BoxSpace, Discrete, Env, EnvStep, Error, Frame, Info, Rendering, frame};
use crate::acrobot::Acrobot;
use crate::arithmetic::Arithmetic;
use crate::error::Error as Refusal;
use crate::params::Params;
use crate::render::Figure;
use crate::seed::SeedSequence;
use crate::state::{StartBounds, State};
use crate::{Action, Observation};

/// An observation that an acrobot can be seen as.
///
/// ```
/// use acrobot::env::View;
/// use acrobot::{Acrobot, Observation, Portable};
///
/// fn length<O: View>(acrobot: &Acrobot<Portable>) -> usize {
///     O::of(acrobot).as_ref().len()
/// }
///
/// let acrobot = Acrobot::new(42);
/// assert_eq!(length::<Observation>(&acrobot), 6);
/// assert_eq!(length::<Observation<4>>(&acrobot), 4);
/// ```
pub trait View: AsRef<[f32]> + AsMut<[f32]> + Clone + fmt::Debug + PartialEq + 'static {
    /// What the agent sees.
    fn of<A: Arithmetic>(acrobot: &Acrobot<A>) -> Self;

    /// The space that it is from; its velocity bounds are those of the parameters.
    fn space(params: &Params<f32>) -> BoxSpace<Self>;
}

/// That of `Acrobot-v1`.
impl View for Observation<6> {
    fn of<A: Arithmetic>(acrobot: &Acrobot<A>) -> Self {
        acrobot.observation()
    }

    fn space(params: &Params<f32>) -> BoxSpace<Self> {
        let mut high = Self::HIGH;
        [high.0[4], high.0[5]] = [params.max_velocity1, params.max_velocity2];
        BoxSpace::symmetric(high)
    }
}

/// That of `Acrobot-v0`.
impl View for Observation<4> {
    fn of<A: Arithmetic>(acrobot: &Acrobot<A>) -> Self {
        acrobot.state().into()
    }

    fn space(params: &Params<f32>) -> BoxSpace<Self> {
        let mut high = Self::V0_HIGH;
        [high.0[2], high.0[3]] = [params.max_velocity1, params.max_velocity2];
        BoxSpace::symmetric(high)
    }
}

/// Who shows the frames of mode [`RenderMode::Human`]: a window, a web socket, a test.
///
/// ```
/// use acrobot::Fast;
/// use acrobot::env::{Display, Env, Options, RenderMode, acrobot_v1};
///
/// let (sender, frames) = std::sync::mpsc::channel();
/// let display = Display::new(move |frame| sender.send(frame.clone()).unwrap_or(()));
/// let options = Options { render_mode: RenderMode::Human(display), ..Options::default() };
/// let mut env = acrobot_v1::<Fast>(options)?;
/// env.reset(Some(42.into()), None);
/// assert_eq!(frames.try_iter().count(), 1);
/// # Ok::<(), acrobot::env::Error>(())
/// ```
#[derive(Clone)]
pub struct Display(Arc<Mutex<Show>>);

type Show = dyn FnMut(&Frame) + Send;

impl Display {
    /// A display that hands each frame to `show`; clones share it.
    pub fn new(show: impl FnMut(&Frame) + Send + 'static) -> Self {
        Self(Arc::new(Mutex::new(show)))
    }

    fn show(&self, frame: &Frame) {
        // One that panicked in another thread can still show this frame.
        let mut show = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        show(frame);
    }
}

impl fmt::Debug for Display {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Display")
    }
}

/// What [`Env::render`] returns, chosen when the environment is made.
#[derive(Clone, Debug, Default)]
pub enum RenderMode {
    /// Nothing: `render` is refused.
    #[default]
    None,
    /// A [`Frame`] of 500 × 500 RGB pixels.
    RgbArray,
    /// A drawing in braille characters, 40 × 20, and a line of numbers.
    Ansi,
    /// Each reset and each step shows a frame on the display.
    Human(Display),
}

/// An acrobot as an environment of Gymnasium's: seen as `O`, computed in `A`, rendered by mode.
#[derive(Clone, Debug)]
pub struct AcrobotEnv<A: Arithmetic, O> {
    acrobot: Acrobot<A>,
    render_mode: RenderMode,
    view: PhantomData<O>,
}

impl<A: Arithmetic, O: View> AcrobotEnv<A, O> {
    /// One at the start of seed 0.
    ///
    /// # Errors
    ///
    /// The first parameter that is refused, also where it is so only as rounded to `A`'s scalar.
    pub fn new(params: Params, render_mode: RenderMode) -> Result<Self, Refusal> {
        let mut env = Self {
            render_mode,
            ..Self::default()
        };
        LiveAcrobot::set_params(&mut env.acrobot, params)?;
        Ok(env)
    }

    /// In mode human every reset and every step is shown, as in Gymnasium.
    fn show(&self) {
        if let RenderMode::Human(display) = &self.render_mode {
            display.show(&Frame::of(&Figure::new(&self.acrobot)));
        }
    }
}

impl<A: Arithmetic, O> Default for AcrobotEnv<A, O> {
    /// Gymnasium's parameters, and nothing to render.
    fn default() -> Self {
        Self {
            acrobot: Acrobot::new(0),
            render_mode: RenderMode::None,
            view: PhantomData,
        }
    }
}

impl<A: Arithmetic, O: View> Env for AcrobotEnv<A, O> {
    type Observation = O;
    type Action = Action;
    type ObservationSpace = BoxSpace<O>;
    type ActionSpace = Discrete<Action>;
    type Unwrapped = Acrobot<A>;

    fn reset(&mut self, seed: Option<SeedSequence>, bounds: Option<StartBounds>) -> (O, Info) {
        let (_, info) = Env::reset(&mut self.acrobot, seed, bounds);
        self.show();
        (O::of(&self.acrobot), info)
    }

    fn step(&mut self, action: Action) -> EnvStep<O> {
        let step = Env::step(&mut self.acrobot, action);
        self.show();
        step.map(|_| O::of(&self.acrobot))
    }

    fn action_space(&self) -> Discrete<Action> {
        self.acrobot.action_space()
    }

    fn observation_space(&self) -> BoxSpace<O> {
        O::space(&self.acrobot.params().cast())
    }

    fn render(&mut self) -> Result<Rendering, Error> {
        match &self.render_mode {
            RenderMode::None => Err(Error::NoRenderMode),
            RenderMode::RgbArray => Ok(Rendering::Frame(Frame::of(&Figure::new(&self.acrobot)))),
            RenderMode::Ansi => {
                let State {
                    theta1,
                    theta2,
                    dtheta1,
                    dtheta2,
                } = self.acrobot.state().cast::<f64>();
                let drawing = frame::text(&Figure::new(&self.acrobot));
                Ok(Rendering::Text(std::format!(
                    "{drawing}\nθ1 {theta1:+.2}  θ2 {theta2:+.2} rad  θ̇1 {dtheta1:+.2}  θ̇2 {dtheta2:+.2} rad/s\n"
                )))
            }
            RenderMode::Human(_) => {
                self.show();
                Ok(Rendering::Shown)
            }
        }
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

/// An acrobot of any arithmetic, for live changes through [`DynEnv`](super::DynEnv).
///
/// ```
/// use acrobot::env::{Env, Error, LiveAcrobot, make};
/// use acrobot::{Params, State};
///
/// fn hang_still(acrobot: &mut dyn LiveAcrobot) -> Result<(), Error> {
///     acrobot.set_params(Params { torque_noise: 0.0, ..acrobot.params() })?;
///     Ok(acrobot.set_state(State::default())?)
/// }
///
/// let mut env = make("Acrobot-v1")?;
/// hang_still(env.unwrapped_mut())?;
/// assert_eq!(env.unwrapped().state(), State::default());
/// # Ok::<(), Error>(())
/// ```
pub trait LiveAcrobot {
    /// The state, exactly.
    fn state(&self) -> State;

    /// [`Acrobot::set_state`], rounded to the arithmetic's scalar.
    ///
    /// # Errors
    ///
    /// As there.
    fn set_state(&mut self, state: State) -> Result<(), Refusal>;

    /// The parameters, exactly.
    fn params(&self) -> Params;

    /// [`Acrobot::set_params`], rounded to the arithmetic's scalar.
    ///
    /// # Errors
    ///
    /// As there, for a parameter that is refused as it is or as rounded.
    fn set_params(&mut self, params: Params) -> Result<(), Refusal>;

    /// The figure to draw.
    fn figure(&self) -> Figure;
}

impl<A: Arithmetic> LiveAcrobot for Acrobot<A> {
    fn state(&self) -> State {
        Self::state(self).cast()
    }

    fn set_state(&mut self, state: State) -> Result<(), Refusal> {
        Self::set_state(self, state.cast())
    }

    fn params(&self) -> Params {
        Self::params(self).cast()
    }

    fn set_params(&mut self, params: Params) -> Result<(), Refusal> {
        params.validate()?;
        Self::set_params(self, params.cast())
    }

    fn figure(&self) -> Figure {
        Figure::new(self)
    }
}
