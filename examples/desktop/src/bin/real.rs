//! Swings a simulated real acrobot up and holds it, as firmware would: from encoder counts, with a
//! wrong model, and plans that are made while it moves.
//!
//! ```text
//! cargo run --release -p desktop --bin real                            # RealAIGym's machine
//! cargo run --release -p desktop --bin real -- --first 20              # other seeds
//! cargo run --release -p desktop --bin real -- mass2=0.8 counts=5000   # another machine
//! cargo run --release -p desktop --bin real -- --believe mass2=0.5     # measured badly
//! ```
//!
//! docs/real.md has the table that it prints, and explains it.

use acrobot::control::identify::{Calibration, Sample, calibrate};
use acrobot::control::mpc::Settings;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::{Error, Params};
use anyhow::{Context, bail};
use clap::Parser;
use machine::{Hardware, Machine, Rehearsal, least_torque};
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
    /// Ticks that a slice of planning takes, such as 12 to 20 of 2 ms on an STM32F4.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..))]
    slice: u32,
    /// Numbers that differ from RealAIGym's machine: those of `Params`, such as mass1=0.6, kg, or
    /// coulomb1=0.1, N m; limit, N m; counts, of both encoders for a turn; zero1 and zero2, rad;
    /// delay and lag, s; torque_factor; torque_std, N m
    #[arg(value_name = "NAME=VALUE")]
    numbers: Vec<String>,
    /// A number that is believed instead: params, limit, counts, delay and lag are. Those of
    /// recordings follow from the machine, and from counts.
    #[arg(long, value_name = "NAME=VALUE")]
    believe: Vec<String>,
}

/// Changes a number of a machine.
fn set(hardware: &mut Hardware, number: &str) -> anyhow::Result<()> {
    let (name, value) = number.split_once('=').context("must be a name, = and a number")?;
    let value: f64 = value.parse()?;
    let names = hardware.params.numbers().map(|(name, _)| name);
    let [zero1, zero2] = &mut hardware.zeros;
    match name {
        "limit" => hardware.limit = value,
        "counts" => hardware.counts = [value as i32; 2],
        "zero1" => *zero1 = value,
        "zero2" => *zero2 = value,
        "delay" => hardware.delay = value,
        "lag" => hardware.lag = value,
        "torque_factor" => hardware.torque_factor = value,
        "torque_std" => hardware.torque_std = value,
        _ => match names.into_iter().zip(hardware.params.numbers_mut()).find(|(x, _)| *x == name) {
            Some((_, number)) => *number = value,
            None => bail!(
                "the name must be limit, counts, zero1, zero2, delay, lag, \
                torque_factor, torque_std or one of {}",
                names.join(", ")
            ),
        },
    }
    Ok(())
}

/// Says what makes a machine hard to hold. docs/real.md has on how many machines each was tried.
fn advise(Hardware { params, limit, delay, lag, .. }: &Hardware) {
    let (strength, friction) = (limit / least_torque(params), 100.0 * params.coulomb1 / limit);
    let ratio = params.length1 / params.length2;
    println!("The motor has {strength:.1} of the least torque that swings this machine up.");
    if strength < 1.2 {
        println!("Take a motor of {:.2} N m or more, or lighter links.", 1.2 * limit / strength);
    }
    if friction < 1.3 {
        println!(
            "Joint 1 has dry friction of {friction:.1} % of the motor: from 1.3 % it is easier."
        );
    }
    if ratio > 2.0 {
        println!("Link 1 is {ratio:.1} times as long as link 2: up to 2 is easier.");
    }
    if delay + lag > 0.02 {
        println!("The torque acts {:.0} ms late: up to 20 was tried.", 1e3 * (delay + lag));
    }
}

/// What the controller believes of a machine.
struct Belief {
    params: Params,
    delay: f64,
    zeros: [f64; 2],
}

/// A machine, and what its builder believes of it.
#[derive(Clone, Copy)]
struct Known {
    hardware: Hardware,
    believed: Hardware,
}

type Model = fn(&Known, u64) -> Result<Belief, Error>;

/// The motion of a machine between pushes: seconds until upright, if it then stays there. And the
/// time and the error that ended it.
#[derive(Default)]
struct Motion {
    upright: [Option<f64>; PUSHES.len()],
    error: Option<(f64, Error)>,
}

fn the_true_one(known: &Known, _: u64) -> Result<Belief, Error> {
    let Hardware { params, delay, lag, .. } = known.believed;
    Ok(Belief { params, delay: delay + lag, zeros: [0.0; 2] })
}

