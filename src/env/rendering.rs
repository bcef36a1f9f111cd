//! Render modes.

use core::fmt;
use std::format;
use std::string::String;
use std::sync::{Arc, Mutex, PoisonError};

use super::Error;
use crate::acrobot::Acrobot;
use crate::arithmetic::Arithmetic;
use crate::physics::State;
use crate::render::{self, Figure, Frame};

/// Shows the frames of [`RenderMode::Human`]: a window, a web socket, a test.
///
/// ```
/// use acrobot::Fast;
/// use acrobot::env::{Display, Env, Options, RenderMode, acrobot_v1};
///
/// let (sender, frames) = std::sync::mpsc::channel();
/// let display = Display::new(move |frame| sender.send(frame.clone()).unwrap_or(()));
/// let options = Options { render_mode: RenderMode::Human(display), ..Options::default() };
/// let mut env = acrobot_v1::<Fast>(options)?;
/// env.reset_with_seed(42);
/// assert_eq!(frames.try_iter().count(), 1);
/// # Ok::<(), acrobot::env::Error>(())
/// ```
#[derive(Clone)]
pub struct Display(Arc<Mutex<Show>>);

type Show = dyn FnMut(&Frame) + Send;

impl Display {
    /// A display that passes each frame to `show`. Clones share it.
    pub fn new(show: impl FnMut(&Frame) + Send + 'static) -> Self {
        Self(Arc::new(Mutex::new(show)))
    }

    fn show(&self, frame: &Frame) {
        // A display that panicked in another thread can still show this frame.
        let mut show = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        show(frame);
    }
}

impl fmt::Debug for Display {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Display")
    }
}

/// What [`Env::render`](super::Env::render) returns, chosen when the environment is made.
#[non_exhaustive]
#[derive(Clone, Debug, Default)]
pub enum RenderMode {
    /// Nothing: `render` returns an error.
    #[default]
    None,
    /// A [`Frame`] of 500 × 500 RGB pixels.
    RgbArray,
    /// A drawing of 40 × 20 braille characters and a line of numbers.
    Ansi,
    /// Each reset and each step shows a frame on the display.
    Human(Display),
}

impl RenderMode {
    /// Shows the acrobot if the mode is `Human`, as Gymnasium does in each reset and each step.
    pub(super) fn show<A: Arithmetic>(&self, acrobot: &Acrobot<A>) {
        if let Self::Human(display) = self {
            display.show(&Frame::of(&Figure::new(acrobot)));
        }
    }

    pub(super) fn render<A: Arithmetic>(&self, acrobot: &Acrobot<A>) -> Result<Rendering, Error> {
        match self {
            Self::None => Err(Error::NoRenderMode),
            Self::RgbArray => Ok(Rendering::Frame(Frame::of(&Figure::new(acrobot)))),
            Self::Ansi => {
                let State {
                    theta1,
                    theta2,
                    dtheta1,
                    dtheta2,
                } = acrobot.state().cast::<f64>();
                let drawing = render::text(&Figure::new(acrobot));
                Ok(Rendering::Text(format!(
                    "{drawing}\nθ1 {theta1:+.2}  θ2 {theta2:+.2} rad  θ̇1 {dtheta1:+.2}  θ̇2 {dtheta2:+.2} rad/s\n"
                )))
            }
            Self::Human(_) => {
                self.show(acrobot);
                Ok(Rendering::Shown)
            }
        }
    }
}

/// What [`Env::render`](super::Env::render) returns, by [`RenderMode`].
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum Rendering {
    /// The frame of mode `RgbArray`.
    Frame(Frame),
    /// The text of mode `Ansi`.
    Text(String),
    /// Mode `Human`: the frame has been shown.
    Shown,
}
