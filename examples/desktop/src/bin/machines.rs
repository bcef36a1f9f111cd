//! Swings random machines up and holds them: with delays, encoders whose zeros are off, friction
//! that sticks, and parameters that were measured badly.
//!
//! ```text
//! cargo run --release -p desktop --bin machines
//! cargo run --release -p desktop --bin machines -- --first 3000 --each    # others, line by line
//! ```
//!
//! docs/real.md has the table that it prints, and explains it.

use acrobot::Error;
use acrobot::control::mpc::Settings;
use acrobot::numpy::{Pcg64, uniform};
use clap::Parser;
use machine::{Machine, Random, Rehearsal};
use rayon::prelude::*;

/// A machine is held if both angles are within so many rad of upright in the last 2 of 12 s.
const UPRIGHT: f64 = 0.15;
const HELD: f64 = 2.0;
const SECONDS: f64 = 12.0;
/// How much the pushes before each of these change the velocity of link 2, rad/s.
const PUSHES: [f64; 3] = [0.0, 1.0, 6.0];

/// Rehearses the control of random machines.
#[derive(Parser)]
struct Options {
    /// Machines to control.
    #[arg(long, default_value_t = 72, value_parser = clap::value_parser!(u64).range(1..))]
    count: u64,
    /// The first seed.
    #[arg(long, default_value_t = 1000)]
    first: u64,
    /// Also print a line for each machine.
    #[arg(long)]
    each: bool,
}

/// A machine, and seconds until it is upright for good after each push.
struct Outcome {
    seed: u64,
    random: Random,
    times: [Option<f64>; PUSHES.len()],
    /// The largest number of misses.
    misses: f32,
    error: Option<Error>,
}

fn run(seed: u64) -> Outcome {
    let random = Random::new(seed);
    let mut outcome = Outcome { seed, random, times: [None; 3], misses: 0.0, error: None };
    outcome.error = control(&mut outcome).err();
    outcome
}

fn control(outcome: &mut Outcome) -> Result<(), Error> {
    let Random { hardware, believed, slice, .. } = outcome.random;
    let settings = Settings {
        params: believed.cast(),
        limit: hardware.limit as f32,
        counts: hardware.counts,
        delay: (hardware.delay + hardware.lag) as f32,
        plan_timeout: 1.0,
    };
    let slice = (slice / hardware.params.dt).ceil() as u32;
    let machine = Machine::new(hardware, outcome.seed)?;
    let mut rehearsal = Rehearsal::new(machine, settings, slice)?;
    let mut rng = Pcg64::new(outcome.seed);
    for (time, push) in outcome.times.iter_mut().zip(PUSHES) {
        rehearsal.machine.push([0.0, push.copysign(uniform(&mut rng, -1.0, 1.0))]);
        *time = rehearsal.run(SECONDS, UPRIGHT, HELD)?;
        outcome.misses = outcome.misses.max(rehearsal.misses);
    }
    Ok(())
}

/// Dry friction of joint 1, in percent of the motor's torque.
fn dry(random: &Random) -> f64 {
    100.0 * random.hardware.params.coulomb1 / random.hardware.limit
}

fn ratio(random: &Random) -> f64 {
    random.hardware.params.length1 / random.hardware.params.length2
}

/// A line of the table, of the machines in a group.
fn row(outcomes: &[Outcome], name: &str, is_in: impl Fn(&Random) -> bool) {
    let group: Vec<_> = outcomes.iter().filter(|outcome| is_in(&outcome.random)).collect();
    let held = |i: usize| group.iter().filter(|outcome| outcome.times[i].is_some()).count();
    let ([hanging, gentle, hard], all) = ([held(0), held(1), held(2)], group.len());
    let percent = 100 * (hanging + gentle + hard) / (3 * all.max(1));
    println!("| {name} | {all} | {hanging} | {gentle} | {hard} | {percent} % |");
}

fn main() {
    let Options { count, first, each } = Options::parse();
    let outcomes: Vec<Outcome> = (first..first + count).into_par_iter().map(run).collect();
    if each {
        for Outcome { seed, random, times, misses, error } in &outcomes {
            let times =
                times.map(|time| time.map_or("falls".into(), |time| format!("{time:.1} s")));
            println!("{seed}: {}, misses {misses:.1}, {error:?}, {random:?}", times.join(", "));
        }
    }
    println!("| machines | number | swung up and held | after 1 rad/s | after 6 rad/s | cells |");
    println!("|---|---|---|---|---|---|");
    row(&outcomes, "all", |_| true);
    for delay in [0.0, 0.005, 0.01, 0.02] {
        let name = format!("delay of {:.0} ms", 1e3 * delay);
        row(&outcomes, &name, |random| random.hardware.delay == delay);
    }
    for zero in [0.0, 0.5, 1.5] {
        row(&outcomes, &format!("zeros up to {zero}° off"), |random| random.zero == zero);
    }
    for [from, to] in [[1.2, 2.0], [2.0, 4.0]] {
        let name = format!("motor {from} to {to} times the least torque");
        row(&outcomes, &name, |random| (from..to).contains(&random.strength));
    }
    for [from, to] in [[0.0, 0.5], [0.5, 1.3], [1.3, 5.0]] {
        let name = format!("dry friction of joint 1 {from} to {to} % of the motor");
        row(&outcomes, &name, |random| (from..to).contains(&dry(random)));
    }
    for [from, to] in [[0.0, 0.5], [0.5, 1.0], [1.0, 2.0], [2.0, 9.0]] {
        let name = format!("link 1 {from} to {to} times as long as link 2");
        row(&outcomes, &name, |random| (from..to).contains(&ratio(random)));
    }
    row(&outcomes, "motor from 2, friction from 1.3 %, link 1 up to 2", |random| {
        random.strength >= 2.0 && dry(random) >= 1.3 && ratio(random) <= 2.0
    });
    let errors = outcomes.iter().filter(|outcome| outcome.error.is_some()).count();
    let misses = outcomes.iter().map(|outcome| outcome.misses).fold(0.0, f32::max);
    println!("\nEnded with an error: {errors}. Most misses: {misses:.1}.");
}
