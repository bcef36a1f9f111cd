//! The acrobot in pixels, by the crate's own drawing, between two steps where the display is faster than the physics.

use core::convert::Infallible;
use core::f32::consts::FRAC_PI_2;

use acrobot::{Fast, Figure, State, Theme, wrap};
use embedded_graphics_core::pixelcolor::PixelColor;
use embedded_graphics_core::pixelcolor::raw::RawU32;
use embedded_graphics_core::prelude::{DrawTarget, OriginDimensions, Pixel, Size};
use embedded_graphics_core::primitives::Rectangle;

use crate::memory::Shared;
use crate::simulation;

/// Pixels in each direction that there is memory for.
const SIDE: usize = 1024;

/// A pixel as a canvas has it: red in the lowest byte, opacity in the highest.
#[derive(Clone, Copy, PartialEq)]
struct Rgba(u32);

impl PixelColor for Rgba {
    type Raw = RawU32;
}

static PIXELS: Shared<[Rgba; SIDE * SIDE]> = Shared::new([Rgba(0); SIDE * SIDE]);
static CANVAS: Shared<Canvas> = Shared::new(Canvas {
    size: Size::zero(),
    theme: Theme {
        ground: Rgba(0),
        line: Rgba(0),
        link: Rgba(0),
        joint: Rgba(0),
        torque: Rgba(0),
    },
    shown: None,
});

struct Canvas {
    size: Size,
    theme: Theme<Rgba>,
    /// What the pixels show; none where they show nothing yet.
    shown: Option<Figure>,
}

/// The pixels of one row after the other.
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
        // A figure draws nothing outside of its target.
        for Pixel(point, color) in pixels {
            let index = point.y as usize * self.size.width as usize + point.x as usize;
            if let Some(pixel) = self.pixels.get_mut(index) {
                *pixel = color;
            }
        }
        Ok(())
    }

    /// A figure fills its whole target at once.
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

/// Sets the picture's width and height, at most 1024 each. The next drawing is of all pixels.
#[unsafe(no_mangle)]
pub extern "C" fn resize(width: u32, height: u32) {
    let mut canvas = CANVAS.borrow();
    canvas.size = Size::new(width, height).component_min(Size::new_equal(SIDE as u32));
    canvas.shown = None;
}

/// Sets the colours as bytes of red, green, blue and opacity; the ground is clear. The next drawing is of all pixels.
#[unsafe(no_mangle)]
pub extern "C" fn paint(line: u32, link: u32, joint: u32, torque: u32) {
    let mut canvas = CANVAS.borrow();
    canvas.theme = Theme {
        ground: Rgba(0),
        line: Rgba(line),
        link: Rgba(link),
        joint: Rgba(joint),
        torque: Rgba(torque),
    };
    canvas.shown = None;
}

/// Draws the acrobot at a part of its last step, from 0 (before) to 1 (after), with the step's torque. Returns where
/// the tip is: to the right of the fixed joint and above it, m.
#[unsafe(no_mangle)]
pub extern "C" fn draw(part: f32) -> *const [f32; 2] {
    static TIP: Shared<[f32; 2]> = Shared::new([0.0; 2]);
    simulation::with(|simulation| {
        let mut acrobot = simulation.env.inner().clone();
        let dt = acrobot.params().dt;
        let state = between(simulation.before, acrobot.state(), dt, part);
        // What overflowed on the way stays at the step's end.
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

        let height = acrobot.tip_height();
        // Turned by a quarter, what was to the right is above.
        let turned = State {
            theta1: state.theta1 + FRAC_PI_2,
            ..state
        };
        let _ = acrobot.set_state(turned);
        *TIP.borrow() = [acrobot.tip_height(), height];
    });
    TIP.address()
}

/// The state at a `part` of the step from `a` to `b`: the angles by the cubic that has both states' angles and
/// velocities (Hermite's), the velocities in proportion.
fn between(a: State<f32>, b: State<f32>, dt: f32, part: f32) -> State<f32> {
    let [part2, part3] = [part * part, part * part * part];
    let angle = |theta: [f32; 2], dtheta: [f32; 2]| {
        let [start, end] = dtheta.map(|dtheta| dtheta * dt);
        // Of the turns that lead from one angle to the other, those nearest to the mean velocity's.
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
