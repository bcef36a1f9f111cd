//! Both tasks in real time: the acrobot differs from the model, measurements are noisy, and the
//! planner plans again from estimates, every 0.1 s, with 1 N m every 0.5 s. Time stands still while
//! it plans.

use std::array::from_fn;
use std::time::{Duration, Instant};

use acrobot::arithmetic::Damped;
use acrobot::control::{Estimator, Knot, Noise};
use acrobot::numpy::uniform;
use acrobot::physics::saturate;
use acrobot::{Acrobot, Fast, Params, Portable};
use rayon::prelude::*;

use crate::search::{Plan, Search};
use crate::{Episode, GYMNASIUM, LENGTHS, RATE, STEPS, SWINGUP};

/// The part of the motor's torque that plans use. The rest corrects deviations.
const PLANNED: f32 = 0.95;
/// Upright steps at the end of a plan, so that the approach, too, is planned again.
const UPRIGHT: [Knot<f32>; 80] = [Knot::open(0.0); 80];

/// The largest error of masses and lengths, and the noise of angles, rad.
type Case = (f64, f64);
const CASES: [Case; 6] =
    [(0.0, 0.0), (0.01, 0.0), (0.02, 0.0), (0.05, 0.0), (0.0, 1e-3), (0.02, 1e-4)];
/// The part by which masses, lengths and inertias are in doubt.
const DOUBT: f64 = 0.04;

/// A return, whether the acrobot is upright in the last tenth of the time, the time that all
/// planning took, and the longest between two steps.
struct Motion {
    total: f64,
    held: bool,
    planning: Duration,
    longest: Duration,
}

fn swing_up(seed: u64) -> anyhow::Result<Vec<Motion>> {
    let search = Search::new(Acrobot::new(seed), PLANNED * SWINGUP, LENGTHS, 1000, seed)?;
    motions(search, SWINGUP, 10, 2)
}

/// Gymnasium's acrobot for 45 s, with the rewards of the swing-up. The last tenth of the time
/// begins after 40 s.
fn gymnasium(seed: u64) -> anyhow::Result<Vec<Motion>> {
    let params = Params { dt: 1.0 / RATE as f32, ..Params::DEFAULT };
    let mut acrobot = Acrobot::with_params(seed, params)?;
    acrobot.set_state(Acrobot::<Fast>::new(seed).state())?;
    let search = Search::new(acrobot, PLANNED * GYMNASIUM, 500..STEPS, 45 * RATE, seed)?;
    motions(search, GYMNASIUM, RATE / 2, 12)
}

/// The motions of all cases, with the first plan of a part of the search, and with others after
/// every so many steps. The motor has a largest torque, N m.
fn motions(search: Search, limit: f32, every: usize, part: usize) -> anyhow::Result<Vec<Motion>> {
    let before = Instant::now();
    let mut first = search.clone();
    let (episode, mut plan) = first.run(part)?;
    if !episode.holds(search.steps) {
        plan = first.run(part)?.1;
    }
    plan.extend(UPRIGHT);
    let took = before.elapsed();
    let play = |case| {
        let motion = play(search.clone(), plan.clone(), (limit, every), case)?;
        Ok(Motion { planning: took + motion.planning, ..motion })
    };
    CASES.into_iter().map(play).collect()
}

fn play(
    mut search: Search,
    mut plan: Plan,
    (limit, every): (f32, usize),
    (error, angle): Case,
) -> anyhow::Result<Motion> {
    let (mut acrobot, steps, rng) = (search.acrobot.clone(), search.steps, &mut search.rng.clone());
    let params = *acrobot.params();
    let given: Params = params.cast();
    let deviations = Params {
        mass1: DOUBT * given.mass1,
        mass2: DOUBT * given.mass2,
        length1: DOUBT * given.length1,
        inertia1: DOUBT * (given.inertia1 + given.mass1 * given.center_of_mass1.powi(2)),
        inertia2: DOUBT * (given.inertia2 + given.mass2 * given.center_of_mass2.powi(2)),
        damping1: 0.0,
        damping2: 0.0,
        ..Params::DEFAULT
    };
    let noise = Noise { angle: angle.max(1e-6) / 3.0_f64.sqrt(), torque: 1e-3 };
    let mut estimator = Estimator::<Damped<Portable>, 10>::with_params(given, deviations, noise)?;
    let mut wrong = |x: f32| x * (1.0 + uniform(rng, -error, error)) as f32;
    acrobot.set_params(Params {
        mass1: wrong(params.mass1),
        mass2: wrong(params.mass2),
        length1: wrong(params.length1),
        center_of_mass2: wrong(params.center_of_mass2),
        ..params
    })?;
    let (mut episode, mut next) = (Episode::default(), 0);
    let (mut planning, mut longest) = (Duration::ZERO, Duration::ZERO);
    for i in 0..steps {
        let state = <[f32; 4]>::from(acrobot.state());
        let measured = from_fn(|j| f64::from(state[j]) + uniform(rng, -angle, angle));
        let before = Instant::now();
        estimator.measure(measured)?;
        let state = estimator.state().cast();
        if search.planner.catches(state) {
            next = plan.len();
        } else if i % every == 0 || next >= plan.len() {
            let rest = plan.split_off(next.min(plan.len()));
            let rest = if rest.is_empty() { UPRIGHT.to_vec() } else { rest };
            plan = search.again(state, estimator.params().cast(), steps - i, rest)?;
            next = 0;
        }
        let torque = saturate(search.planner.follow(&plan, next, state), limit);
        next += 1;
        estimator.step(torque.into())?;
        let took = before.elapsed();
        (planning, longest) = (planning + took, longest.max(took));
        episode.step(&mut acrobot, torque, i)?;
    }
    let held = episode.upright <= steps / 10 * 9;
    Ok(Motion { total: episode.total, held, planning, longest })
}

/// Prints a table of each motor.
pub fn tables(episodes: u32) -> anyhow::Result<()> {
    table("2 N m with friction, 10 s", episodes, swing_up)?;
    table("1 N m without friction, 45 s", episodes, gymnasium)
}

fn table(
    name: &str,
    episodes: u32,
    motions: fn(u64) -> anyhow::Result<Vec<Motion>>,
) -> anyhow::Result<()> {
    let played = (0..u64::from(episodes)).into_par_iter().map(motions);
    let played: Vec<_> = played.collect::<anyhow::Result<_>>()?;
    println!("| {name} | held of {episodes} | mean return | planning, most s | at once, most s |");
    println!("|---|---|---|---|---|");
    for (i, (error, angle)) in CASES.into_iter().enumerate() {
        let played = || played.iter().map(|motions| &motions[i]);
        let total: f64 = played().map(|motion| motion.total).sum();
        println!(
            "| {:.0} %; {:.1} mrad | {} | {:.0} | {:.1} | {:.2} |",
            error * 100.0,
            angle * 1e3,
            played().filter(|motion| motion.held).count(),
            total / f64::from(episodes),
            played().map(|motion| motion.planning).max().unwrap_or_default().as_secs_f64(),
            played().map(|motion| motion.longest).max().unwrap_or_default().as_secs_f64()
        );
    }
    Ok(())
}
