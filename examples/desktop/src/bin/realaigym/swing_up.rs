//! The boards of performance: a swing-up from hanging, 10 s long.
//!
//! A planner minimizes a sum, and a score is none. So the weights of each plan are the slopes of
//! the score at the plan before.

use acrobot::control::{Cost, Knot, Planner};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::{Params, Portable, State};

use crate::robot::Robot;
use crate::score::{Costs, Version, costs};
use crate::task::LIMIT;

const SECONDS: f64 = 10.0;
/// Costs of a good swing-up, for the first plans.
const GOOD: Costs = [1.0, 8.0, 2.0, 1.0, 1.8, 0.01, 90.0];
/// So many of the first plans are improved further.
const KEPT: usize = 16;
const ITERATIONS: u32 = 40;
/// Their end after the swing-up, s.
const UPRIGHT: f64 = 1.5;

type Played = (f64, Costs, Robot);

/// The best swing-up of so many first guesses: its score and costs.
pub fn search(version: Version, params: Params, guesses: u32) -> anyhow::Result<Played> {
    let play = |planner: &Planner<Portable>, plan: &[Knot<f64>]| -> anyhow::Result<Played> {
        let mut robot = Robot::hanging(params)?;
        while robot.time < SECONDS {
            robot.step([0.0, planner.follow(plan, robot.rows.len(), robot.pendulum.state())])?;
        }
        let (costs, _) = costs(&params, &robot.rows);
        Ok((version.score(&costs), costs, robot))
    };
    let mut rng = Pcg64::new(1);
    let mut plans: Vec<_> = (0..guesses).map(|_| guess(&mut rng)).collect();
    plans.sort_by_key(Vec::len); // those side by side have similar lengths
    let mut planner = planner(version, params, LIMIT, &GOOD)?;
    planner.improve_all(State::HANGING, 2 * ITERATIONS, &mut plans)?;
    let played = plans.iter().map(|plan| play(&planner, plan));
    let mut found = played.collect::<anyhow::Result<Vec<_>>>()?;
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(KEPT);
    for best in &mut found {
        let steps = ((best.1[0] + UPRIGHT) / params.dt) as usize;
        let rows = best.2.rows.iter().take(steps);
        let mut plan: Vec<_> = rows.map(|row| Knot::open(row.torques[1])).collect();
        // Version 1 counts the largest torque, so each plan gets less, until that is too little.
        let (mut limit, mut less) = (LIMIT, 0.95);
        while best.0 > 0.0 && less < 0.999 {
            let mut planner = self::planner(version, params, limit, &best.1)?;
            let mut other = plan.clone();
            planner.improve(State::HANGING, ITERATIONS, &mut other)?;
            let played = play(&planner, &other)?;
            if played.0 > best.0 + 1e-5 {
                (*best, plan) = (played, other);
            } else {
                less = f64::sqrt(less);
            }
            if version == Version::V1 {
                limit = less * best.1[2];
            }
        }
    }
    let best = found.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
    best.ok_or_else(|| anyhow::anyhow!("no guess"))
}

/// Random torques, each held for a random time.
fn guess(rng: &mut Pcg64) -> Vec<Knot<f64>> {
    let mut draw = |low, high| uniform(rng, low, high);
    let (steps, held, most) = (draw(400.0, 800.0), draw(25.0, 200.0), draw(0.1, 0.8) * LIMIT);
    let mut torque = 0.0;
    let knot = |i| {
        if i % held as usize == 0 {
            torque = draw(-most, most);
        }
        Knot::open(torque)
    };
    (0..steps as usize).map(knot).collect()
}

fn planner(
    version: Version,
    params: Params,
    limit: f64,
    costs: &Costs,
) -> anyhow::Result<Planner<Portable>> {
    let slope = |i: usize| {
        let (mut more, part) = (*costs, 1e-4 * costs[i]);
        more[i] += part;
        (version.score(costs) - version.score(&more)) / part
    };
    // Smoothness is the root of a mean square.
    let steps = SECONDS / params.dt;
    let cost = Cost {
        angles: [1e-3; 2],
        velocities: [slope(6); 2],
        torque: slope(4),
        torque_change: slope(5) / (2.0 * steps * costs[5].max(0.002)),
        power: slope(1),
        below: slope(0),
        height: 0.9 * (params.length1 + params.length2),
        margin: 0.015,
        arrival: 3.0,
    };
    Ok(Planner::with_cost(params, limit, cost)?)
}
