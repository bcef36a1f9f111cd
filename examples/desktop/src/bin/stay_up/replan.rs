//! Both tasks in real time: the acrobot differs from the model, measurements are noisy, and the
//! planner plans again every 0.1 s from what it measures, with 1 N m every second, on one core.

use std::time::{Duration, Instant};

use acrobot::arithmetic::Arithmetic;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::bound;
use acrobot::physics::control::difference;
use acrobot::{Acrobot, Fast, Params, State};
use controller::{Planner, Step};
use rayon::prelude::*;

use crate::search::Search;
use crate::{GYMNASIUM, RATE, STEPS, SWINGUP, TRIES, Task};

/// The planner plans again with so many iterations, until so few steps are left.
const ITERATIONS: u32 = 12;
const LEAST: usize = 20;
/// The part of the motor's torque that plans use. The rest corrects deviations.
const PLANNED: f32 = 0.95;
/// The first plan takes this part of the search of `stay_up`.
const PART: usize = 4;

/// The largest error of masses and lengths, and noise of angles, rad, and of velocities, rad/s.
type Case = (f64, [f64; 2]);
const CASES: [Case; 6] = [
    (0.0, [0.0, 0.0]),
    (0.01, [0.0, 0.0]),
    (0.02, [0.0, 0.0]),
    (0.05, [0.0, 0.0]),
    (0.0, [1e-3, 1e-2]),
    (0.02, [1e-4, 1e-3]),
];

/// The return, whether the acrobot is upright in the last tenth of the time, and the time that
/// planning took.
struct Episode {
    total: f64,
    held: bool,
    took: Duration,
}

/// Plays one episode, which begins with a plan. `planner` makes another one where a plan ends and
/// the regulator fails.
fn play<A: Arithmetic<Scalar = f32>>(
    mut acrobot: Acrobot<A>,
    planner: &mut Planner<A>,
    mut plan: Vec<Step<f32>>,
    (limit, steps, every): (f32, usize, usize),
    (error, noise): Case,
    rng: &mut Pcg64,
) -> anyhow::Result<Episode> {
    let params = *acrobot.params();
    let mut wrong = |x: f32| x * (1.0 + uniform(rng, -error, error)) as f32;
    acrobot.set_params(Params {
        mass1: wrong(params.mass1),
        mass2: wrong(params.mass2),
        length1: wrong(params.length1),
        center_of_mass2: wrong(params.center_of_mass2),
        ..params
    })?;
    let (mut total, mut upright, mut took) = (0.0, 0, Duration::ZERO);
    let (mut memory, mut next) = ([Step::EMPTY; STEPS], 0);
    for i in 0..steps {
        let [angle, velocity] =
            noise.map(|most| [(); 2].map(|()| uniform(rng, -most, most) as f32));
        let mut state = acrobot.state();
        state.theta1 += angle[0];
        state.theta2 += angle[1];
        state.dtheta1 += velocity[0];
        state.dtheta2 += velocity[1];
        let before = Instant::now();
        let torque = if planner.catches(state) {
            plan.clear();
            planner
                .regulator()
                .torque(difference(state, State::UPRIGHT))
        } else {
            if next >= plan.len() {
                let found = planner.plan(state, TRIES, rng, &mut memory);
                plan = found.map_or(vec![Step::open(0.0); every], |plan| plan.to_vec());
                next = 0;
            } else if i % every == 0 && plan.len() - next > LEAST {
                planner.improve(state, ITERATIONS, &mut plan[next..])?;
            }
            next += 1;
            plan.get(next - 1).map_or(0.0, |step| step.follow(state))
        };
        took += before.elapsed();
        total += f64::from(acrobot.step_torque(bound(torque, limit))?.reward);
        let [theta1, theta2, ..] = difference(acrobot.state(), State::UPRIGHT);
        if theta1.abs().max(theta2.abs()) > 0.1 {
            upright = i + 1;
        }
    }
    let held = upright <= steps / 10 * 9;
    Ok(Episode { total, held, took })
}

fn swing_up(seed: u64, case: Case) -> anyhow::Result<Episode> {
    let acrobot = Acrobot::<Task>::new(seed);
    let before = Instant::now();
    let mut plan = Search::new(acrobot.clone(), PLANNED * SWINGUP, seed)?.run(PART)?;
    // Upright steps at the end, so that the approach, too, is planned again.
    plan.extend([Step::open(0.0); 80]);
    let mut planner = Planner::new(Params::SWINGUP, PLANNED * SWINGUP)?;
    planner.improve(acrobot.state(), 100, &mut plan)?;
    let searched = before.elapsed();
    let task = (SWINGUP, Task::TASK.limit().get() as usize, 10);
    let rng = &mut Pcg64::new(seed);
    let episode = play(acrobot, &mut planner, plan, task, case, rng)?;
    let took = searched + episode.took;
    Ok(Episode { took, ..episode })
}

/// Gymnasium's acrobot for 45 s: the last tenth of the time begins after 40 s.
fn gymnasium(seed: u64, case: Case) -> anyhow::Result<Episode> {
    let params = Params {
        dt: 1.0 / RATE as f32,
        ..Params::DEFAULT
    };
    let acrobot = Acrobot::<Fast>::with_params(seed, params)?;
    let mut planner = Planner::new(params, PLANNED * GYMNASIUM)?;
    let task = (GYMNASIUM, 45 * RATE, RATE);
    play(
        acrobot,
        &mut planner,
        Vec::new(),
        task,
        case,
        &mut Pcg64::new(seed),
    )
}

/// Prints a table of each task.
pub fn tables(episodes: u32) -> anyhow::Result<()> {
    table("2 N m with friction, 10 s", episodes, swing_up)?;
    table("1 N m without friction, 45 s", episodes, gymnasium)
}

fn table(
    name: &str,
    episodes: u32,
    play: fn(u64, Case) -> anyhow::Result<Episode>,
) -> anyhow::Result<()> {
    println!("| {name} | held of {episodes} | mean return | planning, most s |\n|---|---|---|---|");
    for case in CASES {
        let seeds = (0..u64::from(episodes)).into_par_iter();
        let played = seeds.map(|seed| play(seed, case));
        let played: Vec<Episode> = played.collect::<anyhow::Result<_>>()?;
        let held = played.iter().filter(|episode| episode.held).count();
        let mean = played.iter().map(|episode| episode.total).sum::<f64>() / f64::from(episodes);
        let most = played
            .iter()
            .map(|episode| episode.took)
            .max()
            .unwrap_or_default();
        let (error, [angle, velocity]) = case;
        println!(
            "| errors of {:.0} %, noise of {:.1} mrad and {:.0} mrad/s | {held} | {mean:.0} | {:.1} |",
            error * 100.0,
            angle * 1e3,
            velocity * 1e3,
            most.as_secs_f64()
        );
    }
    Ok(())
}
