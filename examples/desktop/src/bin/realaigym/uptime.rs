//! The board of ICRA 2025: 60 s with resets at random, of which the time above the line counts.

use std::time::{Duration, Instant};

use acrobot::control::{Cost, Knot, Planner, difference};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::saturate;
use acrobot::task::Task;
use acrobot::{Fast, Params, State};

use crate::robot::Robot;
use crate::task::{C1, LIMIT, RealAiGym};

pub const SECONDS: f64 = 60.0;
const RESETS: u32 = 15;

/// Steps between two decisions, and steps of planning: 0.1 s.
const EVERY: usize = 5;
const PLANNING: usize = 50;
/// Tries side by side.
const SIDE: u32 = 32;
const ITERATIONS: u32 = 60;

/// So many tries of a plan, or as many as this time allows.
#[derive(Clone, Copy)]
pub enum Budget {
    Tries(u32),
    Time(Duration),
}

/// Plays with the resets of a seed. Returns the longest time of a plan, too.
pub fn play(seed: u64, budget: Budget) -> anyhow::Result<(Robot, Duration)> {
    let params: Params<f32> = Params { dt: EVERY as f64 * C1.dt, ..C1 }.cast();
    let cost = Cost {
        velocities: [1e-3; 2],
        torque: 2e-3,
        torque_change: 2e-5,
        below: 1.0,
        height: 0.45,
        margin: 0.015,
        arrival: 1.0,
        ..Cost::new(&params)
    };
    let mut planner = Planner::<Fast>::with_cost(params, LIMIT as f32, cost)?;
    let (mut robot, mut rng) = (Robot::hanging(C1)?, Pcg64::new(seed));
    let goals = [(); RESETS as usize].map(|()| RealAiGym.draw(RealAiGym::RESET_BOUNDS, &mut rng));
    let mut goals = goals.into_iter();
    let (mut longest, mut reset) = (Duration::ZERO, Reset::default());
    for i in 1..=RESETS + 1 {
        let next = SECONDS / f64::from(RESETS + 1) * f64::from(i);
        let end = if i > RESETS { next } else { next + uniform(&mut rng, -1.0, 1.0) };
        while robot.time < end {
            // The elbow brakes while the planner plans from the state afterwards.
            let brake =
                |robot: &mut Robot| robot.step([0.0, -0.1 * robot.pendulum.state().dtheta2]);
            let mut ahead = Robot { rows: Vec::new(), ..robot.clone() };
            (0..PLANNING).try_for_each(|_| brake(&mut ahead))?;
            let before = Instant::now();
            let plan = search(&mut planner, ahead.pendulum.state().cast(), &mut rng, budget)?;
            longest = longest.max(before.elapsed());
            for _ in 0..PLANNING {
                if robot.time < end {
                    brake(&mut robot)?;
                }
            }
            for knot in 0.. {
                let state = robot.pendulum.state();
                let [theta1, _, dtheta1, _] = difference(state, State::UPRIGHT);
                let has_fallen = theta1.abs() > 0.5 || dtheta1.abs() > 8.0;
                if robot.time >= end || knot > plan.len() + 5 && has_fallen {
                    break;
                }
                let torque = planner.follow(&plan, knot, state.cast());
                for _ in 0..EVERY {
                    if robot.time < end {
                        robot.step([0.0, torque.into()])?;
                    }
                }
            }
        }
        if let Some(goal) = goals.next() {
            while robot.time - end < 0.2 {
                let torques = reset.torques(&robot, goal);
                robot.step(torques)?;
            }
        }
    }
    Ok((robot, longest))
}

/// The cheapest plan that ends upright, if there is one.
fn search(
    planner: &mut Planner<Fast>,
    start: State<f32>,
    rng: &mut Pcg64,
    budget: Budget,
) -> anyhow::Result<Vec<Knot<f32>>> {
    let (began, mut tries, mut best) = (Instant::now(), 0, (f32::INFINITY, Vec::new()));
    loop {
        let mut plans = Vec::new();
        for _ in 0..SIDE {
            let mut plan = vec![Knot::EMPTY; uniform(rng, 60.0, 200.0) as usize];
            planner.guess(start, rng, &mut plan)?;
            plans.push(plan);
        }
        plans.sort_by_key(Vec::len); // those side by side have similar lengths
        let costs = planner.improve_all(start, ITERATIONS, &mut plans)?;
        for (cost, plan) in costs.into_iter().zip(plans) {
            let end = plan[plan.len() - 1].state;
            if let Ok(cost) = cost
                && cost < best.0
                && planner.catches(end)
            {
                best = (cost, plan);
            }
        }
        tries += SIDE;
        let is_over = match budget {
            Budget::Tries(most) => tries >= most,
            Budget::Time(most) => began.elapsed() / tries * (tries + SIDE) > most,
        };
        if is_over {
            return Ok(best.1);
        }
    }
}

/// RealAIGym's reset: a controller of both joints' positions, with its gains and its step.
#[derive(Default)]
struct Reset {
    /// Of the angles, rad, in the step before, and their sums.
    errors: Option<[f64; 2]>,
    sums: [f64; 2],
}

impl Reset {
    fn torques(&mut self, robot: &Robot, goal: State<f32>) -> [f64; 2] {
        let (state, params) = (robot.pendulum.state(), robot.pendulum.params());
        let errors = [f64::from(goal.theta1) - state.theta1, f64::from(goal.theta2) - state.theta2];
        let before = self.errors.replace(errors).unwrap_or(errors);
        // Compensates for gravity.
        let [[x1, _], [x2, _]] = robot.pendulum.positions();
        let moment2 = params.mass2 * params.center_of_mass2 / params.length2 * (x2 - x1);
        let moment1 = params.mass1 * params.center_of_mass1 / params.length1 + params.mass2;
        let weights = [moment1 * x1 + moment2, moment2].map(|moment| params.gravity * moment);
        std::array::from_fn(|j| {
            self.sums[j] += errors[j];
            let rate = (errors[j] - before[j]) / 0.001;
            let wanted = 10.0 * errors[j] + 0.1 * 0.001 * self.sums[j] + rate;
            saturate(wanted, LIMIT) + weights[j]
        })
    }
}
