//! Q(λ) with replay, or Sutton's Sarsa(λ), learns to swing up within seconds. The greedy policy is then compared with two
//! policies that do not learn.
//!
//! ```text
//! cargo run --release -p desktop --bin swing_up -- --steps 1000000 --save weights.bin
//! cargo run --release -p desktop --bin swing_up -- --steps 0 --load weights.bin
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

use std::ops::DerefMut;
use std::path::PathBuf;

use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::{Action, State};
use anyhow::bail;
use clap::{Parser, ValueEnum};
use desktop::{animation, load, write};
use indicatif::{ProgressBar, ProgressStyle};

mod curve;
mod pictures;

use learners::task::{
    self, QLambda, Values, evaluation, greedy, learn, play, torque, training, view,
};
use learners::{Budget, Learn, Transition};
use pictures::svg;

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
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// File to load the weights from. Without it all weights are 0.
    #[arg(long, value_name = "FILE")]
    load: Option<PathBuf>,
    /// Folder for the pictures.
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    pictures: PathBuf,
    /// Prints only one line, and draws nothing.
    #[arg(long)]
    quiet: bool,
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

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    match (options.learner, options.memory) {
        (Algorithm::Replay, Memory::K64) => replay::<64, 6144, 52, 600>(&options),
        (Algorithm::Replay, Memory::K32) => replay::<32, 2944, 52, 300>(&options),
        (Algorithm::Replay, Memory::K16) => replay::<16, 1408, 16, 160>(&options),
        (Algorithm::Sarsa, Memory::K64) => sarsa::<8192, 28>(&options),
        (Algorithm::Sarsa, Memory::K32) => sarsa::<4096, 20>(&options),
        (Algorithm::Sarsa, Memory::K16) => sarsa::<2048, 20>(&options),
        (Algorithm::Sarsa, Memory::K8) => sarsa::<1024, 16>(&options),
        (Algorithm::Replay, Memory::K8) => {
            bail!("--memory must be 16k, 32k or 64k for the learner replay, got 8k")
        }
    }
}

/// Learns by Sarsa(λ) with `T` tilings in `S` slots.
fn sarsa<const S: usize, const T: usize>(options: &Options) -> anyhow::Result<()> {
    let mut weights = [[0.0; 2]; S];
    run(
        options,
        task::sarsa::<S, T>(options.budget(), &mut weights)?,
    )
}

/// Learns by Q(λ), and replays the latest `N` steps. All that the learner keeps fits in `KIB`: features, weights and steps.
fn replay<const KIB: usize, const S: usize, const T: usize, const N: usize>(
    options: &Options,
) -> anyhow::Result<()> {
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
) -> anyhow::Result<()>
where
    L: Learn<4> + DerefMut<Target = Values<'w, S, T>>,
{
    if let Some(path) = &options.load {
        load(&mut *learner, path)?;
    }

    let returns = train(&mut learner, options);
    if let Some(path) = &options.save {
        let bytes: Vec<u8> = learner.save().collect();
        write(path, bytes)?;
    }

    let learnt = evaluate(options, |state| greedy(&learner, state));
    let solved_at = curve::solved_at(&returns).map_or("never".into(), |n| n.to_string());
    if options.quiet {
        let ([mean, sd], misses) = (learnt.moments(), learnt.misses);
        println!("solved_at {solved_at} greedy_mean {mean:.2} greedy_sd {sd:.2} misses {misses}");
        return Ok(());
    }
    let against = |state: &State<f32>| torque((state.dtheta1 < 0.0).into());
    let mut actions = Pcg64::from(options.seed.child(2));
    println!("solved at episode: {solved_at}\n");
    println!("policy              mean return of {EVALUATION} episodes  missed the goal");
    for (name, returns) in [
        ("learnt", learnt),
        ("torque against θ̇1", evaluate(options, against)),
        (
            "random",
            evaluate(options, |_| Action::sample(&mut actions)),
        ),
    ] {
        let ([mean, sd], misses) = (returns.moments(), returns.misses);
        println!("{name:<18}  {mean:>19.2} ± {sd:<9.2}  {misses:>15}");
    }
    println!();
    draw(&*learner, &returns, options)
}

/// Draws the pictures, and prints a line for each.
fn draw<const S: usize, const T: usize>(
    learner: &Values<S, T>,
    returns: &[f32],
    options: &Options,
) -> anyhow::Result<()> {
    let save = |name: &str, svg: String, content: &str| {
        let path = options.pictures.join(name);
        write(&path, svg)?;
        println!("{}: {content}", path.display());
        anyhow::Ok(())
    };
    if !returns.is_empty() {
        let curve = svg((900, 480), |area| pictures::draw_curve(area, returns))?;
        let content = format!("the returns of {} episodes", returns.len());
        save("learning_curve.svg", curve, &content)?;
    }
    let value = |state: &State<f32>| {
        let values = learner.values(&view(state));
        values.into_iter().fold(f32::MIN, f32::max)
    };
    let values = svg((780, 720), |area| pictures::draw_values(area, value))?;
    save("values.svg", values, "the learnt values of states at rest")?;

    let mut env = evaluation(&options.seed);
    for _ in 1..EVALUATION {
        // The generator draws only initial states, so these resets lead to the last episode.
        env.reset();
    }
    let mut states = Vec::new();
    play(&mut env, |state| {
        states.push(State::from(<[f32; 4]>::from(*state).map(f64::from)));
        greedy(learner, state)
    });
    states.push(State::from(<[f32; 4]>::from(env.state()).map(f64::from)));
    let content = format!("the last greedy episode, {} steps", env.elapsed());
    save(
        "swing_up.svg",
        animation::svg(&states, animation::DELAY),
        &content,
    )
}

/// Learns. Returns the return of each episode.
fn train<'w, L, const S: usize, const T: usize>(learner: &mut L, options: &Options) -> Vec<f32>
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
            println!("steps {steps} greedy_mean {mean:.2}");
        }
        if !bar.is_hidden() && done / period > charted {
            charted = done / period;
            bar.set_message(curve::chart(&returns));
        }
        bar.set_position(done.min(length));
    }
    bar.finish();
    returns
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
