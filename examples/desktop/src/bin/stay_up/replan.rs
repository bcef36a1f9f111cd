//! Both tasks in real time: the acrobot differs from the model, measurements are noisy, and the
//! planner plans again from estimates, every 0.1 s, with 1 N m every 0.5 s.

use std::array::from_fn;
use std::ops::Range;
use std::time::{Duration, Instant};

use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::bound;
use acrobot::{Acrobot, Fast, Params, State};
use controller::Step;
use rayon::prelude::*;

use crate::observer::Observer;
use crate::search::{Plan, Search};
use crate::{Episode, GYMNASIUM, LENGTHS, RATE, STEPS, SWINGUP, Task};

/// The part of the motor's torque that plans use. The rest corrects deviations.
const PLANNED: f32 = 0.95;
/// Upright steps at the end of a plan, so that the approach, too, is planned again.
const UPRIGHT: [Step<f32>; 80] = [Step::open(0.0); 80];

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

/// A motor: its largest torque, N m, the steps of an episode and from one plan to the next, the
/// steps of first guesses, and the part of the search for the first plan.
struct Motor {
    name: &'static str,
    limit: f32,
    steps: usize,
    every: usize,
    lengths: Range<usize>,
    part: usize,
    start: fn(u64) -> anyhow::Result<Acrobot<Task>>,
}

const MOTORS: [Motor; 2] = [
    Motor {
        name: "2 N m with friction, 10 s",
        limit: SWINGUP,
        steps: 1000,
        every: 10,
        lengths: LENGTHS,
        part: 2,
        start: |seed| Ok(Acrobot::new(seed)),
    },
    // The last tenth of the time begins after 40 s.
    Motor {
        name: "1 N m without friction, 45 s",
        limit: GYMNASIUM,
        steps: 45 * RATE,
        every: RATE / 2,
        lengths: 500..STEPS,
        part: 12,
        start: gymnasium,
    },
];

/// Gymnasium's acrobot, with the rewards of the swing-up.
fn gymnasium(seed: u64) -> anyhow::Result<Acrobot<Task>> {
    let params = Params { dt: 1.0 / RATE as f32, ..Params::DEFAULT };
    let mut acrobot = Acrobot::with_params(seed, params)?;
    acrobot.set_state(Acrobot::<Fast>::new(seed).state())?;
    Ok(acrobot)
}

/// An episode, the time that all planning took, and the longest time from one step to the next.
struct Motion {
    episode: Episode,
    planning: Duration,
    longest: Duration,
}

impl Motor {
    /// The motions of all cases from an initial state, with the same first plan.
    fn motions(&self, seed: u64) -> anyhow::Result<Vec<Motion>> {
        let acrobot = (self.start)(seed)?;
        let limit = PLANNED * self.limit;
        let search = || Search::new(acrobot.clone(), limit, self.lengths.clone(), self.steps, seed);
        let before = Instant::now();
        let mut first = search()?;
        let (episode, mut plan) = first.run(self.part)?;
        if !episode.holds(self.steps) {
            plan = first.run(self.part)?.1;
        }
        plan.extend(UPRIGHT);
        let took = before.elapsed();
        let play = |case| {
            let motion = self.play(acrobot.clone(), plan.clone(), search()?, case, seed)?;
            Ok(Motion { planning: took + motion.planning, ..motion })
        };
        CASES.into_iter().map(play).collect()
    }

    fn play(
        &self,
        mut acrobot: Acrobot<Task>,
        mut plan: Plan,
        mut search: Search,
        (error, [angle, velocity]): Case,
        seed: u64,
    ) -> anyhow::Result<Motion> {
        let rng = &mut Pcg64::new(seed);
        let params = *acrobot.params();
        let mut observer = Observer::new(params.cast())?;
        let mut wrong = |x: f32| x * (1.0 + uniform(rng, -error, error)) as f32;
        acrobot.set_params(Params {
            mass1: wrong(params.mass1),
            mass2: wrong(params.mass2),
            length1: wrong(params.length1),
            center_of_mass2: wrong(params.center_of_mass2),
            ..params
        })?;
        let noise = [angle, angle, velocity, velocity];
        let (mut episode, mut next) = (Episode::default(), 0);
        let (mut planning, mut longest) = (Duration::ZERO, Duration::ZERO);
        for i in 0..self.steps {
            let state = <[f32; 4]>::from(acrobot.state());
            let measured = from_fn(|j| f64::from(state[j]) + uniform(rng, -noise[j], noise[j]));
            let before = Instant::now();
            observer.measure(State::from(measured), noise.map(|most| most / 3.0_f64.sqrt()));
            let state = observer.state();
            if search.planner.catches(state) {
                next = plan.len();
            } else if i % self.every == 0 || next >= plan.len() {
                let rest = plan.split_off(next.min(plan.len()));
                let rest = if rest.is_empty() { UPRIGHT.to_vec() } else { rest };
                plan = search.again(state, observer.params(), self.steps - i, rest)?;
                next = 0;
            }
            let torque = bound(search.planner.follow(&plan, next, state), self.limit);
            next += 1;
            observer.step(torque)?;
            let took = before.elapsed();
            (planning, longest) = (planning + took, longest.max(took));
            episode.step(&mut acrobot, torque, i)?;
        }
        Ok(Motion { episode, planning, longest })
    }

    /// Prints a table.
    fn table(&self, episodes: u32) -> anyhow::Result<()> {
        let played = (0..u64::from(episodes)).into_par_iter().map(|seed| self.motions(seed));
        let played: Vec<_> = played.collect::<anyhow::Result<_>>()?;
        let name = self.name;
        println!("| {name} | held of {episodes} | mean return | planning, most s | longest, s |");
        println!("|---|---|---|---|---|");
        for (i, (error, [angle, velocity])) in CASES.into_iter().enumerate() {
            let played = played.iter().map(|motions| &motions[i]);
            let held = played
                .clone()
                .filter(|motion| motion.episode.upright <= self.steps / 10 * 9)
                .count();
            let total: f64 = played.clone().map(|motion| motion.episode.total).sum();
            let mean = total / f64::from(episodes);
            let most = played.clone().map(|motion| motion.planning).max();
            let longest = played.map(|motion| motion.longest).max();
            println!(
                "| {:.0} %; {:.1} mrad and {:.0} mrad/s | {held} | {mean:.0} | {:.1} | {:.2} |",
                error * 100.0,
                angle * 1e3,
                velocity * 1e3,
                most.unwrap_or_default().as_secs_f64(),
                longest.unwrap_or_default().as_secs_f64()
            );
        }
        Ok(())
    }
}

/// Prints a table of each motor.
pub fn tables(episodes: u32) -> anyhow::Result<()> {
    MOTORS.iter().try_for_each(|motor| motor.table(episodes))
}
