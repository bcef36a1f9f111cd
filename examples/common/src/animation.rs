//! Figures as an animated GIF.

use acrobot::render::{Figure, Frame, Theme};
use indicatif::ProgressBar;

/// The side of the frames, pixels.
const SIDE: u16 = 300;
/// How long a step of 0.2 s is shown, in 1/100 s: about three times as fast as real time.
const DELAY: u16 = 7;

pub fn gif(figures: &[Figure]) -> Result<Vec<u8>, gif::EncodingError> {
    let mut encoder = gif::Encoder::new(Vec::new(), SIDE, SIDE, &[])?;
    encoder.set_repeat(gif::Repeat::Infinite)?;
    let progress = ProgressBar::new(figures.len() as u64);
    for (i, figure) in figures.iter().enumerate() {
        let mut drawn = Frame::new(SIDE.into(), SIDE.into());
        let Ok(()) = figure.draw(&mut drawn, &Theme::GYMNASIUM);
        let mut frame = gif::Frame::from_rgb(SIDE, SIDE, drawn.bytes());
        // The last frame stays for two seconds.
        frame.delay = if i + 1 == figures.len() { 200 } else { DELAY };
        encoder.write_frame(&frame)?;
        progress.inc(1);
    }
    progress.finish_and_clear();
    encoder.into_inner()
}
