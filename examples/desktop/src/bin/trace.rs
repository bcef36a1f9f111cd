//! Replays actions in `Fast` and prints every bit of the states, to compare them with another
//! implementation.
//!
//! ```text
//! cargo run --release -p desktop --bin trace -- --seed 42 01222
//! ```
//!
//! The first line is the initial state and every other line a step: the bits of θ1, θ2, θ̇1 and
//! θ̇2.

use acrobot::numpy::SeedSequence;
use acrobot::physics::Dynamics;
use acrobot::{Acrobot, Action, Fast, Params};
use anyhow::Context;
use clap::Parser;

/// Prints the bits of the states of an episode.
#[derive(Parser)]
struct Options {
    /// Actions: digits 0, 1 and 2.
    #[arg(default_value = "")]
    actions: String,
    /// Seed of the initial state and of the torque noise: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// Torque noise, N m.
    #[arg(long, default_value_t = 0.0)]
    noise: f32,
    /// Duration of a step, s.
    #[arg(long, default_value_t = 0.2)]
    dt: f32,
    /// Uses the equations of the paper instead of those of the book.
    #[arg(long)]
    nips: bool,
}

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let actions = options.actions.chars().map(|digit| {
        let number = digit.to_digit(3).context("an action must be 0, 1 or 2")?;
        Ok(Action::ALL[number as usize])
    });
    let actions = actions.collect::<anyhow::Result<Vec<_>>>()?;
    let mut acrobot = Acrobot::<Fast>::new(options.seed);
    acrobot.set_params(Params {
        dt: options.dt,
        torque_noise: options.noise,
        dynamics: if options.nips { Dynamics::Nips } else { Dynamics::Book },
        ..Params::default()
    })?;
    print(&acrobot);
    for action in actions {
        acrobot.step(action);
        print(&acrobot);
    }
    Ok(())
}

fn print(acrobot: &Acrobot<Fast>) {
    let [theta1, theta2, dtheta1, dtheta2] = <[f32; 4]>::from(acrobot.state()).map(f32::to_bits);
    println!("{theta1:08x} {theta2:08x} {dtheta1:08x} {dtheta2:08x}");
}
