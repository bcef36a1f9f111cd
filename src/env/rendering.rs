//! Render modes.

use core::fmt;
use std::format;
use std::string::String;
use std::sync::Arc;

use super::any_acrobot::AnyAcrobot;
use super::error::Error;
use crate::render::{self, Frame};

/// A function that shows the frames of [`RenderMode::Human`], for example in a window.
///
/// ```
/// use acrobot::env::{AcrobotEnv, Display, Env, RenderMode};
/// use acrobot::{Acrobot, Fast};
///
/// let (sender, frames) = std::sync::mpsc::channel();
/// let display = Display::new(move |frame| sender.send(frame.clone()).unwrap_or(()));
/// let mut env = AcrobotEnv::new(Acrobot::<Fast>::new(0), RenderMode::Human(display));
/// env.reset_with_seed(42);
/// assert_eq!(frames.try_iter().count(), 1);
/// ```
#[derive(Clone)]
pub struct Display(Arc<dyn Fn(&Frame) + Send + Sync>);

impl Display {
    /// A display that passes each frame to `show`. Threads that share it may call `show` at the
    /// same time.
    pub fn new(show: impl Fn(&Frame) + Send + Sync + 'static) -> Self {
        Self(Arc::new(show))
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
    /// Shows the acrobot if the mode is `Human`.
    pub(super) fn show(&self, acrobot: &dyn AnyAcrobot) {
        if let Self::Human(Display(show)) = self {
            show(&Frame::of(&acrobot.figure()));
        }
    }

    pub(super) fn render(&self, acrobot: &dyn AnyAcrobot) -> Result<Rendering, Error> {
        let figure = acrobot.figure();
        match self {
            Self::None => Err(Error::NoRenderMode),
            Self::RgbArray => Ok(Rendering::Frame(Frame::of(&figure))),
            Self::Ansi => {
                let [theta1, theta2, dtheta1, dtheta2] = acrobot.state().into();
                let drawing = render::text(&figure);
                Ok(Rendering::Text(format!(
                    "{drawing}\nθ1 {theta1:+.2}  θ2 {theta2:+.2} rad  θ̇1 {dtheta1:+.2}  θ̇2 {dtheta2:+.2} rad/s\n"
                )))
            }
            Self::Human(Display(show)) => {
                show(&Frame::of(&figure));
                Ok(Rendering::Shown)
            }
        }
    }
}

/// The result of [`Env::render`](super::Env::render) in each [`RenderMode`].
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
