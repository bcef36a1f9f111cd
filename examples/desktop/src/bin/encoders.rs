//! Breaks the encoders of random machines: when does the controller notice it, and does it believe
//! so of encoders that are right?
//!
//! ```text
//! cargo run --release -p desktop --bin encoders
//! cargo run --release -p desktop --bin encoders -- --first 3000 --each    # others, line by line
//! ```
//!
//! docs/real.md has the table that it prints, and explains it.

use std::f64::consts::TAU;

use acrobot::Error;
use acrobot::control::mpc::Settings;
use acrobot::numpy::{Pcg64, uniform};
use clap::Parser;
use machine::{Hardware, Machine, Random, Rehearsal};
use rayon::prelude::*;

/// How much the pushes change the velocity of link 2, rad/s: one in so many seconds.
const PUSHES: [f64; 6] = [0.0, 1.0, 6.0, 1.0, 6.0, 6.0];
const EVERY: f64 = 6.0;
/// When encoders break after a push, and after the first begin, s.
const AFTER: [f64; 2] = [0.2, 0.8];
/// How long a machine runs with a broken encoder, s.
const BROKEN: f64 = 5.0;
/// The angles tell that an encoder is broken once it is wrong by so much, and the other joint has
/// turned by so much: a degree.
const TOLD: f64 = TAU / 360.0;
/// A jump by more than this tells it by itself, rad.
const JUMP: f64 = TAU / 36.0;
/// A machine stands within this angle of upright for so long, rad and s.
const UPRIGHT: f64 = 0.15;
const HELD: f64 = 1.0;
/// An error in time comes within so many seconds.
const IN_TIME: f64 = 0.7;

/// Breaks the encoders of random machines.
#[derive(Parser)]
struct Options {
    /// Machines to control.
    #[arg(long, default_value_t = 72, value_parser = clap::value_parser!(u64).range(1..))]
    count: u64,
    /// The first seed.
    #[arg(long, default_value_t = 7000)]
    first: u64,
    /// Also print a line for each fault that is not noticed in time.
    #[arg(long)]
    each: bool,
}

const MOTIONS: [&str; 3] = ["swings up", "stands", "was pushed"];
/// A jump is by a fifth of a turn.
const FAULTS: [&str; 3] = ["sticks", "counts 0", "jumps, and sticks"];

/// An encoder that breaks, by the places of the lists above.
#[derive(Clone, Copy)]
struct Fault {
    seed: u64,
    motion: usize,
    fault: usize,
    encoder: usize,
    /// Seconds from when the angles tell it until `tick` returns an error.
    noticed: Option<f64>,
    /// Whether the angles tell it.
    is_told: bool,
}

impl Fault {
    fn is_in_time(&self) -> bool {
        self.noticed.is_some_and(|time| time <= IN_TIME)
    }
}

/// Breaks each encoder in each way, and lets the machine move on.
fn break_encoders(before: &Rehearsal, seed: u64, motion: usize) -> Vec<Fault> {
    let Hardware { params, counts: turns, .. } = *before.machine.hardware();
    let angle = |i: usize, counts: i32| {
        let part = counts.rem_euclid(turns[i]);
        f64::from(part.min(turns[i] - part)) / f64::from(turns[i]) * TAU
    };
    let first = before.machine.counts();
    let broken = |(fault, encoder): (usize, usize)| {
        let last = first[encoder];
        let stuck = [last, 0, last + turns[encoder] / 5][fault];
        let mut rehearsal = before.clone();
        rehearsal.stuck[encoder] = Some(stuck);
        let is_jump = angle(encoder, stuck - last) > JUMP;
        let (mut told, mut noticed) = (None, None);
        for tick in 0..(BROKEN / params.dt) as u32 {
            let (time, counts) = (f64::from(tick) * params.dt, rehearsal.machine.counts());
            let is_wrong = angle(encoder, counts[encoder] - stuck) > TOLD;
            let other = 1 - encoder;
            if is_wrong && (is_jump || angle(other, counts[other] - first[other]) > TOLD) {
                told = told.or(Some(time));
            }
            if rehearsal.tick().is_err() {
                noticed = Some((time - told.unwrap_or(time)).max(0.0));
                break;
            }
        }
        Fault { seed, motion, fault, encoder, noticed, is_told: told.is_some() }
    };
    (0..FAULTS.len()).flat_map(|fault| [(fault, 0), (fault, 1)]).map(broken).collect()
}

