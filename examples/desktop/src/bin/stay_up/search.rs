//! The search for the best plan of dm_control's swing-up.
//!
//! The planner finds only the best plan near a first guess. So the search goes on from the best
//! plans: it changes a few torques of a plan, removes some of its steps or repeats them, and plans
//! again from there.

use acrobot::arithmetic::Arithmetic;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::bound;
use acrobot::{Acrobot, Params};
use controller::{Planner, Step};

use crate::{Episode, SWINGUP, Task};

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
/// The search for the best plan from one initial state.
pub struct Search {
    acrobot: Acrobot<Task>,
    planner: Planner<Task>,
    rng: Pcg64,
}

impl Search {
    /// Searches from the acrobot's state, with plans of a largest torque, N m.
    pub fn new(acrobot: Acrobot<Task>, limit: f32, seed: u64) -> anyhow::Result<Self> {
        Ok(Self {
            acrobot,
            planner: Planner::new(Params::SWINGUP, limit)?,
            rng: Pcg64::new(seed),
        })
    }

    /// An episode that follows the plan.
    pub fn episode(&self, plan: &[Step<f32>]) -> anyhow::Result<Episode> {
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

    /// The best plan of a part of the search.
    pub fn run(&mut self, part: usize) -> anyhow::Result<Vec<Step<f32>>> {
        let start = self.acrobot.state();
        let mut guesses = Vec::new();
        for _ in 0..GUESSES / part {
            let mut plan = vec![Step::EMPTY; self.draw(SHORTEST, LONGEST)];
            self.planner.guess(start, &mut self.rng, &mut plan)?;
            guesses.push((self.planner.improve(start, FEW, &mut plan)?, plan));
        }
        guesses.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let mut best = Vec::new();
        for (_, mut plan) in guesses.into_iter().take(KEPT / part) {
            self.planner.improve(start, ALL, &mut plan)?;
            best.push((self.episode(&plan)?.total, plan));
        }
        for i in 0..CHANGES / part {
            best.sort_by(|(a, _), (b, _)| b.total_cmp(a));
            best.truncate(if i < CHANGES / part / 2 { CHANGED } else { 1 });
            let len = best.len();
            let (total, plan) = &mut best[i % len];
            let mut changed = self.change(plan);
            self.planner.improve(start, ITERATIONS, &mut changed)?;
            let episode = self.episode(&changed)?;
            if episode.total > *total {
                (*total, *plan) = (episode.total, changed);
            }
        }
        Ok(best.swap_remove(0).1)
    }
}
