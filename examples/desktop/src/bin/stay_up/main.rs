//! Swings up and stays up, planned with the exact model.
//!
//! ```text
//! cargo run --release -p desktop --bin stay_up                 # dm_control's swing-up
//! cargo run --release -p desktop --bin stay_up -- --gymnasium  # Gymnasium's acrobot with 1 N m
//! ```
//!
//! The planner is `Planner` of `examples/controller`. It plans before the acrobot moves. For dm_control's task the
//! search goes on from the best plans, because the planner finds only the best one near a first guess: it changes a few
//! torques of a plan, removes some of its steps or repeats them, and plans again from there.
//!
//! Prints the mean return of episodes of 1,000 steps, from the initial states of `Acrobot::new(seed)` for seeds from 0, or how
//! many of Gymnasium's initial states end upright.

use acrobot::arithmetic::{Arithmetic, Swingup};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::bound;
use acrobot::physics::control::difference;
use acrobot::{Acrobot, Fast, Params, State};
use clap::Parser;
use controller::{NoPlan, Planner, Step};
use rayon::prelude::*;

type Task = Swingup<Fast>;

/// dm_control's largest torque, and Gymnasium's, N m.
const SWINGUP: f32 = 2.0;
const GYMNASIUM: f32 = 1.0;

/// Gymnasium's acrobot: decisions a second, the most steps of a plan, and tries.
const RATE: usize = 50;
const STEPS: usize = 1250;
const TRIES: u32 = 32;

/// First guesses, and the steps of their plans.
const GUESSES: usize = 120;
const SHORTEST: usize = 150;
const LONGEST: usize = 600;
/// After a few iterations the best of them are planned until no iteration helps.
const FEW: u32 = 25;
const ALL: u32 = 150;
const KEPT: usize = 12;
/// The best of these are changed in turn, and from the middle of the search on only the best one.
const CHANGED: usize = 4;
const CHANGES: usize = 240;
const ITERATIONS: u32 = 50;
/// The most steps that a change is about.
const WINDOW: usize = 30;

/// Plays the swing-up by planning.
#[derive(Parser)]
struct Options {
    /// Episodes to play.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..))]
    episodes: u32,
    /// Plays Gymnasium's acrobot with its torque of 1 N m, 50 times a second, for 50 s.
    #[arg(long)]
    gymnasium: bool,
}

/// An episode: the sum of its rewards, and the first step after which it was always upright.
struct Episode {
    total: f64,
    upright: usize,
}

impl Episode {
    /// Follows a plan, and then the regulator.
    fn play<A: Arithmetic<Scalar = f32>>(
        mut acrobot: Acrobot<A>,
        planner: &Planner<A>,
        plan: &[Step<f32>],
        limit: f32,
        steps: usize,
    ) -> anyhow::Result<Self> {
        let (mut total, mut upright) = (0.0, 0);
        for i in 0..steps {
            let state = acrobot.state();
            let torque = match plan.get(i) {
                Some(step) => step.follow(state),
                None => planner
                    .regulator()
                    .torque(difference(state, State::UPRIGHT)),
            };
            total += f64::from(acrobot.step_torque(bound(torque, limit))?.reward);
            let [theta1, theta2, ..] = difference(acrobot.state(), State::UPRIGHT);
            if theta1.abs().max(theta2.abs()) > 0.1 {
                upright = i + 1;
            }
        }
        Ok(Self { total, upright })
    }
}

/// The search for the best plan from one initial state.
struct Search {
    acrobot: Acrobot<Task>,
    planner: Planner<Task>,
    rng: Pcg64,
}

impl Search {
    fn episode(&self, plan: &[Step<f32>]) -> anyhow::Result<Episode> {
        let steps = Task::TASK.limit().get() as usize;
        Episode::play(self.acrobot.clone(), &self.planner, plan, SWINGUP, steps)
    }

    /// A whole number from `low` up to but not including `high`.
    fn draw(&mut self, low: usize, high: usize) -> usize {
        uniform(&mut self.rng, low as f64, high as f64) as usize
    }

