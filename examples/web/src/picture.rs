//! Draws the acrobot into a pixel buffer. It also draws states between two steps, because a display shows more frames than
//! the physics takes steps.

use core::convert::Infallible;

use acrobot::physics::wrap;
use acrobot::render::{Figure, Theme};
use acrobot::{Fast, State};
use embedded_graphics_core::pixelcolor::PixelColor;
use embedded_graphics_core::pixelcolor::raw::RawU32;
use embedded_graphics_core::prelude::{DrawTarget, OriginDimensions, Pixel, Size};
use embedded_graphics_core::primitives::Rectangle;

use crate::memory::Shared;
use crate::simulation;

/// The maximum width and height in pixels, because the memory is static.
const SIDE: usize = 1024;

/// A pixel in the format of an HTML canvas: red in the lowest byte, opacity in the highest.
#[derive(Clone, Copy, PartialEq)]
struct Rgba(u32);

impl PixelColor for Rgba {
    type Raw = RawU32;
}

static PIXELS: Shared<[Rgba; SIDE * SIDE]> = Shared::new([Rgba(0); SIDE * SIDE]);
static CANVAS: Shared<Canvas> = Shared::new(Canvas {
    size: Size::zero(),
    theme: Theme {
        background: Rgba(0),
        target: Rgba(0),
        link: Rgba(0),
        joint: Rgba(0),
        torque: Rgba(0),
    },
    shown: None,
});

struct Canvas {
    size: Size,
    theme: Theme<Rgba>,
    /// The figure that the pixels show. `None` if they must all be drawn.
    shown: Option<Figure>,
}

/// A drawing target: rows of pixels.
struct Frame<'a> {
    size: Size,
    pixels: &'a mut [Rgba],
}

impl OriginDimensions for Frame<'_> {
    fn size(&self) -> Size {
        self.size
    }
}

impl DrawTarget for Frame<'_> {
    type Color = Rgba;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgba>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        // A figure draws nothing outside its target.
        for Pixel(point, color) in pixels {
            let index = point.y as usize * self.size.width as usize + point.x as usize;
            if let Some(pixel) = self.pixels.get_mut(index) {
                *pixel = color;
            }
        }
        Ok(())
    }

    /// A figure calls this only to fill its whole target.
    fn fill_contiguous<I: IntoIterator<Item = Rgba>>(
        &mut self,
        _: &Rectangle,
        colors: I,
    ) -> Result<(), Infallible> {
        for (pixel, color) in self.pixels.iter_mut().zip(colors) {
            *pixel = color;
        }
        Ok(())
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn pixels() -> *mut u8 {
    PIXELS.address().cast()
}

/// Sets the picture's width and height, at most 1024 each. The next `draw` writes all pixels.
#[unsafe(no_mangle)]
pub extern "C" fn resize(width: u32, height: u32) {
    let mut canvas = CANVAS.borrow();
    canvas.size = Size::new(width, height).component_min(Size::new_equal(SIDE as u32));
    canvas.shown = None;
}

/// Sets the colours, with red in the lowest byte and opacity in the highest. The background is transparent. The next `draw`
/// writes all pixels.
#[unsafe(no_mangle)]
pub extern "C" fn paint(line: u32, link: u32, joint: u32, torque: u32) {
    let mut canvas = CANVAS.borrow();
    canvas.theme = Theme {
        background: Rgba(0),
        target: Rgba(line),
        link: Rgba(link),
        joint: Rgba(joint),
        torque: Rgba(torque),
    };
    canvas.shown = None;
}

/// Draws the acrobot at a part of its last step, from 0 (before) to 1 (after), with an arrow for the step's torque. Returns
/// the tip's position: \[x, y\] in m from the fixed joint, x to the right and y up.
#[unsafe(no_mangle)]
pub extern "C" fn draw(part: f32) -> *const [f32; 2] {
    static TIP: Shared<[f32; 2]> = Shared::new([0.0; 2]);
    simulation::with(|simulation| {
        let mut acrobot = simulation.env.inner().clone();
        let dt = acrobot.params().dt;
        let state = between(simulation.before, acrobot.state(), dt, part);
        // If the interpolation overflows, this draws the state after the step.
        let _ = acrobot.set_state(state);

        let mut canvas = CANVAS.borrow();
        let mut pixels = PIXELS.borrow();
        let len = (canvas.size.width * canvas.size.height) as usize;
        let mut frame = Frame {
            size: canvas.size,
            pixels: pixels.get_mut(..len).unwrap_or_default(),
        };
        let figure = Figure::new(&acrobot).with_torque(simulation.torque);
        let Ok(()) = match &canvas.shown {
            Some(shown) => figure.redraw(shown, &mut frame, &canvas.theme),
            None => figure.draw(&mut frame, &canvas.theme),
        };
        canvas.shown = Some(figure);
        [_, *TIP.borrow()] = acrobot.pendulum().positions();
    });
    TIP.address()
}

/// Interpolates the state at a `part` of the step from `a` to `b`: angles by the cubic Hermite polynomial, which has the
/// angles and velocities of both states, and velocities linearly.
fn between(a: State<f32>, b: State<f32>, dt: f32, part: f32) -> State<f32> {
    let [part2, part3] = [part * part, part * part * part];
    let angle = |theta: [f32; 2], dtheta: [f32; 2]| {
        let [start, end] = dtheta.map(|dtheta| dtheta * dt);
        // Angles are modulo 2π. Of the possible rotations take the one closest to that at the mean velocity.
        let mean = (start + end) * 0.5;
        let turned = mean + wrap::<Fast>(theta[1] - theta[0] - mean);
        theta[0]
            + turned * (3.0 * part2 - 2.0 * part3)
            + start * (part3 - 2.0 * part2 + part)
            + end * (part3 - part2)
    };
    let velocity = |a: f32, b: f32| a + (b - a) * part;
    State {
        theta1: angle([a.theta1, b.theta1], [a.dtheta1, b.dtheta1]),
        theta2: angle([a.theta2, b.theta2], [a.dtheta2, b.dtheta2]),
        dtheta1: velocity(a.dtheta1, b.dtheta1),
        dtheta2: velocity(a.dtheta2, b.dtheta2),
    }
}