/// Lets a machine move for 36 s. Returns what the controller says of right encoders.
fn run(seed: u64, faults: &mut Vec<Fault>) -> Result<f32, Error> {
    let Random { hardware, believed, slice, .. } = Random::new(seed);
    let settings = Settings {
        params: believed.cast(),
        limit: hardware.limit as f32,
        counts: hardware.counts,
        delay: (hardware.delay + hardware.lag) as f32,
        plan_timeout: 1.0,
    };
    let slice = (slice / hardware.params.dt).ceil() as u32;
    let mut rehearsal = Rehearsal::new(Machine::new(hardware, seed)?, settings, slice)?;
    let mut rng = Pcg64::new(seed);
    for push in PUSHES {
        rehearsal.machine.push([0.0, push.copysign(uniform(&mut rng, -1.0, 1.0))]);
        let (after, motion) = if push == 0.0 { (AFTER[1], 0) } else { (AFTER[0], 2) };
        rehearsal.run(after, UPRIGHT, 0.0)?;
        if push != 1.0 {
            faults.extend(break_encoders(&rehearsal, seed, motion));
        }
        let upright = rehearsal.run(EVERY - after, UPRIGHT, HELD)?;
        if push == 1.0 && upright.is_some() {
            faults.extend(break_encoders(&rehearsal, seed, 1));
        }
    }
    Ok(rehearsal.misses)
}

fn main() {
    let Options { count, first, each } = Options::parse();
    let outcome = |seed| {
        let mut faults = vec![];
        let misses = run(seed, &mut faults);
        (seed, faults, misses)
    };
    let outcomes: Vec<_> = (first..first + count).into_par_iter().map(outcome).collect();
    let mut all = vec![];
    let mut most = 0.0_f32;
    for (seed, faults, misses) in outcomes {
        all.extend(faults);
        match misses {
            Ok(misses) => most = most.max(misses),
            Err(error) => println!("{seed}, whose encoders are right: {error}"),
        }
    }
    println!("| the machine | encoder | it sticks | it counts 0 | it jumps, and sticks |");
    println!("|---|---|---|---|---|");
    all.retain(|fault| fault.is_told);
    for (motion, moves) in MOTIONS.iter().enumerate() {
        for encoder in 0..2 {
            let cells = [0, 1, 2].map(|fault| {
                let is_in = |x: &&Fault| (x.motion, x.encoder, x.fault) == (motion, encoder, fault);
                let group = all.iter().filter(is_in);
                let in_time = group.clone().filter(|x| x.is_in_time()).count();
                format!("{in_time} of {}", group.count())
            });
            println!("| {moves} | {} | {} |", encoder + 1, cells.join(" | "));
        }
    }
    let in_time = all.iter().filter(|x| x.is_in_time()).count();
    let never = all.iter().filter(|x| x.noticed.is_none()).count();
    let latest = all.iter().filter_map(|x| x.noticed).fold(0.0, f64::max);
    println!("\nIn time: {in_time} of {}. Not in {BROKEN} s: {never}.", all.len());
    println!("The others at last after {latest:.1} s.");
    println!("Most misses while both encoders are right: {most:.1}.");
    if each {
        for fault in all.iter().filter(|x| !x.is_in_time()) {
            let Fault { seed, motion, fault, encoder, noticed, .. } = fault;
            let (encoder, fault) = (encoder + 1, FAULTS[*fault]);
            let moves = MOTIONS[*motion];
            println!("{seed} {moves}, encoder {encoder} {fault}: {noticed:?} s");
        }
    }
}
