//! The search for the best plan of a swing-up.
//!
//! The planner finds only the best plan near a first guess. So the search goes on from the best
//! plans: it changes a few torques of a plan, removes some of its steps or repeats them, and plans
//! again from there.

use std::ops::Range;

use acrobot::arithmetic::Damped;
use acrobot::control::{Knot, Planner};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::saturate;
use acrobot::task::Swingup;
use acrobot::{Acrobot, Fast, Params, State};

use crate::Episode;

const GUESSES: usize = 120;
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
/// Planning again takes so many iterations, and so many tries until a plan holds.
const AGAIN: u32 = 12;
const TRIES: usize = 4;

pub type Plan = Vec<Knot<f32>>;

/// The search for the best plan from a state.
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
        let planner = Planner::new(*acrobot.params(), limit)?;
        Ok(Self { acrobot, planner, limit, lengths, steps, rng: Pcg64::new(seed) })
    }

    /// Improves a plan, and simulates an episode that follows it.
    fn improve(&mut self, iterations: u32, mut plan: Plan) -> anyhow::Result<(Episode, Plan)> {
        self.planner.improve(self.acrobot.state(), iterations, &mut plan)?;
        let acrobot = self.acrobot.clone();
        Ok((Episode::play(acrobot, &self.planner, &plan, self.limit, self.steps)?, plan))
    }

    fn guess(&mut self) -> anyhow::Result<Plan> {
        let mut plan = vec![Knot::EMPTY; self.draw(self.lengths.start, self.lengths.end)];
        self.planner.guess(self.acrobot.state(), &mut self.rng, &mut plan)?;
        Ok(plan)
    }

    /// A whole number from `low` up to but not including `high`.
    fn draw(&mut self, low: usize, high: usize) -> usize {
        uniform(&mut self.rng, low as f64, high as f64) as usize
    }

    /// A changed copy of a plan.
    fn change(&mut self, plan: &[Knot<f32>]) -> Plan {
        let mut torques: Vec<f32> = plan.iter().map(|step| step.torque).collect();
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
    pub fn run(&mut self, part: usize) -> anyhow::Result<(Episode, Plan)> {
        let start = self.acrobot.state();
        let mut guesses = Vec::new();
        for _ in 0..GUESSES / part {
            let mut plan = self.guess()?;
            guesses.push((self.planner.improve(start, FEW, &mut plan)?, plan));
        }
        guesses.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let mut best = Vec::new();
        for (_, plan) in guesses.into_iter().take(KEPT / part) {
            best.push(self.improve(ALL, plan)?);
        }
        for i in 0..CHANGES / part {
            best.sort_by(|(a, _), (b, _)| b.total.total_cmp(&a.total));
            best.truncate(if i < CHANGES / part / 2 { CHANGED } else { 1 });
            let len = best.len();
            let old = &mut best[i % len];
            let changed = self.change(&old.1);
            let changed = self.improve(ITERATIONS, changed)?;
            if changed.0.total > old.0.total {
                *old = changed;
            }
        }
        Ok(best.swap_remove(0))
    }

    /// Plans again from a state, with other parameters and so many steps left: improves the rest of
    /// a plan, and if that does not hold, tries others.
    pub fn again(
        &mut self,
        state: State<f32>,
        params: Params<f32>,
        steps: usize,
        rest: Plan,
    ) -> anyhow::Result<Plan> {
        self.acrobot.set_params(params)?;
        self.acrobot.set_state(state)?;
        self.planner = Planner::new(params, self.limit)?;
        self.steps = steps;
        let mut best = self.improve(AGAIN, rest)?;
        for i in 0..TRIES {
            if best.0.holds(steps) {
                break;
            }
            let other = if i % 2 == 0 { self.guess()? } else { self.change(&best.1) };
            let other = self.improve(ITERATIONS, other)?;
            if other.0.total > best.0.total {
                best = other;
            }
        }
        Ok(best.1)
    }
}
