//! Trains an agent on Acrobot in the loop of `border-core`, through the adapter.
//!
//! ```text
//! cargo run -- --seed 42 --steps 100000
//! ```

mod agent;

use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use acrobot::env::Env as _;
use acrobot::numpy::{Pcg64, SeedSequence};
use border_core::generic_replay_buffer::{SimpleReplayBufferConfig, SimpleStepProcessorConfig};
use border_core::record::{Record, Recorder};
use border_core::{
    Agent, DefaultEvaluator, Env as _, Evaluator, ReplayBufferBase, StepProcessor, Trainer,
    TrainerConfig,
};
use clap::{Parser, value_parser};

use agent::{Buffer, Env, Learner, Random, Steps};

/// Trains Q-learning on Acrobot and prints the mean return before and after.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Seed of everything, below 2^63, because border's seeds are signed.
    #[arg(long, default_value_t = 42, value_parser = value_parser!(i64).range(0..))]
    seed: i64,
    /// The number of training steps.
    #[arg(long, default_value_t = 100_000, value_parser = value_parser!(u64).range(1..))]
    steps: u64,
}

/// The episodes of a mean return.
const EPISODES: usize = 100;
/// The number of reports in a training.
const REPORTS: usize = 20;

fn main() -> ExitCode {
    let options = Options::parse();
    match run(&options) {
        Ok(()) => ExitCode::SUCCESS,
        // The reader has closed the pipe.
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            // The status must be right also where the message cannot be printed.
            let _ = writeln!(io::stderr(), "error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let error = error.downcast_ref::<io::Error>();
    error.is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
}

fn run(options: &Options) -> anyhow::Result<()> {
    let acrobot = agent::acrobot();
    let steps = usize::try_from(options.steps)?;
    let seed = SeedSequence::new(u64::try_from(options.seed)?);
    // The evaluation's episodes use the first children of the seed.
    let child = |i| Pcg64::from(seed.child(EPISODES as u64 + i));
    let mut random: Box<dyn Agent<Env, Buffer>> = Box::new(Random(child(0)));
    let learner = Learner::new(acrobot.observation_space(), child(1));
    let mut learner: Box<dyn Agent<Env, Buffer>> = Box::new(learner);

    let mut evaluator = DefaultEvaluator::<Env>::new(&acrobot, options.seed, EPISODES)?;
    let mut out = io::stdout().lock();
    writeln!(
        out,
        "mean return of {EPISODES} episodes, seed {}",
        options.seed
    )?;
    let (score, _) = evaluator.evaluate(&mut random)?;
    writeln!(out, "random:    {score:7.1}")?;
    learner.eval();
    let (score, _) = evaluator.evaluate(&mut learner)?;
    writeln!(out, "untrained: {score:7.1}")?;

    let interval = (steps / REPORTS).max(1);
    let mut recorder: Box<dyn Recorder<Env, Buffer>> = Box::new(Progress {
        interval,
        steps,
        reports: 0,
    });
    let buffer = SimpleReplayBufferConfig::default().seed(options.seed.unsigned_abs());
    Trainer::build(
        TrainerConfig::default()
            .max_opts(steps)
            .eval_interval(interval),
    )
    .train(
        Env::build(&acrobot, options.seed)?,
        Steps::build(&SimpleStepProcessorConfig {}),
        &mut learner,
        &mut Buffer::build(&buffer),
        &mut recorder,
        &mut evaluator,
    )?;

    learner.eval();
    let (score, _) = evaluator.evaluate(&mut learner)?;
    writeln!(out, "trained:   {score:7.1}")?;
    Ok(())
}

/// Prints each evaluation of the trainer.
struct Progress {
    interval: usize,
    steps: usize,
    reports: usize,
}

impl Recorder<Env, Buffer> for Progress {
    fn write(&mut self, record: Record) {
        self.store(record);
    }

    fn store(&mut self, record: Record) {
        let Ok(score) = record.get_scalar("Episode return") else {
            return;
        };
        self.reports += 1;
        let (done, steps) = (self.reports * self.interval, self.steps);
        // A closed standard error does not stop the training.
        let _ = writeln!(io::stderr(), "{done:>8} of {steps} steps: {score:7.1}");
    }

    fn flush(&mut self, _step: i64) {}

    /// The trainer calls it for each new best model. This example saves none.
    fn save_model(&self, _base: &Path, _agent: &Box<dyn Agent<Env, Buffer>>) -> anyhow::Result<()> {
        Ok(())
    }
}
