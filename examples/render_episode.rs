//! An episode of the bang-bang policy, torque against θ̇1, as an animated GIF and as an animated SVG; or one state as
//! a PNG.
//!
//! ```text
//! cargo run --release --example render_episode -- --seed 42 --out episode.gif
//! cargo run --release --example render_episode -- --state 0.6,-1.5 --out frame.png
//! ```

use std::error::Error;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use acrobot::numpy::SeedSequence;
use acrobot::physics::Pendulum;
use acrobot::render::{Figure, Frame};
use acrobot::{Acrobot, Params, Portable, State, TimeLimit};
use clap::Parser;
use examples_common::{animation, bang_bang, exit, files};

/// Draws an episode as FILE.gif and as FILE.svg, or one state as a PNG.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Seed of the initial state: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// Draws one state in 500×500 pixels: two angles in rad.
    #[arg(long, value_name = "THETA1,THETA2", value_parser = state, allow_hyphen_values = true)]
    state: Option<State>,
    /// File to write: a GIF, or with --state a PNG.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

fn state(text: &str) -> Result<State, String> {
    let angles = text.split_once(',').and_then(|(theta1, theta2)| {
        Some([theta1.trim().parse().ok()?, theta2.trim().parse().ok()?])
    });
    let [theta1, theta2] = angles.ok_or("must be two numbers in rad, such as 0.6,-1.5")?;
    let state = State {
        theta1,
        theta2,
        ..State::default()
    };
    state.validate().map_err(|error| error.to_string())?;
    Ok(state)
}

fn main() -> ExitCode {
    exit::run(|options: &Options| {
        let out = |default| options.out.as_deref().unwrap_or(Path::new(default));
        match options.state {
            Some(state) => draw_state(state, out("frame.png")),
            None => draw_episode(&options.seed, out("episode.gif")),
        }
    })
}

fn draw_state(state: State, out: &Path) -> Result<(), Box<dyn Error>> {
    expect_extension(out, "png")?;
    let acrobot = Acrobot::from_pendulum(Pendulum::<Portable>::new(Params::DEFAULT, state)?, ());
    files::write(out, png(&Frame::of(&Figure::new(&acrobot)))?)?;
    writeln!(io::stdout(), "{}: the frame", out.display())?;
    Ok(())
}

fn draw_episode(seed: &SeedSequence, out: &Path) -> Result<(), Box<dyn Error>> {
    expect_extension(out, "gif")?;
    let svg = out.with_extension("svg");
    let (figures, states) = episode(seed);
    files::write(out, animation::gif(&figures)?)?;
    files::write(&svg, animation::svg(&states, animation::DELAY))?;
    for path in [out, &svg] {
        writeln!(io::stdout(), "{}: {} frames", path.display(), figures.len())?;
    }
    Ok(())
}

/// The initial state and every step of the episode.
fn episode(seed: &SeedSequence) -> (Vec<Figure>, Vec<State>) {
    let mut acrobot = TimeLimit::v1(Acrobot::<Portable>::with_rng(seed.clone().into()));
    let mut figures = vec![Figure::new(acrobot.inner())];
    let mut states = vec![acrobot.state()];
    loop {
        let action = bang_bang(acrobot.state().dtheta1);
        let step = acrobot.step(action);
        let torque = acrobot.params().torque(action) as f32;
        figures.push(Figure::new(acrobot.inner()).with_torque(torque));
        states.push(acrobot.state());
        if step.done() {
            return (figures, states);
        }
    }
}

fn png(frame: &Frame) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, frame.width(), frame.height());
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(frame.bytes())?;
    writer.finish()?;
    Ok(bytes)
}

fn expect_extension(out: &Path, extension: &str) -> Result<(), String> {
    if out.extension().is_some_and(|found| found == extension) {
        return Ok(());
    }
    Err(format!(
        "--out must end in .{extension}, got {}",
        out.display()
    ))
}
