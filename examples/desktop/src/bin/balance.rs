//! The controller of the firmware `balance` swings up an acrobot and holds it upright, as an animated SVG in real time.
//!
//! ```text
//! cargo run --release -p desktop --bin balance -- --seed 42 --out balance.svg
//! ```

use std::path::PathBuf;

use acrobot::physics::control::ControlError;
use acrobot::{Acrobot, Fast, Params, State};
use clap::Parser;
use controller::Controller;
use desktop::{animation, write};

/// Draws how the firmware's controller swings up an acrobot and holds it upright.
#[derive(Parser)]
struct Options {
    /// Seed of the initial state and of the disturbance.
    #[arg(long, default_value_t = 42)]
    seed: u64,
    /// File to write.
    #[arg(long, value_name = "FILE", default_value = "balance.svg")]
    out: PathBuf,
    /// Also writes the picture as a definition for Markdown, because rustdoc's pages have no files beside them.
    #[arg(long, value_name = "FILE")]
    definition: Option<PathBuf>,
}

/// Steps, each 0.01 s.
const STEPS: usize = 1000;
/// Each of the frames shows this many steps: 25 frames a second.
const STEPS_PER_FRAME: usize = 4;

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let states = play(options.seed)?;
    let delay = STEPS_PER_FRAME as u16; // in 1/100 s
    let svg = animation::svg(&states, delay);
    if let Some(definition) = &options.definition {
        write(definition, data_url(&svg))?;
    }
    write(&options.out, svg)?;
    println!("{}: {} frames", options.out.display(), states.len());
    Ok(())
}

/// Defines the picture `balance.svg` of a Markdown page as a URL that contains it.
fn data_url(svg: &str) -> String {
    let svg = svg.replace('\n', "").replace(' ', "%20");
    let svg = svg.replace('"', "'").replace('#', "%23");
    format!("[balance.svg]: data:image/svg+xml,{svg}\n")
}

/// The state of each frame.
fn play(seed: u64) -> Result<Vec<State>, ControlError> {
    // As in the firmware with a largest torque of 10 N m.
    let params = Params {
        dt: 0.01,
        torque_noise: 0.5,
        ..Params::DEFAULT
    };
    let mut machine = Acrobot::<Fast>::new(seed);
    machine.set_params(params)?;
    let mut controller = Controller::new(params, 10.0)?;
    let mut states = Vec::new();
    for step in 0..STEPS {
        let state = machine.state();
        if step % STEPS_PER_FRAME == 0 {
            states.push(State::from(<[f32; 4]>::from(state).map(f64::from)));
        }
        machine.step_torque(controller.decide(state)?)?;
    }
    Ok(states)
}