/// Of the true parameters only the lengths and the centres of mass count.
fn identified(&Known { hardware, believed }: &Known, seed: u64) -> Result<Belief, Error> {
    let ticks = (SECONDS / hardware.params.dt) as usize;
    let turn = f64::from(hardware.counts[0]) / f64::from(believed.counts[0]);
    let recording = Machine::new(hardware, seed)?.shake(seed).take(ticks);
    let recording = recording.map(|x| Sample { angles: x.angles.map(|angle| angle * turn), ..x });
    let recording: Vec<_> = recording.collect();
    let Calibration { params, delay, zeros, .. } = calibrate(&recording, believed.params)?;
    Ok(Belief { params, delay, zeros })
}

fn without_friction(known: &Known, seed: u64) -> Result<Belief, Error> {
    let mut belief = the_true_one(known, seed)?;
    let (damping1, damping2, coulomb1, coulomb2) = (0.0, 0.0, 0.0, 0.0);
    belief.params = Params { damping1, damping2, coulomb1, coulomb2, ..belief.params };
    Ok(belief)
}

fn control(known: &Known, seed: u64, slice: u32, model: Model) -> Result<Motion, Error> {
    let Belief { params, delay, zeros } = model(known, seed)?;
    let &Known { hardware, believed: Hardware { limit, counts, .. } } = known;
    let (params, limit, delay) = (params.cast(), limit as f32, delay as f32);
    let settings = Settings { params, limit, counts, delay, plan_timeout: 1.0 };
    // The controller gets counts from which these zeros are subtracted.
    let [zero1, zero2] = hardware.zeros;
    let hardware = Hardware { zeros: [zero1 - zeros[0], zero2 - zeros[1]], ..hardware };
    let mut rehearsal = Rehearsal::new(Machine::new(hardware, seed)?, settings, slice)?;
    let (mut motion, mut rng) = (Motion::default(), Pcg64::new(seed + 1000));
    for (time, push) in motion.upright.iter_mut().zip(PUSHES) {
        match rehearsal.run(SECONDS, UPRIGHT, HELD) {
            Ok(upright) => *time = upright,
            // An error switches the motor off.
            Err(error) => {
                motion.error = Some((rehearsal.seconds(), error));
                break;
            }
        }
        rehearsal.machine.push([(); 2].map(|()| uniform(&mut rng, -push, push)));
    }
    Ok(motion)
}

fn main() -> anyhow::Result<()> {
    let Options { count, first, slice, numbers, believe } = Options::parse();
    let mut hardware = Hardware::realaigym();
    for number in &numbers {
        set(&mut hardware, number).with_context(|| number.clone())?;
    }
    if !numbers.is_empty() {
        Machine::new(hardware, first)?;
        let numbers = hardware.params.numbers().into_iter().filter(|(_, value)| *value != 0.0);
        let numbers: Vec<_> = numbers.map(|(name, value)| format!("{name}={value}")).collect();
        println!("{}", numbers.join(" "));
        advise(&hardware);
        println!();
    }
    let mut believed = hardware;
    for number in &believe {
        set(&mut believed, number).with_context(|| number.clone())?;
    }
    let known = Known { hardware, believed };
    println!("| model | upright of {count} | after a push of 1 rad/s | of 6 rad/s |");
    println!("|---|---|---|---|");
    let models: [(&str, Model); 3] = [
        ("the true one", the_true_one),
        ("identified", identified),
        ("without friction", without_friction),
    ];
    for (name, model) in models {
        let seeds = (first..first + count).into_par_iter();
        let motions = seeds.map(|seed| control(&known, seed, slice, model));
        let motions: Vec<Motion> = motions.collect::<Result<_, _>>()?;
        print!("| {name} |");
        for part in 0..PUSHES.len() {
            let mut times: Vec<f64> =
                motions.iter().filter_map(|motion| motion.upright[part]).collect();
            times.sort_by(f64::total_cmp);
            match (times.get(times.len() / 2), times.last()) {
                (Some(median), Some(latest)) => {
                    print!(" {}, in {median:.1} s, at most {latest:.1} s |", times.len());
                }
                _ => print!(" 0 |"),
            }
        }
        println!();
        let ends = motions.iter().filter_map(|motion| motion.error);
        if let Some((latest, error)) = ends.clone().max_by(|x, y| x.0.total_cmp(&y.0)) {
            let ends = ends.count();
            println!(
                "The motor was off in {ends} of {count}, at last after {latest:.1} s: {error}"
            );
        }
    }
    Ok(())
}
