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

use acrobot::control::identify::{Regression, Sample};
use acrobot::control::mpc::Settings;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::{Error, Params};
use clap::Parser;
use machine::{Hardware, Machine, Rehearsal};
use rayon::prelude::*;

/// The time between two pushes, s.
const SECONDS: f64 = 10.0;
/// An acrobot is upright within these angles, rad, for so long before a push and the end, s.
const UPRIGHT: f64 = 0.1;
const HELD: f64 = 1.0;
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

/// What the controller believes of a machine, given the true parameters.
type Model = fn(Params, u64) -> Result<Params, Error>;

/// The motion of a machine between pushes: seconds until upright, if it then stays there.
type Motion = [Option<f64>; PUSHES.len()];

/// Shakes a machine for 10 s with up to 3 N m, and identifies it from what the encoders counted.
fn identified(truth: Params, seed: u64) -> Result<Params, Error> {
    let (hardware, mut rng) = (Hardware::realaigym(), Pcg64::new(seed));
    let mut machine = Machine::new(hardware, seed)?;
    let (mut recording, mut torque, mut left) = (Vec::new(), 0.0, 0.0);
    for _ in 0..(SECONDS / truth.dt) as u32 {
        if left <= 0.0 {
            (torque, left) = (uniform(&mut rng, -3.0, 3.0) as f32, uniform(&mut rng, 0.05, 0.4));
        }
        left -= truth.dt;
        let turn = f64::from(hardware.counts[0]);
        let angles = machine.counts().map(|count| (f64::from(count) + 0.5) / turn * TAU);
        recording.push(Sample { angles, torques: [0.0, torque.into()] });
        machine.step(torque);
    }
    let mut regression = Regression::EMPTY;
    regression.add(&recording, truth.dt, truth.gravity, 2, 250)?;
    // Masses, inertias and friction as drawn do not count, except for centres of mass.
    regression.fit().params(Params { mass1: 1.0, mass2: 1.0, ..truth })
}

fn control(seed: u64, slice: u32, model: Model) -> Result<Motion, Error> {
    let hardware = Hardware::realaigym();
    let params = model(hardware.params, seed)?.cast();
    let settings =
        Settings { params, limit: 6.0, counts: hardware.counts, delay: 0.0, plan_timeout: 1.0 };
    let mut rehearsal = Rehearsal::new(Machine::new(hardware, seed)?, settings, slice)?;
    let (mut motion, mut rng) = (Motion::default(), Pcg64::new(seed + 1000));
    for (time, push) in motion.iter_mut().zip(PUSHES) {
        *time = rehearsal.run(SECONDS, UPRIGHT, HELD)?;
        rehearsal.machine.push([(); 2].map(|()| uniform(&mut rng, -push, push)));
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
