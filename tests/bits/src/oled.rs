//! An episode on a monochrome 128×64 display, and a digest of all its frames.

use acrobot::render::{Figure, Theme};
use acrobot::{Acrobot, Action, Fast, TimeLimit};
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::pixelcolor::BinaryColor;

use crate::against;

/// The acrobot in its initial state.
pub fn start() -> TimeLimit<Acrobot<Fast>> {
    TimeLimit::v1(Acrobot::new(42))
}

/// The policy of the episode: torque against θ̇1.
pub fn policy(acrobot: &Acrobot<Fast>) -> Action {
    against(acrobot.state().dtheta1)
}

/// Draws the initial state and every step to the end of the episode. Calls `shown` after each frame.
pub fn play<D: DrawTarget<Color = BinaryColor>>(
    display: &mut D,
    mut acrobot: TimeLimit<Acrobot<Fast>>,
    policy: impl Fn(&Acrobot<Fast>) -> Action,
    mut shown: impl FnMut(&mut D),
) -> Result<(), D::Error> {
    let mut last = Figure::new(acrobot.inner());
    last.draw(display, &Theme::MONOCHROME)?;
    shown(display);
    loop {
        let action = policy(acrobot.inner());
        let step = acrobot.step(action);
        let torque = acrobot.params().torque(action);
        let figure = Figure::new(acrobot.inner()).with_torque(torque);
        figure.redraw(&last, display, &Theme::MONOCHROME)?;
        shown(display);
        last = figure;
        if step.done() {
            return Ok(());
        }
    }
}

/// The number of frames.
pub const FRAMES: u32 = 95;

/// The digest of all frames, each as the 1024 bytes in the memory of an SSD1306: eight rows at a time
/// from the left, the upper row in the lowest bit.
pub const DIGEST: u64 = 0x1f54_b503_27e0_b4f1;
