//! The boards of performance: a swing-up from hanging in 10 s.
//!
//! A planner minimizes a sum, and a score is none. So the weights of each plan are the slopes of
//! the score at the plan before.

use std::array::from_fn;

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::control::plan::{Cost, Knot, Plan, Planner, Problem};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::{Params, Portable, State};
use anyhow::Context;

use crate::robot::Robot;
use crate::score::{Costs, Version, costs};
use crate::task::{HISTORY_SAC, LIMIT};

const STEPS: usize = 5000;
const ITERATIONS: u32 = 60;

/// Its cost comes first.
type Improved<S> = (f64, Vec<Knot<S>>);

/// The best swing-up of so many guesses, and its costs.
pub fn search(version: Version, params: Params, tries: u32) -> anyhow::Result<(Costs, Robot)> {
    let score = |played: &(Costs, Robot)| version.score(played.0);
    let planner = |limit, costs| {
        let problem = Problem::swing_up(params, limit)?;
        Planner::new(&Problem { cost: weigh(version, problem, costs), ..problem })
    };
    let play = |planner: &Planner<Portable>, knots: &[Knot<f64>]| -> anyhow::Result<_> {
        let plan = Plan { knots, after: *planner.regulator().feedback() };
        let mut robot = Robot::hanging(params)?;
        for step in 0..STEPS {
            robot.step([0.0, plan.torque(step, robot.pendulum.state())])?;
        }
        Ok((costs(params, &robot.rows)?, robot))
    };
    let (mut first, mut found) = (planner(LIMIT, HISTORY_SAC)?, Vec::new());
    for (_, plan) in plans(&mut first, State::HANGING, &mut Pcg64::new(1), 300.0, tries)? {
        found.push(play(&first, &plan)?);
    }
    found.sort_by(|a, b| score(b).total_cmp(&score(a)));
    found.truncate(16);
    for best in &mut found {
        // The plan goes on for 1.5 s upright.
        let rows = best.1.rows.iter().take(((best.0[0] + 1.5) / params.dt) as usize);
        let mut plan: Vec<_> = rows.map(|(_, torques)| Knot::open(torques[1])).collect();
        // Version 1 counts the largest torque, so each plan has less, until that is too little.
        let (mut limit, mut less) = (LIMIT, 0.95);
        while score(best) > 0.0 && less < 0.999 {
            let (mut planner, mut other) = (planner(limit, best.0)?, plan.clone());
            planner.improve(State::HANGING, ITERATIONS, &mut other)?;
            let played = play(&planner, &other)?;
            if score(&played) > score(best) + 1e-5 {
                (*best, plan) = (played, other);
            } else {
                less = f64::sqrt(less);
            }
            if version == Version::V1 {
                limit = less * best.0[2];
            }
        }
    }
    found.into_iter().max_by(|a, b| score(a).total_cmp(&score(b))).context("no tries")
}

fn weigh(version: Version, Problem { params, cost, .. }: Problem, costs: Costs) -> Cost {
    let slope = |i: usize| {
        let (mut more, part) = (costs, 1e-4 * costs[i]);
        more[i] += part;
        (version.score(costs) - version.score(more)) / part
    };
    // The standard deviation is the root of a mean square.
    let square = 2.0 * STEPS as f64 * costs[5].max(0.002);
    Cost {
        angles: [1e-3; 2],
        q: from_fn(|i| from_fn(|j| if i == j && i >= 2 { slope(6) } else { 0.0 })),
        torque: slope(4),
        torque_change: slope(5) / square,
        power: slope(1),
        below: slope(0),
        height: 0.9 * (params.length1 + params.length2),
        margin: 0.015,
        arrival: 3.0,
        ..cost
    }
}

/// Improves random guesses, one to three times as long as so many steps.
pub fn plans<A: Arithmetic>(
    planner: &mut Planner<A>,
    start: State<A::Scalar>,
    rng: &mut Pcg64,
    steps: f64,
    tries: u32,
) -> anyhow::Result<Vec<Improved<A::Scalar>>> {
    let mut plans = Vec::new();
    for _ in 0..tries {
        let mut plan = vec![Knot::EMPTY; uniform(rng, steps, 3.0 * steps) as usize];
        planner.guess(start, rng, &mut plan)?;
        plans.push(plan);
    }
    plans.sort_by_key(Vec::len); // those side by side have similar lengths
    let starts = vec![start; plans.len()];
    let costs = planner.improve_each(&starts, ITERATIONS, &mut plans)?;
    Ok(costs.into_iter().map(Real::to_f64).zip(plans).collect())
}
