//! Swings up and stays up, planned with the exact model.
//!
//! ```text
//! cargo run --release -p desktop --bin stay_up                 # dm_control's swing-up
//! cargo run --release -p desktop --bin stay_up -- --gymnasium  # Gymnasium's acrobot with 1 N m
//! cargo run --release -p desktop --bin stay_up -- --replan     # both in real time
//! ```
//!
//! The initial states are those of `Acrobot::new(seed)` for seeds from 0.

mod replan;
mod search;

use std::ops::Range;

use acrobot::arithmetic::Arithmetic;
use acrobot::control::plan::{Knot, Plan, Planner, Problem};
use acrobot::numpy::Pcg64;
use acrobot::physics::saturate;
use acrobot::task::Task;
use acrobot::{Acrobot, Error, Fast, Params, State};
use clap::Parser;
use rayon::prelude::*;
use search::Search;

/// Largest torques, N m.
const SWINGUP: f32 = 2.0;
const GYMNASIUM: f32 = 1.0;

/// Gymnasium's acrobot: decisions a second, the most steps of a plan, and tries.
const RATE: usize = 50;
const STEPS: usize = 1250;
const TRIES: u32 = 64;

/// The steps of first guesses for the swing-up.
const LENGTHS: Range<usize> = 150..600;

/// The whole search begins again, so many times, while the best return is below this.
const AGAIN: u32 = 2;
const POOR: f64 = 500.0;

/// Plays dm_control's swing-up by planning.
#[derive(Parser)]
struct Options {
    /// Episodes to play.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..))]
    episodes: u32,
    /// Plays Gymnasium's acrobot with its torque of 1 N m, 50 times a second, for 50 s.
    #[arg(long)]
    gymnasium: bool,
    /// Plays both tasks with wrong models and noise, and plans again while the acrobot moves.
    #[arg(long, conflicts_with = "gymnasium")]
    replan: bool,
}

/// An episode: the sum of its rewards, and the first step after which it was always upright.
#[derive(Default)]
struct Episode {
    total: f64,
    upright: usize,
}

impl Episode {
    /// Follows a plan.
    fn play<A: Arithmetic<Scalar = f32>, T: Task>(
        mut acrobot: Acrobot<A, T>,
        plan: &Plan<f32, &[Knot<f32>]>,
        limit: f32,
        steps: usize,
    ) -> anyhow::Result<Self> {
        let mut episode = Self::default();
        for i in 0..steps {
            let torque = plan.torque(i, acrobot.state());
            episode.step(&mut acrobot, saturate(torque, limit), i)?;
        }
        Ok(episode)
    }

    /// Takes step `i`.
    fn step<A: Arithmetic<Scalar = f32>, T: Task>(
        &mut self,
        acrobot: &mut Acrobot<A, T>,
        torque: f32,
        i: usize,
    ) -> anyhow::Result<()> {
        self.total += f64::from(acrobot.step_torque(torque)?.reward);
        let [theta1, theta2, ..] = acrobot.state().deviation_from(State::UPRIGHT);
        if theta1.abs().max(theta2.abs()) > 0.1 {
            self.upright = i + 1;
        }
        Ok(())
    }

    /// Whether an episode of so many steps is upright in its last hundred.
    fn holds(&self, steps: usize) -> bool {
        self.upright + 100 <= steps
    }
}

fn swing_up(seed: u64) -> anyhow::Result<Episode> {
    let mut search = Search::new(Acrobot::new(seed), SWINGUP, LENGTHS, 1000, seed)?;
    let (mut best, _) = search.run(1)?;
    for _ in 0..AGAIN {
        if best.total >= POOR {
            break;
        }
        let (other, _) = search.run(1)?;
        if other.total > best.total {
            best = other;
        }
    }
    Ok(best)
}

/// Gymnasium's acrobot, from each initial state.
fn gymnasium(seed: u64) -> anyhow::Result<Episode> {
    let params = Params { dt: 1.0 / RATE as f32, ..Params::DEFAULT };
    let acrobot = Acrobot::<Fast>::with_params(seed, params)?;
    let mut planner = Planner::<Fast>::new(&Problem::swing_up(params, GYMNASIUM)?)?;
    let found = planner.plan(acrobot.state(), TRIES, &mut Pcg64::new(seed), STEPS);
    let knots = match found {
        Ok(plan) => plan.knots,
        Err(Error::NoPlan { .. }) => vec![],
        Err(error) => return Err(error.into()),
    };
    let plan = Plan { knots: &*knots, after: *planner.regulator().feedback() };
    Episode::play(acrobot, &plan, GYMNASIUM, 50 * RATE)
}

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    if options.replan {
        return replan::tables(options.episodes);
    }
    let seeds = (0..u64::from(options.episodes)).into_par_iter();
    let count = options.episodes;
    let play = if options.gymnasium { gymnasium } else { swing_up };
    let episodes: Vec<Episode> = seeds.map(play).collect::<anyhow::Result<_>>()?;
    if options.gymnasium {
        let held = episodes.iter().filter(|episode| episode.upright <= 40 * RATE);
        let longest = held.clone().map(|episode| episode.upright).max();
        let longest = longest.unwrap_or(0) as f64 / RATE as f64;
        println!("held {} of {count}, upright after at most {longest:.1} s", held.count());
        return Ok(());
    }
    let totals = episodes.iter().map(|episode| episode.total);
    let mean = totals.clone().sum::<f64>() / f64::from(count);
    let squares = totals.clone().map(|x| (x - mean) * (x - mean));
    let std = (squares.sum::<f64>() / f64::from(count)).sqrt();
    let worst = totals.fold(f64::INFINITY, f64::min);
    let held = episodes.iter().filter(|episode| episode.holds(1000)).count();
    println!(
        "mean return of {count} episodes: {mean:.0} ± {std:.0}, the worst {worst:.0}, held {held}"
    );
    Ok(())
}
