//! dm_control's swing-up, planned: model predictive control with the exact model, and a regulator near upright.
//!
//! ```text
//! cargo run --release -p desktop --bin stay_up
//! ```
//!
//! Every 0.1 s the planner tries 1,024 sequences of torques for the next 1.2 s, on a batch, in three rounds. It draws the sequences of a round around the
//! best of the round before: the cross-entropy method (R. Y. Rubinstein, *The Cross-Entropy Method for Combinatorial and Continuous Optimization*,
//! 1999). The worth of a sequence is the sum of its rewards, less a penalty if its last state has another energy than standing upright, or if link 2 turns fast,
//! plus a bonus near upright.
//!
//! Prints the mean return of episodes of 1,000 steps, from the initial states of `Acrobot::new(seed)` for seeds from 0.

use std::array::from_fn;

use acrobot::arithmetic::{Arithmetic, Swingup};
use acrobot::batch::VecBatch;
use acrobot::numpy::{Pcg64, SeedSequence, uniform};
use acrobot::physics::control::{Lqr, difference, discretize, lqr};
use acrobot::physics::{Pendulum, bound};
use acrobot::{Acrobot, Fast, Params, State};
use clap::Parser;
use rayon::prelude::*;

type Task = Swingup<Fast>;

/// A round tries this many sequences. The next round is drawn around the best ones.
const TRIES: usize = 1024;
const BEST: usize = 64;
const ROUNDS: usize = 3;
/// Torques of a sequence, and the steps of each.
const TORQUES: usize = 12;
const HOLD: usize = 10;
/// The largest torque, N m.
const LIMIT: f32 = 2.0;
/// The standard deviation of a new torque, N m, and the least after a round.
const SPREAD: f32 = 1.5;
const LEAST_SPREAD: f32 = 0.2;
/// What a last state loses for each joule too few or too many, and for θ̇2² of 1 rad²/s².
const ENERGY: f32 = 5.0;
const TURNING: f32 = 0.5;
/// What a last state gains where the regulator's cost to go is 0, and the cost at which that has fallen to 1/e.
const HELD: f32 = 100.0;
const NEAR: f32 = 1000.0;
/// The regulator takes over below this cost.
const LITTLE: f32 = 100.0;

/// Plays the swing-up by planning.
#[derive(Parser)]
struct Options {
    /// Episodes to play.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..))]
    episodes: u32,
}

struct Planner {
    batch: VecBatch<Task>,
    regulator: Lqr<f32>,
    /// For its energy.
    model: Pendulum<Task>,
    /// The energy of standing upright, J.
    upright: f32,
    /// Mean and standard deviation of each torque, N m.
    plan: [[f32; 2]; TORQUES],
    rng: Pcg64,
}

impl Planner {
    fn new(seed: u64) -> anyhow::Result<Self> {
        let model = Pendulum::<Task>::new(Params::SWINGUP, State::UPRIGHT)?;
        let weights = from_fn(|i| from_fn(|j| f32::from(u8::from(i == j))));
        Ok(Self {
            regulator: lqr(&discretize(&model, 0.0)?, &weights, 1.0)?,
            upright: model.energy(),
            model,
            batch: VecBatch::new(SeedSequence::new(seed), TRIES)?,
            plan: [[0.0, SPREAD]; TORQUES],
            rng: Pcg64::new(seed),
        })
    }

    /// The regulator's cost to go.
    fn cost(&self, state: State<f32>) -> f32 {
        let x = difference(state, State::UPRIGHT);
        let dot = |a: [f32; 4], b: [f32; 4]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
        dot(self.regulator.cost_to_go.map(|row| dot(row, x)), x)
    }

    /// The torque that holds the acrobot upright, if it is near enough.
    fn hold(&self, state: State<f32>) -> Option<f32> {
        let x = difference(state, State::UPRIGHT);
        let torque = bound(self.regulator.torque(x), LIMIT);
        (self.cost(state) < LITTLE).then_some(torque)
    }

