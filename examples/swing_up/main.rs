//! Q(λ) with replay, or Sutton's Sarsa(λ), learns to swing up within seconds. The greedy policy is then compared with two
//! policies that do not learn.
//!
//! ```text
//! cargo run --release --example swing_up -- --steps 1000000 --save weights.bin
//! cargo run --release --example swing_up -- --steps 0 --load weights.bin
//! ```
//!
//! The learner is `examples/learners`, bit-identical on microcontrollers and in browsers. `--quiet` prints one line,
//! `solved_at E greedy_mean R greedy_sd S misses K`: E is the first n ≥ 100 for which the mean return of episodes
//! n − 99 to n is −100 or better. R and S are the mean and standard deviation of 1,000 greedy episodes from initial
//! states that it was not trained on, and K of these missed the goal. With `--evaluate N` a line `steps M greedy_mean R`
//! for every N steps comes before. Without `--quiet` it draws the learning curve, the values and the last greedy
//! episode.
//!
//! Untrained, all values tie, so the learner takes the first action, and mirroring turns that into torque against θ̇1.
//! This is the baseline.

use std::error::Error;
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::ops::DerefMut;
use std::path::PathBuf;
use std::process::ExitCode;

use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::{Action, State};
use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Parser, ValueEnum};
use examples_common::{animation, exit, files, weights};
use indicatif::{ProgressBar, ProgressStyle};

mod curve;
mod pictures;

use examples_common::svg::svg;
use learners::task::{
    self, QLambda, Values, evaluation, greedy, learn, play, torque, training, view,
};
use learners::{Budget, Learn, Transition};

/// Learns to swing up, and compares the learnt policy with two simple ones.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Learner: Q(λ) with replay, or Sarsa(λ), which needs less time per step and less memory.
    #[arg(long, value_enum, default_value_t = Algorithm::Replay)]
    learner: Algorithm,
    /// Memory in KiB: with `replay` for all that the learner keeps, with `sarsa` for the weights.
    #[arg(long, value_enum, default_value_t = Memory::K64)]
    memory: Memory,
    /// Episodes of learning. Step size and exploration fall until the last one.
    #[arg(long, default_value_t = 2000, conflicts_with = "steps")]
    episodes: u32,
    /// Steps of learning, instead of episodes. The last episode is finished.
    #[arg(long)]
    steps: Option<u32>,
    /// Steps of learning from evaluation to evaluation. Without it there is one at the end.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    evaluate: Option<u32>,
    /// Seed of learning and evaluation: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// File to save the weights in.
    #[arg(long, value_name = "FILE", value_parser = PathBufValueParser::new().try_map(file))]
    save: Option<PathBuf>,
    /// File to load the weights from. Without it all weights are 0.
    #[arg(long, value_name = "FILE")]
    load: Option<PathBuf>,
    /// Folder for the pictures.
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    #[arg(value_parser = PathBufValueParser::new().try_map(folder))]
    pictures: PathBuf,
    /// Prints only one line, and draws nothing.
    #[arg(long)]
    quiet: bool,
}

/// Parses a file to save. A bad name is rejected before the episodes, not after them.
fn file(path: PathBuf) -> Result<PathBuf, &'static str> {
    let is_file = path.file_name().is_some() && !path.is_dir();
    if is_file && path.with_file_name(".").is_dir() {
        return Ok(path);
    }
    Err("must be a file in an existing folder")
}

fn folder(path: PathBuf) -> Result<PathBuf, &'static str> {
    if path.is_dir() {
        return Ok(path);
    }
    Err("must be an existing folder")
}

#[derive(Clone, Copy, ValueEnum)]
enum Algorithm {
    Replay,
    Sarsa,
}

#[derive(Clone, Copy, ValueEnum)]
enum Memory {
    #[value(name = "8k")]
    K8,
    #[value(name = "16k")]
    K16,
    #[value(name = "32k")]
    K32,
    #[value(name = "64k")]
    K64,
}

impl Options {
    fn budget(&self) -> Budget {
        self.steps
            .map_or(Budget::Episodes(self.episodes), Budget::Steps)
    }
}