    /// A changed copy of a plan.
    fn change(&mut self, plan: &[Step<f32>]) -> Vec<Step<f32>> {
        let mut torques: Vec<f32> = plan.iter().map(|step| step.torque).collect();
        let end = self.draw(1, torques.len() + 1);
        let window = end - self.draw(1, WINDOW + 1).min(end)..end;
        match self.draw(0, 3) {
            0 => {
                let push = uniform(&mut self.rng, -2.0, 2.0) as f32;
                for torque in &mut torques[window] {
                    *torque = bound(*torque + push, SWINGUP);
                }
            }
            1 if torques.len() > 2 * WINDOW => drop(torques.drain(window)),
            _ => {
                let again = torques[window].to_vec();
                torques.splice(end..end, again);
            }
        }
        torques.into_iter().map(Step::open).collect()
    }

    fn run(&mut self) -> anyhow::Result<Episode> {
        let start = self.acrobot.state();
        let mut guesses = Vec::new();
        for _ in 0..GUESSES {
            let mut plan = vec![Step::EMPTY; self.draw(SHORTEST, LONGEST)];
            self.planner.guess(start, &mut self.rng, &mut plan)?;
            guesses.push((self.planner.improve(start, FEW, &mut plan)?, plan));
        }
        guesses.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let mut best = Vec::new();
        for (_, mut plan) in guesses.into_iter().take(KEPT) {
            self.planner.improve(start, ALL, &mut plan)?;
            best.push((self.episode(&plan)?.total, plan));
        }
        for i in 0..CHANGES {
            best.sort_by(|(a, _), (b, _)| b.total_cmp(a));
            best.truncate(if i < CHANGES / 2 { CHANGED } else { 1 });
            let len = best.len();
            let (total, plan) = &mut best[i % len];
            let mut changed = self.change(plan);
            self.planner.improve(start, ITERATIONS, &mut changed)?;
            let episode = self.episode(&changed)?;
            if episode.total > *total {
                (*total, *plan) = (episode.total, changed);
            }
        }
        self.episode(&best[0].1)
    }
}

fn swing_up(seed: u64) -> anyhow::Result<Episode> {
    let mut search = Search {
        acrobot: Acrobot::new(seed),
        planner: Planner::new(Params::SWINGUP, SWINGUP)?,
        rng: Pcg64::new(seed),
    };
    search.run()
}

/// Gymnasium's acrobot, planned as the firmware `plan` does.
fn gymnasium(seed: u64) -> anyhow::Result<Episode> {
    let params = Params {
        dt: 1.0 / RATE as f32,
        ..Params::DEFAULT
    };
    let mut acrobot = Acrobot::<Fast>::new(seed);
    acrobot.set_params(params)?;
    let mut planner = Planner::<Fast>::new(params, GYMNASIUM)?;
    let mut memory = [Step::EMPTY; STEPS];
    let found = planner.plan(acrobot.state(), TRIES, &mut Pcg64::new(seed), &mut memory);
    let plan: &[Step<f32>] = match found {
        Ok(plan) => plan,
        Err(NoPlan::NotFound { .. }) => &[],
        Err(error) => return Err(error.into()),
    };
    Episode::play(acrobot, &planner, plan, GYMNASIUM, 50 * RATE)
}

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let seeds = (0..u64::from(options.episodes)).into_par_iter();
    let count = options.episodes;
    let play = if options.gymnasium {
        gymnasium
    } else {
        swing_up
    };
    let episodes: Vec<Episode> = seeds.map(play).collect::<anyhow::Result<_>>()?;
    if options.gymnasium {
        let held = episodes
            .iter()
            .filter(|episode| episode.upright <= 40 * RATE);
        let longest = held.clone().map(|episode| episode.upright).max();
        let longest = longest.unwrap_or(0) as f64 / RATE as f64;
        println!(
            "held {} of {count}, upright after at most {longest:.1} s",
            held.count()
        );
        return Ok(());
    }
    let totals = episodes.iter().map(|episode| episode.total);
    let mean = totals.clone().sum::<f64>() / f64::from(count);
    let variance = totals.clone().map(|x| (x - mean) * (x - mean)).sum::<f64>() / f64::from(count);
    let worst = totals.fold(f64::INFINITY, f64::min);
    let held = episodes
        .iter()
        .filter(|episode| episode.upright <= 900)
        .count();
    println!(
        "mean return of {count} episodes: {mean:.0} ± {:.0}, the worst {worst:.0}, held {held}",
        variance.sqrt()
    );
    Ok(())
}
