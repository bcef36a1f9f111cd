//! The board of ICRA 2025: 60 s with resets at random. The score is the part above the line.

use std::array::from_fn;
use std::time::{Duration, Instant};

use acrobot::control::plan::{Cost, Knot, Plan, Planner, Problem};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::saturate;
use acrobot::task::Task;
use acrobot::{Fast, Params, State};

use crate::resets::Reset;
use crate::robot::Robot;
use crate::swing_up::plans;
use crate::task::{C1, LIMIT, RealAiGym};

/// Of the episode, of a reset, of planning, and from one decision to the next.
const STEPS: usize = 30_000;
const RESET: usize = 101;
const PLANNING: usize = 50;
const EVERY: usize = 5;
const RESETS: usize = 15;

/// Plays with these resets, or without any with those of the seed, and so many tries of each plan.
/// Returns the longest time of a plan, too.
pub fn play(seed: u64, resets: &[Reset], tries: u32) -> anyhow::Result<(Robot, Duration)> {
    let params: Params<f32> = Params { dt: EVERY as f64 * C1.dt, ..C1 }.cast();
    let mut problem = Problem::swing_up(params, LIMIT as f32)?;
    problem.cost = Cost { torque: 4e-3, arrival: 2.0, ..problem.cost };
    let mut planner = Planner::<Fast>::new(&problem)?;
    let (mut robot, mut rng) = (Robot::hanging(C1)?, Pcg64::new(seed));
    let (mut longest, mut sums, mut before) = (Duration::ZERO, [0.0; 2], None);
    for i in 1..=RESETS + 1 {
        let shift = if i > RESETS { 0.0 } else { uniform(&mut rng, -1.0, 1.0) / C1.dt };
        let end = (STEPS * i / (RESETS + 1)) as f64 + shift;
        let end = resets.get(i - 1).map_or(end, |[time, ..]| time / C1.dt).ceil() as usize;
        while robot.rows.len() < end {
            // There is no torque while the planner plans, from the state afterwards.
            let mut ahead = robot.clone();
            (0..PLANNING).try_for_each(|_| ahead.step([0.0; 2]))?;
            let began = Instant::now();
            let state = ahead.pendulum.state().cast();
            let knots = search(&mut planner, state, &mut rng, tries)?;
            let plan = Plan { knots, after: *planner.regulator().feedback() };
            longest = longest.max(began.elapsed());
            let mut torque = 0.0;
            for step in 0.. {
                let state = robot.pendulum.state();
                let [theta1, ..] = state.deviation_from(State::UPRIGHT);
                let has_fallen = step > 1000 && theta1.abs() > 0.5;
                if robot.rows.len() >= end || has_fallen {
                    break;
                }
                if step >= PLANNING && step % EVERY == 0 {
                    torque = plan.torque((step - PLANNING) / EVERY, state.cast()).into();
                }
                robot.step([0.0, torque])?;
            }
        }
        // The reset: a controller of both joints' positions, which compensates for gravity.
        let drawn = RealAiGym.draw(RealAiGym::RESET_BOUNDS, &mut rng).cast::<f64>();
        let goal = [drawn.theta1, drawn.theta2];
        let goal = resets.get(i - 1).map_or(goal, |[_, goal @ ..]| *goal);
        while i <= RESETS && robot.rows.len() < end + RESET {
            let state = robot.pendulum.state();
            let mut resting = robot.pendulum.clone();
            resting.set_state(State { dtheta1: 0.0, dtheta2: 0.0, ..state })?;
            let weights = resting.inverse_dynamics([0.0; 2])?.torques;
            let errors = [goal[0] - state.theta1, goal[1] - state.theta2];
            let last = before.replace(errors).unwrap_or(errors);
            robot.step(from_fn(|j| {
                sums[j] += errors[j];
                // RealAIGym's gains are for steps of 0.001 s.
                let rate = (errors[j] - last[j]) / 0.001;
                let wanted = 10.0 * errors[j] + 0.1 * 0.001 * sums[j] + rate;
                saturate(wanted, LIMIT) + weights[j]
            }))?;
        }
    }
    Ok((robot, longest))
}

/// The cheapest plan that ends upright; empty without any.
fn search(
    planner: &mut Planner<Fast>,
    start: State<f32>,
    rng: &mut Pcg64,
    tries: u32,
) -> anyhow::Result<Vec<Knot<f32>>> {
    const SIDE: u32 = 32;
    let mut best = (f64::INFINITY, Vec::new());
    for _ in 0..tries.div_ceil(SIDE) {
        for plan in plans(planner, start, rng, 60.0, SIDE)? {
            let end = plan.1.last().map(|knot| knot.state);
            if plan.0 < best.0 && end.is_some_and(|end| planner.regulator().holds_from(end)) {
                best = plan;
            }
        }
    }
    Ok(best.1)
}
