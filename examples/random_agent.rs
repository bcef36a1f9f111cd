//! Gymnasium's quick start in Rust: random actions, and a reset after each episode.
//!
//! ```text
//! cargo run --release --example random_agent -- --seed 42 --steps 1000
//! ```
//!
//! With the same seed this Python code plays the same episodes:
//!
//! ```python
//! env = gymnasium.make("Acrobot-v1")
//! env.reset(seed=42)
//! env.action_space.seed(42)
//! for _ in range(1000):
//!     _, _, terminated, truncated, _ = env.step(env.action_space.sample())
//!     if terminated or truncated:
//!         env.reset()
//! ```

use std::io::{self, Write};
use std::process::ExitCode;

use acrobot::arithmetic::Host;
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::{Acrobot, Action, TimeLimit};
use clap::Parser;
use examples_common::exit;

/// Plays Acrobot-v1 at random and prints a line for each episode.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Seed of the initial states and of the actions: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// Number of steps.
    #[arg(long, default_value_t = 1000)]
    steps: u64,
}

fn main() -> ExitCode {
    exit::run(|options| play(options, &mut io::stdout().lock()))
}

fn play(options: &Options, out: &mut impl Write) -> io::Result<()> {
    let rng = Pcg64::from(options.seed.clone());
    let mut action_space = rng.clone();
    let mut acrobot = TimeLimit::v1(Acrobot::<Host>::with_rng(rng));

    let (mut episodes, mut goals, mut sum) = (0_u64, 0_u64, 0.0);
    let mut episode_return = 0.0;
    for _ in 0..options.steps {
        let step = acrobot.step(Action::sample(&mut action_space));
        episode_return += f64::from(step.reward);
        if step.done() {
            episodes += 1;
            goals += u64::from(step.terminated);
            sum += episode_return;
            let length = acrobot.elapsed();
            let end = if step.terminated {
                "terminated"
            } else {
                "truncated"
            };
            writeln!(
                out,
                "episode {episodes}: {length} steps, return {episode_return}, {end}"
            )?;
            acrobot.reset();
            episode_return = 0.0;
        }
    }

    write!(
        out,
        "{} steps, {episodes} episodes, {goals} reached the goal",
        options.steps
    )?;
    if episodes > 0 {
        write!(out, ", mean return {:.1}", sum / episodes as f64)?;
    }
    match acrobot.elapsed() {
        0 => writeln!(out),
        unfinished => writeln!(out, "; {unfinished} steps of an unfinished episode"),
    }
}
