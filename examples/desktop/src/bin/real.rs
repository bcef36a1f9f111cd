//! Swings a simulated real acrobot up and holds it, as firmware would: from encoder counts, with a
//! wrong model, and plans that are made while it moves.
//!
//! ```text
//! cargo run --release -p desktop --bin real                  # seeds from 0
//! cargo run --release -p desktop --bin real -- --first 20    # other seeds
//! ```
//!
//! docs/real.md has the table that it prints, and explains it.

use std::f64::consts::TAU;

use acrobot::arithmetic::Damped;
use acrobot::control::identify::{Regression, Sample};
use acrobot::control::mpc::{Controller, Replanner, Settings};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::{Error, Params, Portable};
use clap::Parser;
use machine::{Machine, realaigym};
use rayon::prelude::*;

/// Counts of each encoder for a turn, and the standard deviation of the torque, N m.
const COUNTS: [i32; 2] = [4096, 4096];
const NOISE: f64 = 0.02;

/// Ticks of 2 ms between two pushes.
const TICKS: u32 = 5000;
/// An acrobot is upright within these angles, rad, for so many ticks before a push and the end.
const UPRIGHT: f64 = 0.1;
const HELD: u32 = 500;
/// How much the pushes change both velocities at most, rad/s.
const PUSHES: [f64; 3] = [1.0, 6.0, 0.0];

/// Rehearses the control of a real acrobot.
#[derive(Parser)]
struct Options {
    /// Acrobots to control with each model.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..))]
    count: u64,
    /// The first seed.
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// Ticks of 2 ms that a slice of planning takes, such as 12 to 20 on an STM32F4.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..))]
    slice: u32,
}

fn machine(seed: u64) -> Result<Machine<Damped<Portable>>, Error> {
    Machine::new(realaigym(), COUNTS, 0, NOISE, seed)
}

/// What the controller believes of a machine, given the true parameters.
type Model = fn(Params, u64) -> Result<Params, Error>;

/// The motion of a machine between pushes: seconds until upright, if it then stays there.
type Motion = [Option<f64>; PUSHES.len()];

/// Shakes a machine for 10 s with up to 3 N m, and identifies it from what the encoders counted.
fn identified(truth: Params, seed: u64) -> Result<Params, Error> {
    let (mut machine, mut rng) = (machine(seed)?, Pcg64::new(seed));
    let (mut recording, mut torque, mut left) = (Vec::new(), 0.0, 0.0);
    let mut angles = [0.0; 2];
    for _ in 0..TICKS {
        if left <= 0.0 {
            (torque, left) = (uniform(&mut rng, -3.0, 3.0) as f32, uniform(&mut rng, 0.05, 0.4));
        }
        left -= truth.dt;
        // A real encoder counts on after a turn.
        for (angle, count) in angles.iter_mut().zip(machine.counts()) {
            let turns = f64::from(count) / f64::from(COUNTS[0]) - *angle / TAU;
            *angle += (turns - turns.round()) * TAU;
        }
        recording.push(Sample { angles, torques: [0.0, torque.into()] });
        machine.step(torque)?;
    }
    let mut regression = Regression::EMPTY;
    regression.add(&recording, truth.dt, truth.gravity, 2, 250)?;
    // Masses, inertias and friction as drawn do not count, except for centres of mass.
    regression.fit().params(Params { mass1: 1.0, mass2: 1.0, ..truth })
}

fn control(seed: u64, slice: u32, model: Model) -> Result<Motion, Error> {
    let mut machine = machine(seed)?;
    let params = model(machine.params(), seed)?.cast();
    let settings = Settings { params, limit: 6.0, counts: COUNTS, ticks: 5 };
    let mut controller = Controller::<100>::new(settings)?;
    let mut replanner = Replanner::new(settings)?;
    let mut motion = Motion::default();
    for (time, push) in motion.iter_mut().zip(PUSHES) {
        let mut upright = 0;
        for tick in 0..TICKS {
            let torque = controller.tick(machine.counts())?;
            if tick % slice == 0 {
                replanner.exchange(&mut controller);
                replanner.work();
            }
            machine.step(torque)?;
            if machine.lean() > UPRIGHT {
                upright = tick + 1;
            }
        }
        *time = (upright + HELD <= TICKS).then_some(f64::from(upright) * 0.002);
        machine.push(push)?;
    }
    Ok(motion)
}

fn main() -> anyhow::Result<()> {
    let Options { count, first, slice } = Options::parse();
    println!("| model | upright of {count} | after a push of 1 rad/s | of 6 rad/s |");
    println!("|---|---|---|---|");
    let models: [(&str, Model); 3] = [
        ("the true one", |truth, _| Ok(truth)),
        ("identified", identified),
        ("without friction", |truth, _| {
            let (damping1, damping2, coulomb1, coulomb2) = (0.0, 0.0, 0.0, 0.0);
            Ok(Params { damping1, damping2, coulomb1, coulomb2, ..truth })
        }),
    ];
    for (name, model) in models {
        let seeds = (first..first + count).into_par_iter();
        let motions = seeds.map(|seed| control(seed, slice, model));
        let motions: Vec<Motion> = motions.collect::<Result<_, _>>()?;
        print!("| {name} |");
        for part in 0..PUSHES.len() {
            let mut times: Vec<f64> = motions.iter().filter_map(|motion| motion[part]).collect();
            times.sort_by(f64::total_cmp);
            let (held, latest) = (times.len(), times.last().unwrap_or(&f64::NAN));
            let median = times.get(held / 2).unwrap_or(&f64::NAN);
            print!(" {held}, in {median:.1} s, at most {latest:.1} s |");
        }
        println!();
    }
    Ok(())
}
