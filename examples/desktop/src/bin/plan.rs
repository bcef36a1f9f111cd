//! Planning on top of a learnt policy, small enough for a microcontroller: before each action a beam search steps the
//! exact model ahead, and the learnt values rate the states that it reaches.
//!
//! ```text
//! cargo run --release -p desktop --bin swing_up -- --steps 1000000 --save weights.bin
//! cargo run --release -p desktop --bin plan -- --load weights.bin
//! ```
//!
//! Every step ahead tries both actions in each of the beam's eight states, and keeps the eight new states that the
//! learner values most. The search ends at the first path to the goal, because no later one is shorter. The
//! acrobot follows the path until the search finds a shorter one. Without `--load` the program learns first. Memory is
//! fixed, and the program prints how much the search takes.
//!
//! Result: looking a few steps ahead is worse than not planning. Values are learnt along the policy's own paths, and a
//! search finds states off these paths whose values are too high. From about ten steps on, true rewards outweigh that.
//! Thirty steps give nearly all of the gain. Sixty give 0.2 steps more, and most searches end earlier.

use std::path::PathBuf;

use acrobot::numpy::SeedSequence;
use acrobot::{Action, State};
use clap::Parser;
use desktop::search::Search;
use desktop::{Returns, evaluate, load};
use indicatif::ProgressIterator;
use learners::{Budget, Memory64, QLambda, training};

/// Compares the learner's greedy policy with a beam search over the learnt values.
#[derive(Parser)]
struct Options {
    /// Steps that the search looks ahead.
    #[arg(long, default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=128))]
    depth: u32,
    /// Episodes to play.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..))]
    episodes: u32,
    /// Seed of learning and evaluation: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// File of weights from `swing_up --save`, which replaces learning.
    #[arg(long, value_name = "FILE")]
    load: Option<PathBuf>,
    /// Episodes of learning without `--load`.
    #[arg(long, default_value_t = 10_000)]
    learn: u32,
}

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let mut memory = Memory64::EMPTY;
    let mut learner = QLambda::new(Budget::Episodes(options.learn), &mut memory);
    match &options.load {
        Some(path) => load(&mut learner, path)?,
        None => {
            let mut env = training(options.seed.clone());
            for _ in (0..options.learn).progress() {
                learner.learn(&mut env);
            }
        }
    }

    let mut search = Search::default();
    println!(
        "policy          mean return of {} episodes  missed the goal",
        options.episodes
    );
    let learnt = report("greedy", &options, |state| learner.greedy(state));
    println!("{learnt}");
    let name = format!("{} steps ahead", options.depth);
    let planned = report(&name, &options, |state| {
        search.choose(*state, options.depth, |state| learner.value(state))
    });
    println!("{planned}");
    println!(
        "the search takes {} bytes, and {} steps of the model per action",
        size_of::<Search>(),
        search.steps_per_choice()
    );
    Ok(())
}

fn report(name: &str, options: &Options, policy: impl FnMut(&State<f32>) -> Action) -> String {
    let returns = evaluate(&options.seed, (0..options.episodes).progress(), policy);
    let Returns { mean, sd, misses } = returns;
    format!("{name:<14}  {mean:>16.2} ± {sd:<9.2}  {misses:>15}")
}
