//! Planning on top of a learnt policy, small enough for a microcontroller: before each action a beam search steps the
//! exact model ahead, and the learnt values rate the states that it reaches.
//!
//! ```text
//! cargo run --release --example swing_up -- --steps 1000000 --save weights.bin
//! cargo run --release --example plan -- --load weights.bin
//! ```
//!
//! Every step ahead tries both actions in each of the beam's eight states, and keeps the eight new states that the
//! learner values most. The search ends at the first path to the goal, because no later one is shorter. The
//! acrobot follows the path until the search finds a shorter one. Without `--load` the program learns first. Memory is
//! fixed, and the program prints how much the search takes.
//!
//! Result: looking a few steps ahead is worse than not planning. Values are learnt along the policy's own paths, and a
//! search finds states off these paths whose values are too high. From about ten steps on, true rewards outweigh that.
//! Thirty steps give nearly all of the gain. Sixty give half a step more, and most searches end earlier.

use std::error::Error;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use acrobot::numpy::SeedSequence;
use acrobot::physics::Pendulum;
use acrobot::{Action, Fast, State};
use clap::Parser;
use examples_common::{exit, weights};
use indicatif::ProgressIterator;

use sarsa::task::{Values, evaluation, greedy, learn, play, q_lambda, torque, training, view};
use sarsa::{Budget, Transition};

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

fn main() -> ExitCode {
    exit::run(run)
}

fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let mut weights = [[0.0; 2]; SLOTS];
    let mut memory = [Transition::EMPTY; STEPS];
    let budget = Budget::Episodes(options.learn);
    let mut learner = q_lambda::<SLOTS, TILINGS>(budget, &mut weights, &mut memory)?;
    match &options.load {
        Some(path) => weights::load(&mut learner, path)?,
        None => {
            let (mut env, mut choices) = training(options.seed.clone());
            for _ in (0..options.learn).progress() {
                learn(&mut learner, &mut env, &mut choices);
            }
        }
    }

    let mut search = Search::new();
    let mut out = io::stdout();
    writeln!(
        out,
        "policy          mean return of {} episodes  missed the goal",
        options.episodes
    )?;
    let learnt = report("greedy", options, |state| greedy(&learner, state));
    writeln!(out, "{learnt}")?;
    let name = format!("{} steps ahead", options.depth);
    let planned = report(&name, options, |state| {
        search.choose(&learner, *state, options.depth)
    });
    writeln!(out, "{planned}")?;
    writeln!(
        out,
        "the search takes {} bytes, and {} steps of the model per action",
        size_of::<Search>(),
        search.steps / u64::from(search.choices.max(1))
    )?;
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

/// The width of the beam: states that are followed at the same time.
const BEAM: usize = 8;

/// A beam search on the model, in fixed memory.
struct Search {
    model: Pendulum<Fast>,
    /// The followed states, and the new states that each action leads to.
    beam: [Node; 2 * BEAM],
    /// The shortest known path to the goal from the state of the next choice.
    plan: Option<Path>,
    choices: u32,
    steps: u64,
}

/// Actions, the first in the lowest bit.
#[derive(Clone, Copy, Default)]
struct Path {
    actions: u128,
    len: u32,
}

impl Path {
    fn then(self, action: usize) -> Self {
        Self {
            actions: self.actions | (action as u128) << self.len,
            len: self.len + 1,
        }
    }

    fn first(self) -> Action {
        torque((self.actions & 1) as usize)
    }

    /// The actions after the first.
    fn rest(self) -> Option<Self> {
        let len = self.len.checked_sub(1)?;
        (len > 0).then_some(Self {
            actions: self.actions >> 1,
            len,
        })
    }
}

/// A reachable state, the path there, and the learnt value of the remaining steps.
#[derive(Clone, Copy, Default)]
struct Node {
    state: State<f32>,
    path: Path,
    value: f32,
}

impl Search {
    fn new() -> Self {
        Self {
            model: Pendulum::hanging(),
            beam: [Node::default(); 2 * BEAM],
            plan: None,
            choices: 0,
            steps: 0,
        }
    }

    /// The first action of the best path found now or before.
    fn choose(&mut self, values: &Values<SLOTS, TILINGS>, state: State<f32>, depth: u32) -> Action {
        self.choices += 1;
        let path = match (self.plan, self.best(values, state, depth)) {
            (Some(plan), (found, true)) if found.len < plan.len => found,
            (Some(plan), _) => plan,
            (None, (found, is_goal)) => {
                if !is_goal {
                    return found.first();
                }
                found
            }
        };
        self.plan = path.rest();
        path.first()
    }

    /// The best path of up to `depth` actions, and whether it ends in the goal.
    fn best(
        &mut self,
        values: &Values<SLOTS, TILINGS>,
        state: State<f32>,
        depth: u32,
    ) -> (Path, bool) {
        self.beam[0] = Node {
            state,
            ..Node::default()
        };
        let mut followed = 1;
        for _ in 0..depth {
            let from = self.beam;
            let children = 2 * followed;
            for (child, node) in self.beam.iter_mut().enumerate().take(children) {
                let (parent, action) = (from[child / 2], child % 2);
                let model = &mut self.model;
                let reached = model
                    .set_state(parent.state)
                    .and_then(|()| model.step(model.params().torque(torque(action))))
                    .expect("finite states and torques");
                self.steps += 1;
                node.path = parent.path.then(action);
                if reached {
                    return (node.path, true);
                }
                node.state = model.state();
                let [negative, positive] = values.values(&view(&node.state));
                node.value = negative.max(positive);
            }
            self.beam[..children].sort_unstable_by(|a, b| b.value.total_cmp(&a.value));
            followed = children.min(BEAM);
        }
        (self.beam[0].path, false)
    }
}
