//! Gymnasium's quick start in Rust: random actions, and a reset after each episode.
//!
//! ```text
//! cargo run --release -p desktop --bin random_agent -- --seed 42 --steps 1000
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

use acrobot::arithmetic::Host;
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::{Acrobot, Action, TimeLimit};
use clap::Parser;

/// Plays Acrobot-v1 at random and prints a line for each episode.
#[derive(Parser)]
struct Options {
    /// Seed of the initial states and of the actions: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// Number of steps.
    #[arg(long, default_value_t = 1000)]
    steps: u64,
}

fn main() {
    let options = Options::parse();
    let rng = Pcg64::from(options.seed);
    let mut action_space = rng.clone();
    let mut acrobot = TimeLimit::v1(Acrobot::<Host>::with_rng(rng));
    let (mut episodes, mut sum) = (0, 0.0);
    for _ in 0..options.steps {
        let step = acrobot.step(Action::sample(&mut action_space));
        sum += f64::from(step.reward);
        if step.done() {
            episodes += 1;
            let end = if step.terminated {
                "terminated"
            } else {
                "truncated"
            };
            println!("episode {episodes}: {} steps, {end}", acrobot.elapsed());
            acrobot.reset();
        }
    }
    println!(
        "{} steps, {episodes} episodes, {sum} as the sum of rewards",
        options.steps
    );
}