fn main() -> ExitCode {
    exit::run(
        |options: &Options| match (options.learner, options.memory) {
            (Algorithm::Replay, Memory::K64) => replay::<64, 6144, 52, 600>(options),
            (Algorithm::Replay, Memory::K32) => replay::<32, 2944, 52, 300>(options),
            (Algorithm::Replay, Memory::K16) => replay::<16, 1408, 16, 160>(options),
            (Algorithm::Sarsa, Memory::K64) => sarsa::<8192, 28>(options),
            (Algorithm::Sarsa, Memory::K32) => sarsa::<4096, 20>(options),
            (Algorithm::Sarsa, Memory::K16) => sarsa::<2048, 20>(options),
            (Algorithm::Sarsa, Memory::K8) => sarsa::<1024, 16>(options),
            (Algorithm::Replay, Memory::K8) => {
                Err("--memory must be 16k, 32k or 64k for the learner replay, got 8k".into())
            }
        },
    )
}

/// Learns by Sarsa(λ) with `T` tilings in `S` slots.
fn sarsa<const S: usize, const T: usize>(options: &Options) -> Result<(), Box<dyn Error>> {
    let mut weights = [[0.0; 2]; S];
    run(
        options,
        task::sarsa::<S, T>(options.budget(), &mut weights)?,
    )
}

/// Learns by Q(λ), and replays the latest `N` steps. All that the learner keeps fits in `KIB`: features, weights and steps.
fn replay<const KIB: usize, const S: usize, const T: usize, const N: usize>(
    options: &Options,
) -> Result<(), Box<dyn Error>> {
    const {
        let weights = size_of::<[[f32; 2]; S]>();
        let memory = size_of::<[Transition<4>; N]>();
        assert!(size_of::<QLambda<S, T>>() + weights + memory <= KIB * 1024);
    }
    let mut weights = [[0.0; 2]; S];
    let mut memory = [Transition::EMPTY; N];
    let learner = task::q_lambda::<S, T>(options.budget(), &mut weights, &mut memory)?;
    run(options, learner)
}

/// Learns, and prints the results.
fn run<'w, L, const S: usize, const T: usize>(
    options: &Options,
    mut learner: L,
) -> Result<(), Box<dyn Error>>
where
    L: Learn<4> + DerefMut<Target = Values<'w, S, T>>,
{
    if let Some(path) = &options.load {
        weights::load(&mut *learner, path)?;
    }

    let returns = train(&mut learner, options)?;
    if let Some(path) = &options.save {
        let bytes: Vec<u8> = learner.save().collect();
        files::write(path, bytes)?;
    }

    let learnt = evaluate(options, |state| greedy(&learner, state));
    let solved_at = curve::solved_at(&returns).map_or("never".into(), |n| n.to_string());
    if options.quiet {
        let [mean, sd] = learnt.moments();
        let misses = learnt.misses;
        writeln!(
            io::stdout(),
            "solved_at {solved_at} greedy_mean {mean:.2} greedy_sd {sd:.2} misses {misses}"
        )?;
        return Ok(());
    }
    let against = |state: &State<f32>| torque((state.dtheta1 < 0.0).into());
    let mut actions = Pcg64::from(options.seed.child(2));
    // Drawn before printing, because the reader may close the pipe. The results are printed even if drawing fails.
    let drawn = draw(&*learner, &returns, options);
    let mut out = io::stdout();
    writeln!(out, "solved at episode: {solved_at}\n")?;
    writeln!(
        out,
        "policy              mean return of {EVALUATION} episodes  missed the goal"
    )?;
    for (name, returns) in [
        ("learnt", learnt),
        ("torque against θ̇1", evaluate(options, against)),
        (
            "random",
            evaluate(options, |_| Action::sample(&mut actions)),
        ),
    ] {
        let [mean, sd] = returns.moments();
        writeln!(
            out,
            "{name:<18}  {mean:>19.2} ± {sd:<9.2}  {:>15}",
            returns.misses
        )?;
    }
    write!(out, "\n{}", drawn?)?;
    Ok(())
}

