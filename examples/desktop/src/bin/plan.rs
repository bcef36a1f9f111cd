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
use desktop::load;
use desktop::search::Search;
use indicatif::ProgressIterator;

use learners::task::{evaluation, greedy, learn, play, q_lambda, training, view};
use learners::{Budget, Transition};

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

/// Those of `swing_up` with 64 KiB.
const SLOTS: usize = 6144;
const TILINGS: usize = 52;
const STEPS: usize = 600;

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let mut weights = [[0.0; 2]; SLOTS];
    let mut memory = [Transition::EMPTY; STEPS];
    let budget = Budget::Episodes(options.learn);
    let mut learner = q_lambda::<SLOTS, TILINGS>(budget, &mut weights, &mut memory)?;
    match &options.load {
        Some(path) => load(&mut learner, path)?,
        None => {
            let (mut env, mut choices) = training(options.seed.clone());
            for _ in (0..options.learn).progress() {
                learn(&mut learner, &mut env, &mut choices);
            }
        }
    }

    let mut search = Search::default();
    println!(
        "policy          mean return of {} episodes  missed the goal",
        options.episodes
    );
    let learnt = report("greedy", &options, |state| greedy(&learner, state));
    println!("{learnt}");
    let name = format!("{} steps ahead", options.depth);
    let planned = report(&name, &options, |state| {
        search.choose(*state, options.depth, |state| {
            let [negative, positive] = learner.values(&view(state));
            negative.max(positive)
        })
    });
    println!("{planned}");
    println!(
        "the search takes {} bytes, and {} steps of the model per action",
        size_of::<Search>(),
        search.steps_per_choice()
    );
    Ok(())
}

fn report(name: &str, options: &Options, mut policy: impl FnMut(&State<f32>) -> Action) -> String {
    let mut env = evaluation(&options.seed);
    let (mut sum, mut squares, mut misses) = (0.0, 0.0, 0);
    for _ in (0..options.episodes).progress() {
        let (gained, reached) = play(&mut env, &mut policy);
        sum += f64::from(gained);
        squares += f64::from(gained * gained);
        misses += u32::from(!reached);
    }
    let n = f64::from(options.episodes);
    let mean = sum / n;
    let sd = (squares / n - mean * mean).max(0.0).sqrt();
    format!("{name:<14}  {mean:>16.2} ± {sd:<9.2}  {misses:>15}")
}
