//! An episode of the bang-bang policy, torque against θ̇1, as an animated SVG.
//!
//! ```text
//! cargo run --release -p desktop --bin episode -- --seed 42 --out episode.svg
//! ```

use std::path::PathBuf;

use acrobot::numpy::SeedSequence;
use acrobot::{Acrobot, Portable, TimeLimit};
use clap::Parser;
use desktop::{animation, bang_bang, write};

/// Draws an episode as an animated SVG, about three times as fast as real time.
#[derive(Parser)]
struct Options {
    /// Seed of the initial state: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// File to write.
    #[arg(long, value_name = "FILE", default_value = "episode.svg")]
    out: PathBuf,
}

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let mut acrobot = TimeLimit::v1(Acrobot::<Portable>::with_rng(options.seed.into()));
    let mut states = vec![acrobot.state()];
    loop {
        let step = acrobot.step(bang_bang(acrobot.state().dtheta1));
        states.push(acrobot.state());
        if step.done() {
            break;
        }
    }
    write(&options.out, animation::svg(&states, animation::DELAY))?;
    println!("{}: {} frames", options.out.display(), states.len());
    Ok(())
}
