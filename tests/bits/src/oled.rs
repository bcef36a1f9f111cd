//! An episode on a monochrome 128×64 display, and a digest of all its frames.

use acrobot::render::{Figure, Theme};
use acrobot::{Acrobot, Fast, TimeLimit};
use embedded_graphics::framebuffer::{Framebuffer, buffer_size};
use embedded_graphics::geometry::Point;
use embedded_graphics::image::GetPixel;
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::pixelcolor::raw::{BigEndian, RawU1};

use crate::{Digest, against};

pub type Display =
    Framebuffer<BinaryColor, RawU1, BigEndian, 128, 64, { buffer_size::<BinaryColor>(128, 64) }>;

/// Draws the initial state and every step to the end of the episode, and returns the digest of the
/// frames, each as the 1024 bytes in the memory of an SSD1306: eight rows at a time from the left,
/// the upper row in the lowest bit.
pub fn drawn() -> u64 {
    let mut digest = Digest::default();
    let mut display = Display::new();
    let mut acrobot = TimeLimit::with_task_limit(Acrobot::<Fast>::new(42));
    let mut last = Figure::new(acrobot.inner());
    let Ok(()) = last.draw(&mut display, &Theme::MONOCHROME);
    let mut done = false;
    loop {
        for word in 0..128 {
            let (left, top) = (word % 16 * 8, word / 16 * 8);
            let pixel = |bit| display.pixel(Point::new(left + bit / 8, top + bit % 8));
            let bits = (0..64).map(|bit| u64::from(pixel(bit) == Some(BinaryColor::On)) << bit);
            digest.add(bits.sum());
        }
        if done {
            return digest.0;
        }
        let action = against(acrobot.state().dtheta1);
        done = acrobot.step(action).is_done();
        let torque = acrobot.params().torque(action);
        let figure = Figure::new(acrobot.inner()).with_torque(torque);
        let Ok(()) = figure.redraw(&last, &mut display, &Theme::MONOCHROME);
        last = figure;
    }
}

pub const DRAWN: u64 = 0x1f54_b503_27e0_b4f1;