    /// The torque of the next `HOLD` steps.
    fn plan(&mut self, state: State<f32>) -> anyhow::Result<f32> {
        self.plan.rotate_left(1);
        self.plan[TORQUES - 1] = [0.0, SPREAD];
        for [_, spread] in &mut self.plan {
            *spread = spread.max(SPREAD / 2.0);
        }
        let mut tried = vec![[0.0; TORQUES]; TRIES];
        for _ in 0..ROUNDS {
            for (number, sequence) in tried.iter_mut().enumerate() {
                for (torque, [mean, spread]) in sequence.iter_mut().zip(self.plan) {
                    // The first is the plan itself.
                    let spread = if number == 0 { 0.0 } else { spread };
                    *torque = bound(mean + spread * normal(&mut self.rng), LIMIT);
                }
            }
            let worth = self.worth(state, &tried)?;
            let mut order: Vec<usize> = (0..TRIES).collect();
            order.sort_unstable_by(|&a, &b| worth[b].total_cmp(&worth[a]));
            for (k, torque) in self.plan.iter_mut().enumerate() {
                let best = order[..BEST].iter().map(|&i| tried[i][k]);
                let mean = best.clone().sum::<f32>() / BEST as f32;
                let variance = best.map(|x| (x - mean) * (x - mean)).sum::<f32>() / BEST as f32;
                *torque = [mean, variance.sqrt().max(LEAST_SPREAD)];
            }
        }
        Ok(self.plan[0][0])
    }

    /// What each sequence is worth from this state.
    fn worth(&mut self, state: State<f32>, tried: &[[f32; TORQUES]]) -> anyhow::Result<Vec<f32>> {
        self.batch.reset_to(&[state; TRIES])?;
        let mut worth = vec![0.0; TRIES];
        for k in 0..TORQUES {
            let torques: Vec<f32> = tried.iter().map(|sequence| sequence[k]).collect();
            for _ in 0..HOLD {
                let results = self.batch.step(&torques)?;
                for (worth, reward) in worth.iter_mut().zip(&results.rewards) {
                    *worth += reward;
                }
            }
        }
        for (i, worth) in worth.iter_mut().enumerate() {
            let last = self.batch.state(i).unwrap_or_default();
            self.model.set_state(last)?;
            *worth -= ENERGY * (self.upright - self.model.energy()).abs();
            *worth -= TURNING * last.dtheta2 * last.dtheta2;
            *worth += HELD * (-self.cost(last) / NEAR).exp();
        }
        Ok(worth)
    }
}

/// Nearly a normal distribution: the sum of twelve uniform ones.
fn normal(rng: &mut Pcg64) -> f32 {
    (0..12).map(|_| uniform(rng, -0.5, 0.5) as f32).sum()
}

/// The return of an episode.
fn play(seed: u64) -> anyhow::Result<f64> {
    let mut acrobot = Acrobot::<Task>::new(seed);
    let mut planner = Planner::new(seed)?;
    let (mut sum, mut planned) = (0.0, 0.0);
    for step in 0..Task::TASK.limit().get() as usize {
        let held = planner.hold(acrobot.state());
        if held.is_none() && step % HOLD == 0 {
            planned = planner.plan(acrobot.state())?;
        }
        let step = acrobot.step_torque(held.unwrap_or(planned))?;
        sum += f64::from(step.reward);
    }
    Ok(sum)
}

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let seeds = (0..u64::from(options.episodes)).into_par_iter();
    let returns: Vec<f64> = seeds.map(play).collect::<anyhow::Result<_>>()?;
    let count = returns.len() as f64;
    let mean = returns.iter().sum::<f64>() / count;
    let variance = returns.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / count;
    let worst = returns.iter().copied().fold(f64::INFINITY, f64::min);
    println!(
        "mean return of {count} episodes: {mean:.0} ± {:.0}, the worst {worst:.0}",
        variance.sqrt()
    );
    Ok(())
}
