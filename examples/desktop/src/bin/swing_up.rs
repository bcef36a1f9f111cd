//! Q(λ) with replay learns to swing up within seconds.
//!
//! ```text
//! cargo run --release -p desktop --bin swing_up -- --steps 1000000 --save weights.bin
//! cargo run --release -p desktop --bin swing_up -- --steps 0 --load weights.bin
//! ```
//!
//! With `--quiet` it prints one line, `solved_at E greedy_mean R greedy_std S misses K`: E is the
//! first n ≥ 100 for which the mean return of episodes n − 99 to n is −100 or better. R and S are
//! the mean and standard deviation of 1,000 greedy episodes from initial states that it was not
//! trained on, and K of these missed the goal. The time of learning goes to stderr.

use std::path::{Path, PathBuf};
use std::time::Instant;

use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::{Action, REWARD_THRESHOLD};
use clap::Parser;
use desktop::{Returns, animation, bang_bang, evaluate, load, train, write};
use learners::{Budget, Memory, Memory16, Memory32, Memory64, QLambda, evaluation, play};

/// Learns to swing up, compares the learnt policy with two simple ones, and draws a greedy episode.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Memory in KiB for all that the learner keeps.
    #[arg(long, default_value = "64k", value_parser = ["16k", "32k", "64k"])]
    memory: String,
    /// Episodes of learning. The step size falls until the last one.
    #[arg(long, default_value_t = 2000, conflicts_with = "steps")]
    episodes: u32,
    /// Steps of learning, instead of episodes. The last episode is finished.
    #[arg(long)]
    steps: Option<u32>,
    /// Seed of learning and evaluation: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// File to save the weights in.
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// File to load the weights from. Without it all weights are 0.
    #[arg(long, value_name = "FILE")]
    load: Option<PathBuf>,
    /// Prints one line of figures, and draws nothing.
    #[arg(long)]
    quiet: bool,
}

/// The episodes of an evaluation, and of a mean while it learns.
const EVALUATION: u32 = 1000;
const LATEST: usize = 100;

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    match options.memory.as_str() {
        "16k" => run(&options, Memory16::EMPTY),
        "32k" => run(&options, Memory32::EMPTY),
        _ => run(&options, Memory64::EMPTY),
    }
}

fn run<const S: usize, const T: usize, const N: usize>(
    options: &Options,
    mut memory: Memory<S, T, N>,
) -> anyhow::Result<()> {
    let budget = options.steps.map_or(Budget::Episodes(options.episodes), Budget::Steps);
    let mut learner = QLambda::new(budget, &mut memory);
    if let Some(path) = &options.load {
        load(&mut learner, path)?;
    }

    let start = Instant::now();
    let returns = train(&mut learner, budget, options.seed.clone());
    let seconds = start.elapsed().as_secs_f32();
    if let Some(path) = &options.save {
        let bytes: Vec<u8> = learner.save().collect();
        write(path, bytes)?;
    }

    let seed = &options.seed;
    let learnt = evaluate(seed, EVALUATION, |state| learner.greedy(state));
    // Gymnasium calls the task solved at this mean.
    let is_solved = |latest: &[f32]| latest.iter().sum::<f32>() / LATEST as f32 >= REWARD_THRESHOLD;
    let solved_at = returns.windows(LATEST).position(is_solved);
    let solved_at = solved_at.map_or("never".into(), |n| (n + LATEST).to_string());
    if options.quiet {
        let Returns { mean, std, misses } = learnt;
        eprintln!("learnt in {seconds:.2} s");
        println!("solved_at {solved_at} greedy_mean {mean:.2} greedy_std {std:.2} misses {misses}");
        return Ok(());
    }
    let mut actions = Pcg64::from(seed.child(2));
    println!("solved at episode: {solved_at}\n");
    println!("policy              mean return of {EVALUATION} episodes  missed the goal");
    let row = |name: &str, Returns { mean, std, misses }: Returns| {
        println!("{name:<18}  {mean:>19.2} ± {std:<9.2}  {misses:>15}");
    };
    row("learnt", learnt);
    row("torque against θ̇1", evaluate(seed, EVALUATION, |state| bang_bang(state.dtheta1)));
    row("random", evaluate(seed, EVALUATION, |_| Action::sample(&mut actions)));

    let mut env = evaluation(seed);
    let mut states = Vec::new();
    play(&mut env, |state| {
        states.push(state.cast());
        learner.greedy(state)
    });
    states.push(env.state().cast());
    write(Path::new("swing_up.svg"), animation::svg(&states, animation::DELAY, 0..0))?;
    println!("\nswing_up.svg: a greedy episode, {} steps", env.elapsed_steps());
    Ok(())
}
