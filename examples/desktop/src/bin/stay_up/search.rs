//! The search for the best plan of a swing-up.
//!
//! The planner finds only the best plan near a first guess. So the search goes on from the best
//! plans: it changes a few torques of a plan, removes some of its steps or repeats them, and plans
//! again from there, many plans side by side.

use std::ops::Range;

use acrobot::arithmetic::Damped;
use acrobot::control::plan::{Knot, Plan, Planner, Problem};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::saturate;
use acrobot::task::Swingup;
use acrobot::{Acrobot, Fast, Params, State};

use crate::Episode;

const GUESSES: usize = 128;
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
/// Planning again takes so many iterations, and so many rounds until a plan holds.
const AGAIN: u32 = 12;
const TRIES: usize = 2;

pub type Knots = Vec<Knot<f32>>;

#[derive(Clone)]
pub struct Search {
    pub acrobot: Acrobot<Damped<Fast>, Swingup>,
    pub planner: Planner<Damped<Fast>>,
    /// The largest torque of plans, N m.
    limit: f32,
    /// The steps of first guesses, and those of an episode.
    lengths: Range<usize>,
    pub steps: usize,
    pub rng: Pcg64,
}

impl Search {
    /// Searches from the acrobot's state.
    pub fn new(
        acrobot: Acrobot<Damped<Fast>, Swingup>,
        limit: f32,
        lengths: Range<usize>,
        steps: usize,
        seed: u64,
    ) -> anyhow::Result<Self> {
        let mut problem = Problem::swing_up(*acrobot.params(), limit)?;
        // Each step upright earns more than a plan needs to hold.
        problem.cost.torque *= 1.4;
        problem.cost.below *= 1.75;
        let planner = Planner::new(&problem)?;
        Ok(Self { acrobot, planner, limit, lengths, steps, rng: Pcg64::new(seed) })
    }

    /// Improves plans, and simulates an episode that follows each.
    fn improve(
        &mut self,
        iterations: u32,
        mut plans: Vec<Knots>,
    ) -> anyhow::Result<Vec<(Episode, Knots)>> {
        let starts = vec![self.acrobot.state(); plans.len()];
        self.planner.improve_each(&starts, iterations, &mut plans)?;
        let after = *self.planner.regulator().feedback();
        let play = |knots: Knots| {
            let plan = Plan { knots: &*knots, after };
            Ok((Episode::play(self.acrobot.clone(), &plan, self.limit, self.steps)?, knots))
        };
        plans.into_iter().map(play).collect()
    }

    fn guess(&mut self) -> anyhow::Result<Knots> {
        let mut plan = vec![Knot::EMPTY; self.draw(self.lengths.start, self.lengths.end)];
        self.planner.guess(self.acrobot.state(), &mut self.rng, &mut plan)?;
        Ok(plan)
    }

    /// A whole number from `low` up to but not including `high`.
    fn draw(&mut self, low: usize, high: usize) -> usize {
        uniform(&mut self.rng, low as f64, high as f64) as usize
    }

    /// A changed copy of a plan.
    fn change(&mut self, plan: &[Knot<f32>]) -> Knots {
        let mut torques: Vec<f32> = plan.iter().map(|knot| knot.torque).collect();
        let end = self.draw(1, torques.len() + 1);
        let window = end - self.draw(1, WINDOW + 1).min(end)..end;
        match self.draw(0, 3) {
            0 => {
                let push = (f64::from(self.limit) * uniform(&mut self.rng, -1.0, 1.0)) as f32;
                for torque in &mut torques[window] {
                    *torque = saturate(*torque + push, self.limit);
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

    /// The best plan of a part of the search.
    pub fn run(&mut self, part: usize) -> anyhow::Result<(Episode, Knots)> {
        let mut guesses = Vec::new();
        for _ in 0..GUESSES / part {
            guesses.push(self.guess()?);
        }
        guesses.sort_by_key(Vec::len); // those side by side have similar lengths
        let starts = vec![self.acrobot.state(); guesses.len()];
        let costs = self.planner.improve_each(&starts, FEW, &mut guesses)?;
        let mut guesses: Vec<_> = costs.into_iter().zip(guesses).collect();
        guesses.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        guesses.truncate(KEPT / part.min(4));
        let mut best = self.improve(ALL, guesses.into_iter().map(|(_, plan)| plan).collect())?;
        let rounds = ROUNDS / part;
        for round in 0..rounds {
            best.sort_by(|(a, _), (b, _)| b.total.total_cmp(&a.total));
            best.truncate(if round < rounds / 2 { CHANGED } else { 1 });
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
        Ok(best.swap_remove(0))
    }

    /// Plans again from a state, with other parameters and so many steps left: improves the rest of
    /// a plan, and if that does not hold, tries others.
    pub fn again(
        &mut self,
        state: State<f32>,
        params: Params<f32>,
        steps: usize,
        rest: Knots,
    ) -> anyhow::Result<Knots> {
        self.acrobot.set_params(params)?;
        self.acrobot.set_state(state)?;
        self.planner = Planner::new(&Problem::swing_up(params, self.limit)?)?;
        self.steps = steps;
        let mut best = self.improve(AGAIN, vec![rest])?.swap_remove(0);
        for _ in 0..TRIES {
            if best.0.holds(steps) {
                break;
            }
            let mut plans = Vec::new();
            for i in 0..CHANGES {
                plans.push(if i % 2 == 0 { self.guess()? } else { self.change(&best.1) });
            }
            for other in self.improve(ITERATIONS, plans)? {
                if other.0.total > best.0.total {
                    best = other;
                }
            }
        }
        Ok(best.1)
    }
}
