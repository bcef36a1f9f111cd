//! Drawing on any [embedded-graphics] target, from a 128×64 OLED to a window.
//!
//! A [`Figure`] is scaled to the target. [`Figure::draw`] writes each pixel once, and
//! [`Figure::redraw`] only the pixels that changed.
//!
//! ```
//! use acrobot::render::{Figure, Theme};
//! use acrobot::{Acrobot, Action, Fast};
//! use embedded_graphics::mock_display::MockDisplay;
//!
//! let mut acrobot = Acrobot::<Fast>::new(42);
//! let mut display = MockDisplay::new();
//! # display.set_allow_overdraw(true);
//!
//! let mut shown = Figure::new(&acrobot);
//! shown.draw(&mut display, &Theme::MONOCHROME)?;
//! acrobot.step(Action::Positive);
//! let next = Figure::new(&acrobot).with_torque(1.0);
//! next.redraw(&shown, &mut display, &Theme::MONOCHROME)?; // only the pixels that changed
//! # Ok::<(), core::convert::Infallible>(())
//! ```
//!
//! [embedded-graphics]: https://docs.rs/embedded-graphics

#[cfg(feature = "std")]
mod frame;
mod scene;

use embedded_graphics_core::pixelcolor::{BinaryColor, Rgb888};

#[cfg(feature = "std")]
pub use frame::Frame;

use crate::acrobot::Acrobot;
use crate::arithmetic::{Arithmetic, Real};
use crate::physics::{Pendulum, directions};
use crate::task::Task;

/// The colours of a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Theme<C> {
    /// The background.
    pub background: C,
    /// The line at the target height.
    pub target: C,
    /// Both links.
    pub link: C,
    /// Both joints.
    pub joint: C,
    /// The arrow that shows the torque.
    pub torque: C,
}

impl Theme<Rgb888> {
    /// Gymnasium's colours: cyan links, olive joints and a black line on white. The arrow, which
    /// Gymnasium does not have, is red.
    pub const GYMNASIUM: Self = Self {
        background: Rgb888::new(255, 255, 255),
        target: Rgb888::new(0, 0, 0),
        link: Rgb888::new(0, 204, 204),
        joint: Rgb888::new(204, 204, 0),
        torque: Rgb888::new(204, 0, 0),
    };
}

impl Theme<BinaryColor> {
    /// Lit links on a dark background, with dark joints.
    pub const MONOCHROME: Self = Self {
        background: BinaryColor::Off,
        target: BinaryColor::On,
        link: BinaryColor::On,
        joint: BinaryColor::Off,
        torque: BinaryColor::On,
    };
}

impl<C> Theme<C> {
    /// The same theme in another colour type, such as a display's `Rgb565`.
    #[must_use]
    pub fn map<D>(self, mut color: impl FnMut(C) -> D) -> Theme<D> {
        Theme {
            background: color(self.background),
            target: color(self.target),
            link: color(self.link),
            joint: color(self.joint),
            torque: color(self.torque),
        }
    }
}

/// A drawing of an acrobot: [an example](self).
///
/// It is scaled as in Gymnasium's window: the shorter side of the target shows both links and 0.2 m
/// more in each direction. A target that reaches beyond `i32::MAX` stays as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Figure {
    /// Sine and cosine of each link's angle from hanging down.
    directions: [(f32, f32); 2],
    /// The length of each link, in units of half the target's shorter side.
    lengths: [f32; 2],
    /// One metre in the same unit.
    metre: f32,
    /// The sign of the torque: −1, 0 or 1.
    torque: i8,
}

impl Figure {
    /// The figure of an acrobot, without a torque.
    #[must_use]
    pub fn new<A: Arithmetic, T: Task, R>(acrobot: &Acrobot<A, T, R>) -> Self {
        Self::of(acrobot.pendulum())
    }

    /// The figure of a pendulum, without a torque.
    #[must_use]
    pub fn of<A: Arithmetic>(pendulum: &Pendulum<A>) -> Self {
        let narrow = |x: A::Scalar| x.to_f64() as f32;
        let sin_cos = pendulum.sin_cos();
        let params = pendulum.params();
        let reach = params.length1 + params.length2 + A::Scalar::from_f64(0.2);
        let part = |x| narrow(x / reach);
        Self {
            directions: directions(sin_cos.map(|(sin, cos)| (narrow(sin), narrow(cos)))),
            lengths: [part(params.length1), part(params.length2)],
            metre: part(A::Scalar::from_f64(1.0)),
            torque: 0,
        }
    }

    /// Adds an arrow around the middle joint in the direction of `torque`, if `torque` is not 0 and
    /// the target has at least 48 pixels in each direction.
    #[must_use]
    pub fn with_torque(mut self, torque: f32) -> Self {
        self.torque = i8::from(torque > 0.0) - i8::from(torque < 0.0);
        self
    }
}
