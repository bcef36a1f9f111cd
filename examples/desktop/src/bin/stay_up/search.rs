//! The search for the best plan of a swing-up.
//!
//! The planner finds only the best plan near a first guess. So the search goes on from the best
//! plans: it changes a few torques of a plan, removes some of its steps or repeats them, and plans
//! again from there, many plans side by side.

use acrobot::arithmetic::Damped;
use acrobot::control::{Knot, Planner};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::saturate;
use acrobot::task::Swingup;
use acrobot::{Acrobot, Fast};

use crate::Episode;

/// The largest torque, N m, and the steps of an episode.
const LIMIT: f32 = 2.0;
const STEPS: usize = 1000;
/// First guesses, and their steps.
const GUESSES: usize = 128;
const LENGTHS: [usize; 2] = [150, 600];
/// After a few iterations the best of them are planned until no iteration helps.
const FEW: u32 = 25;
const ALL: u32 = 150;
const KEPT: usize = 16;
/// In each round the best plans are changed, later only the best one, with so many iterations.
const ROUNDS: usize = 20;
const CHANGED: usize = 4;
const CHANGES: usize = 16;
const ITERATIONS: u32 = 50;
/// The most steps that a change is about.
const WINDOW: usize = 30;

type Plan = Vec<Knot<f32>>;

pub struct Search {
    acrobot: Acrobot<Damped<Fast>, Swingup>,
    planner: Planner<Damped<Fast>>,
    rng: Pcg64,
}

impl Search {
    /// Searches from the initial state of a seed.
    pub fn new(seed: u64) -> anyhow::Result<Self> {
        let acrobot = Acrobot::new(seed);
        let planner = Planner::new(*acrobot.params(), LIMIT)?;
        Ok(Self { acrobot, planner, rng: Pcg64::new(seed) })
    }

    /// Improves plans, and simulates an episode that follows each.
    fn improve(
        &mut self,
        iterations: u32,
        mut plans: Vec<Plan>,
    ) -> anyhow::Result<Vec<(Episode, Plan)>> {
        self.planner.improve_all(self.acrobot.state(), iterations, &mut plans)?;
        let play = |plan: Plan| {
            let acrobot = self.acrobot.clone();
            Ok((Episode::play(acrobot, &self.planner, &plan, LIMIT, STEPS)?, plan))
        };
        plans.into_iter().map(play).collect()
    }

    /// A whole number from `low` up to but not including `high`.
    fn draw(&mut self, low: usize, high: usize) -> usize {
        uniform(&mut self.rng, low as f64, high as f64) as usize
    }

    /// A changed copy of a plan.
    fn change(&mut self, plan: &[Knot<f32>]) -> Plan {
        let mut torques: Vec<f32> = plan.iter().map(|knot| knot.torque).collect();
        let end = self.draw(1, torques.len() + 1);
        let window = end - self.draw(1, WINDOW + 1).min(end)..end;
        match self.draw(0, 3) {
            0 => {
                let push = (f64::from(LIMIT) * uniform(&mut self.rng, -1.0, 1.0)) as f32;
                for torque in &mut torques[window] {
                    *torque = saturate(*torque + push, LIMIT);
                }
            }
            1 if torques.len() > 2 * WINDOW => drop(torques.drain(window)),
            _ => {
                let again = torques[window].to_vec();
                torques.splice(end..end, again);
            }
        }
        torques.into_iter().map(Knot::open).collect()
    }

    /// The episode of the best plan.
    pub fn run(&mut self) -> anyhow::Result<Episode> {
        let mut guesses = Vec::new();
        for _ in 0..GUESSES {
            let mut plan = vec![Knot::EMPTY; self.draw(LENGTHS[0], LENGTHS[1])];
            self.planner.guess(self.acrobot.state(), &mut self.rng, &mut plan)?;
            guesses.push(plan);
        }
        guesses.sort_by_key(Vec::len); // those side by side have similar lengths
        let costs = self.planner.improve_all(self.acrobot.state(), FEW, &mut guesses)?;
        let mut guesses: Vec<_> = costs.into_iter().zip(guesses).collect();
        guesses.sort_by(|(a, _), (b, _)| value(a).total_cmp(&value(b)));
        guesses.truncate(KEPT);
        let mut best = self.improve(ALL, guesses.into_iter().map(|(_, plan)| plan).collect())?;
        for round in 0..ROUNDS {
            best.sort_by(|(a, _), (b, _)| b.total.total_cmp(&a.total));
            best.truncate(if round < ROUNDS / 2 { CHANGED } else { 1 });
            let plans = (0..CHANGES).map(|i| self.change(&best[i % best.len()].1)).collect();
            let changed = self.improve(ITERATIONS, plans)?;
            let len = best.len();
            for (i, changed) in changed.into_iter().enumerate() {
                if changed.0.total > best[i % len].0.total {
                    best[i % len] = changed;
                }
            }
        }
        best.sort_by(|(a, _), (b, _)| b.total.total_cmp(&a.total));
        Ok(best.swap_remove(0).0)
    }
}

/// The cost of a plan; infinite where the numbers overflow.
fn value<E>(cost: &Result<f32, E>) -> f32 {
    *cost.as_ref().unwrap_or(&f32::INFINITY)
}
