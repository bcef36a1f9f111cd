//! An episode of the bang-bang policy, torque against θ̇1, as an animated GIF and a PNG strip; or one
//! state as a PNG.
//!
//! ```text
//! cargo run --release --example render_episode -- --seed 42 --out episode.gif
//! cargo run --release --example render_episode -- --state 0.6,-1.5 --out frame.png
//! ```

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use acrobot::env::Frame;
use acrobot::{Acrobot, Action, Figure, Portable, SeedSequence, State, Theme, TimeLimit};
use clap::Parser;
use indicatif::ProgressBar;

/// Draws an episode as FILE.gif and a strip of its frames as FILE.png, or one state as a PNG.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Seed of the start: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// Draws this state alone, in 500×500 pixels: two angles in rad.
    #[arg(long, value_name = "THETA1,THETA2", value_parser = state, allow_hyphen_values = true)]
    state: Option<State>,
    /// What to write: a GIF, or with --state a PNG.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

fn state(text: &str) -> Result<State, String> {
    let angles = text.split_once(',').and_then(|(theta1, theta2)| {
        Some([
            theta1.trim().parse::<f64>().ok()?,
            theta2.trim().parse::<f64>().ok()?,
        ])
    });
    let [theta1, theta2] = angles.ok_or("allowed are two numbers in rad, such as 0.6,-1.5")?;
    let state = State {
        theta1,
        theta2,
        ..State::default()
    };
    state.validate().map_err(|error| error.to_string())?;
    Ok(state)
}

fn main() -> ExitCode {
    let options = Options::parse();
    let result = match options.state {
        Some(state) => draw_state(state, &options.out.unwrap_or("frame.png".into())),
        None => draw_episode(options.seed, &options.out.unwrap_or("episode.gif".into())),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn draw_state(state: State, out: &Path) -> Result<(), Box<dyn Error>> {
    let mut acrobot = Acrobot::<Portable>::new(0);
    acrobot.set_state(state)?;
    write_png(out, &Frame::of(&Figure::new(&acrobot)))?;
    println!("{}: the frame", out.display());
    Ok(())
}

/// Side of the animation's frames and of the strip's, in pixels.
const SIDE: u32 = 300;
const STRIP_SIDE: u32 = 150;
const STRIP_FRAMES: usize = 8;
/// Hundredths of a second that a step of 0.2 s is shown: three times as fast as it is.
const DELAY: u16 = 7;

fn draw_episode(seed: SeedSequence, out: &Path) -> Result<(), Box<dyn Error>> {
    let strip = out.with_extension("png");
    if strip == out {
        return Err(format!(
            "--out is {}, where the strip goes; allowed is a GIF",
            out.display()
        )
        .into());
    }
    let figures = figures(seed);
    write_gif(out, &figures)?;
    write_png(&strip, &draw_strip(&figures))?;
    println!("{}: {} frames", out.display(), figures.len());
    println!("{}: {STRIP_FRAMES} of them", strip.display());
    Ok(())
}

/// The episode's start and every step.
fn figures(seed: SeedSequence) -> Vec<Figure> {
    let mut acrobot = TimeLimit::v1(Acrobot::<Portable>::new(seed));
    let mut figures = vec![Figure::new(acrobot.inner())];
    loop {
        let against = acrobot.inner().state().dtheta1 > 0.0;
        let action = if against {
            Action::Negative
        } else {
            Action::Positive
        };
        let step = acrobot.step(action);
        let torque = acrobot.inner().params().torque(action) as f32;
        figures.push(Figure::new(acrobot.inner()).with_torque(torque));
        if step.ended() {
            return figures;
        }
    }
}

fn draw(figure: &Figure, side: u32) -> Frame {
    let mut frame = Frame::new(side, side);
    let Ok(()) = figure.draw(&mut frame, &Theme::GYMNASIUM);
    frame
}

fn write_gif(out: &Path, figures: &[Figure]) -> Result<(), Box<dyn Error>> {
    let side = SIDE as u16;
    let mut encoder = gif::Encoder::new(create(out)?, side, side, &[])?;
    encoder.set_repeat(gif::Repeat::Infinite)?;
    let progress = ProgressBar::new(figures.len() as u64);
    for (i, figure) in figures.iter().enumerate() {
        let mut frame = gif::Frame::from_rgb(side, side, draw(figure, SIDE).bytes());
        // The goal stays in sight for two seconds.
        frame.delay = if i + 1 == figures.len() { 200 } else { DELAY };
        encoder.write_frame(&frame)?;
        progress.inc(1);
    }
    progress.finish_and_clear();
    Ok(())
}

/// Frames at equal distances, side by side.
fn draw_strip(figures: &[Figure]) -> Frame {
    use embedded_graphics::draw_target::DrawTargetExt;
    use embedded_graphics::geometry::{Point, Size};
    use embedded_graphics::primitives::Rectangle;

    let mut strip = Frame::new(STRIP_SIDE * STRIP_FRAMES as u32, STRIP_SIDE);
    for i in 0..STRIP_FRAMES {
        let figure = &figures[i * (figures.len() - 1) / (STRIP_FRAMES - 1)];
        let corner = Point::new(i as i32 * STRIP_SIDE as i32, 0);
        let mut part = strip.cropped(&Rectangle::new(corner, Size::new_equal(STRIP_SIDE)));
        let Ok(()) = figure.draw(&mut part, &Theme::GYMNASIUM);
    }
    strip
}

fn write_png(out: &Path, frame: &Frame) -> Result<(), Box<dyn Error>> {
    let mut encoder = png::Encoder::new(create(out)?, frame.width(), frame.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(frame.bytes())?;
    Ok(())
}

fn create(path: &Path) -> Result<BufWriter<File>, String> {
    let file =
        File::create(path).map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    Ok(BufWriter::new(file))
}