/// Draws the pictures. Returns a line for each.
fn draw<const S: usize, const T: usize>(
    learner: &Values<S, T>,
    returns: &[f32],
    options: &Options,
) -> Result<String, Box<dyn Error>> {
    let mut lines = String::new();
    let path = |name| options.pictures.join(name);
    if !returns.is_empty() {
        let curve = path("learning_curve.svg");
        let svg = svg((900, 480), |area| pictures::draw_curve(area, returns))?;
        files::write(&curve, svg)?;
        writeln!(
            lines,
            "{}: the returns of {} episodes",
            curve.display(),
            returns.len()
        )?;
    }

    let values = path("values.svg");
    let value = |state: &State<f32>| {
        let values = learner.values(&view(state));
        values.into_iter().fold(f32::MIN, f32::max)
    };
    let svg = svg((780, 720), |area| pictures::draw_values(area, value))?;
    files::write(&values, svg)?;
    writeln!(
        lines,
        "{}: the learnt values of states at rest",
        values.display()
    )?;

    let episode = path("swing_up.gif");
    let mut env = evaluation(&options.seed);
    for _ in 1..EVALUATION {
        // The generator draws only initial states, so these resets lead to the last episode.
        env.reset();
    }
    let figures = pictures::figures(&mut env, |state| greedy(learner, state));
    files::write(&episode, animation::gif(&figures)?)?;
    writeln!(
        lines,
        "{}: the last greedy episode, {} steps",
        episode.display(),
        figures.len() - 1
    )?;
    Ok(lines)
}

/// Learns. Returns the return of each episode.
fn train<'w, L, const S: usize, const T: usize>(
    learner: &mut L,
    options: &Options,
) -> Result<Vec<f32>, io::Error>
where
    L: Learn<4> + DerefMut<Target = Values<'w, S, T>>,
{
    let (mut env, mut choices) = training(options.seed.clone());
    let (length, unit) = match options.budget() {
        Budget::Episodes(episodes) => (u64::from(episodes), "episodes"),
        Budget::Steps(steps) => (u64::from(steps), "steps"),
    };
    let bar = if options.quiet {
        ProgressBar::hidden()
    } else {
        ProgressBar::new(length)
    };
    let template = format!("{{msg}}{{elapsed}} {{wide_bar}} {{pos}}/{{len}} {unit}");
    let style = ProgressStyle::with_template(&template).expect("a valid template");
    bar.set_style(style);

    // A hundred charts in all, because drawing one takes as long as several steps.
    let period = length.div_ceil(100).max(1);
    let (mut returns, mut steps, mut done, mut charted) = (Vec::new(), 0, 0, 0);
    while done < length {
        returns.push(learn(learner, &mut env, &mut choices));
        let before = steps;
        steps += env.elapsed();
        done = match options.budget() {
            Budget::Episodes(_) => returns.len() as u64,
            Budget::Steps(_) => u64::from(steps),
        };
        if let Some(every) = options.evaluate
            && steps / every > before / every
        {
            let [mean, _] = evaluate(options, |state| greedy(learner, state)).moments();
            writeln!(io::stdout(), "steps {steps} greedy_mean {mean:.2}")?;
        }
        if !bar.is_hidden() && done / period > charted {
            charted = done / period;
            bar.set_message(curve::chart(&returns));
        }
        bar.set_position(done.min(length));
    }
    bar.finish();
    Ok(returns)
}

/// The episodes of an evaluation.
const EVALUATION: u32 = 1000;

/// The returns of a policy.
#[derive(Default)]
struct Returns {
    sum: f64,
    squares: f64,
    /// Episodes that were truncated before the goal.
    misses: u32,
}

impl Returns {
    /// Mean and standard deviation.
    fn moments(&self) -> [f64; 2] {
        let n = f64::from(EVALUATION);
        let mean = self.sum / n;
        [mean, (self.squares / n - mean * mean).max(0.0).sqrt()]
    }
}

/// Plays a policy from the same initial states as every other policy.
fn evaluate(options: &Options, mut policy: impl FnMut(&State<f32>) -> Action) -> Returns {
    let mut env = evaluation(&options.seed);
    let mut returns = Returns::default();
    for _ in 0..EVALUATION {
        let (gained, reached) = play(&mut env, &mut policy);
        returns.sum += f64::from(gained);
        returns.squares += f64::from(gained * gained);
        returns.misses += u32::from(!reached);
    }
    returns
}
