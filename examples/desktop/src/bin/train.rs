//! Trains policies that hold an acrobot upright, with ideal and with real instruments, and plays
//! them on simulated machines that they never saw.
//!
//! ```text
//! cargo run --release -p desktop --bin train
//! cargo run --release -p desktop --bin train -- --save hold.bin    # for the firmware `hold`
//! ```
//!
//! docs/learning.md has the table that it prints, and explains it.

use std::f64::consts::PI;
use std::fs;
use std::path::PathBuf;

use acrobot::arithmetic::Damped;
use acrobot::batch::VecBatch;
use acrobot::control::mpc::Settings;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::Pendulum;
use acrobot::task::{
    Balance, Draw, Draws, Encoders, Instruments, Measured, Pose, ResetBounds, Task,
};
use acrobot::{Error, Fast, Params, Portable, State};
use anyhow::Context as _;
use clap::Parser;
use machine::{Hardware, Machine, Rehearsal};
use rayon::prelude::*;

/// A linear policy: a torque, N m, from an observation.
type Weights = [f32; 6];

/// The encoders' counts for a turn, the time constant of the velocities, s, and how far initial
/// states are from upright, rad and rad/s.
const COUNTS: i32 = 4096;
const FILTER: f32 = 0.02;
const NEAR: f64 = 0.02;
/// A machine falls if an angle is so far from upright, rad.
const FALLEN: f64 = 0.7;

/// Trains by random search, and plays on random machines.
#[derive(Parser)]
struct Options {
    /// Machines to play on.
    #[arg(long, default_value_t = 200)]
    machines: u64,
    /// Policies to train in each way.
    #[arg(long, default_value_t = 4)]
    policies: u64,
    /// Steps of the search, of 512,000 steps of an acrobot.
    #[arg(long, default_value_t = 400)]
    iterations: u64,
    /// Instead of the table, train one policy for the slow motor and write it for crates/policy.
    #[arg(long)]
    save: Option<PathBuf>,
}

/// What machines of a kind have in common: the lag of the motor, s, and how far encoders are off,
/// degrees.
#[derive(Clone, Copy)]
struct Kind {
    lag: f64,
    zero: f64,
}

const KINDS: [Kind; 2] = [Kind { lag: 0.12, zero: 0.2 }, Kind { lag: 0.05, zero: 1.0 }];

impl Kind {
    /// How each reset of a training draws the instruments.
    fn instruments(self) -> Instruments {
        let uniform = |low: f64, high: f64| {
            let [low, high] = [low, high].map(|x| x as f32);
            Some(Draw::Uniform { low, high })
        };
        let zero = self.zero.to_radians();
        Instruments {
            action_delay: uniform(0.0, 2.0),
            motor_lag: uniform(0.6 * self.lag, 1.4 * self.lag),
            torque_error: uniform(-0.15, 0.15),
            encoder_zero1: uniform(-zero, zero),
            encoder_zero2: uniform(-zero, zero),
            encoder_counts: Some(Draw::exactly(COUNTS as f32)),
            velocity_filter: Some(Draw::exactly(FILTER)),
            ..Instruments::IDEAL
        }
    }

    /// A machine that no training saw, by its seed.
    fn hardware(self, seed: u64) -> Hardware {
        let mut rng = Pcg64::new(1000 + seed);
        let mut between = |low: f64, high: f64| uniform(&mut rng, low, high);
        let Params { mass1, mass2, .. } = Balance::PARAMS;
        let zero = self.zero.to_radians();
        Hardware {
            params: Params {
                mass1: mass1 * between(0.95, 1.05),
                mass2: mass2 * between(0.95, 1.05),
                damping1: between(0.0, 0.2),
                damping2: between(0.0, 0.2),
                coulomb1: between(0.0, 0.2),
                coulomb2: between(0.0, 0.2),
                ..Balance::PARAMS
            },
            limit: Balance::PARAMS.torques[2],
            counts: [COUNTS; 2],
            zeros: [between(-zero, zero), between(-zero, zero)],
            delay: between(0.0, 0.02),
            lag: self.lag * between(0.6, 1.4),
            torque_factor: between(0.85, 1.15),
            torque_std: 0.1,
        }
    }
}

/// The parameters that each reset of a training draws.
fn draws() -> Result<Draws<f32>, Error> {
    let [mass, friction] =
        [[0.95, 1.05], [0.0, 0.2]].map(|[low, high]| Draw::Uniform { low, high });
    Draws::new(Params {
        mass1: mass,
        mass2: mass,
        damping1: friction,
        damping2: friction,
        coulomb1: friction,
        coulomb2: friction,
        ..Draws::FIXED
    })
}

fn torque(weights: &Weights, observation: &[f32; 6]) -> f32 {
    weights.iter().zip(observation).map(|(weight, x)| weight * x).sum()
}

/// The regulator of the machine without friction and instruments, where all begin.
fn regulator() -> Result<Weights, Error> {
    let upright = Pendulum::<Portable>::new(Balance::PARAMS, State::UPRIGHT)?;
    let weights = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| f64::from(u8::from(i == j))));
    let lqr = upright.regulator(0.0, &weights, 0.01)?;
    let gain = |x: [f64; 4]| lqr.torque(x) as f32;
    let [k1, k2] = [gain([1.0, 0.0, 0.0, 0.0]), gain([0.0, 1.0, 0.0, 0.0])];
    let [k3, k4] = [gain([0.0, 0.0, 1.0, 0.0]), gain([0.0, 0.0, 0.0, 1.0])];
    Ok([0.0, -k1, 0.0, k2, k3, k4]) // sin θ1 falls where θ1 grows
}

/// Augmented random search (Mania, Guy and Recht 2018): a batch plays pairs of opposite changes of
/// the weights, and the weights follow those that gain.
fn train(
    instruments: Instruments,
    draws: Draws<f32>,
    seed: u64,
    iterations: u64,
) -> Result<Weights, Error> {
    const PAIRS: usize = 16;
    const ACROBOTS: usize = 32;
    /// The largest change, N m and N m s, and the part of it that gains become.
    const CHANGE: Weights = [2.0, 10.0, 2.0, 10.0, 4.0, 4.0];
    const RATE: f32 = 1.0;
    let mut rng = Pcg64::new(seed);
    let task = Measured::<Balance>::new(Balance, instruments)?;
    let mut batch = VecBatch::<Damped<Fast>, _>::with_task(0, task, 2 * PAIRS * ACROBOTS)?;
    batch.own_params()?;
    batch.set_draws(draws)?;
    batch.set_reset_bounds(ResetBounds::new(-NEAR, NEAR)?);
    let limit = Balance::PARAMS.torques[2] as f32;
    let mut weights = regulator()?;
    for iteration in 0..iterations {
        let changes =
            [(); PAIRS].map(|()| CHANGE.map(|most| most * uniform(&mut rng, -1.0, 1.0) as f32));
        let moved = |change: &Weights, by: f32| {
            let mut moved = weights;
            moved.iter_mut().zip(change).for_each(|(x, change)| *x += by * change);
            moved
        };
        let policies: Vec<_> =
            changes.iter().flat_map(|change| [moved(change, 1.0), moved(change, -1.0)]).collect();
        // Each policy plays the same acrobots, so differences are the policies'.
        for (i, rng) in batch.generators_mut().iter_mut().enumerate() {
            *rng = Pcg64::new((seed << 32) + iteration * 1000 + (i % ACROBOTS) as u64);
        }
        batch.reset();
        let (mut returns, mut torques) = (vec![0.0; policies.len()], vec![0.0; batch.len()]);
        for _ in 1..Balance::MAX_STEPS.get() {
            for (i, (to, seen)) in torques.iter_mut().zip(batch.observations()).enumerate() {
                *to = torque(&policies[i / ACROBOTS], seen).clamp(-limit, limit);
            }
            let rewards = batch.step(&torques)?.rewards.chunks(ACROBOTS);
            returns.iter_mut().zip(rewards).for_each(|(sum, new)| *sum += new.iter().sum::<f32>());
        }
        let count = returns.len() as f32;
        let mean = returns.iter().sum::<f32>() / count;
        let variance = returns.iter().map(|x| (x - mean) * (x - mean)).sum::<f32>() / count;
        for (pair, change) in returns.chunks(2).zip(&changes) {
            let gain = RATE * (pair[0] - pair[1]) / (variance.sqrt() + 1e-3) / PAIRS as f32;
            weights.iter_mut().zip(change).for_each(|(x, change)| *x += gain * change);
        }
    }
    Ok(weights)
}

/// Whether a policy holds a machine for 10 s from near upright.
fn holds(weights: &Weights, hardware: Hardware, seed: u64) -> Result<bool, Error> {
    let mut machine = Machine::new(hardware, seed)?;
    let mut rng = Pcg64::new(seed);
    let [theta1, theta2, v1, v2] = [(); 4].map(|()| uniform(&mut rng, -NEAR, NEAR));
    machine.set_state([PI + theta1, theta2, v1, v2].into());
    let mut encoders = Encoders::new(COUNTS, FILTER, hardware.params.dt as f32, machine.counts())?;
    for _ in 0..500 {
        let state = encoders.read(machine.counts());
        machine.step(torque(weights, &Balance.observe::<Fast, f32>(&Pose::of::<Fast>(state))));
        if machine.lean() > FALLEN {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Whether the planner with its estimator swings a machine up and holds it in the last 10 of 30 s.
fn planned(hardware: Hardware, lag: f64, seed: u64) -> Result<bool, Error> {
    let settings = Settings {
        params: Params {
            max_velocity1: f64::INFINITY,
            max_velocity2: f64::INFINITY,
            damping1: 0.1,
            damping2: 0.1,
            coulomb1: 0.1,
            coulomb2: 0.1,
            ..Balance::PARAMS
        }
        .cast(),
        limit: hardware.limit as f32,
        counts: hardware.counts,
        delay: (0.01 + lag) as f32,
        plan_timeout: 1.0,
    };
    let mut rehearsal = Rehearsal::new(Machine::new(hardware, seed)?, settings, 1)?;
    Ok(matches!(rehearsal.run(30.0, FALLEN, 10.0), Ok(Some(_))))
}

/// The file of a policy with one layer and the largest torque, as crates/policy reads it.
fn file(weights: &Weights) -> Vec<u8> {
    let mut bytes = b"MLP1".to_vec();
    bytes.extend([1, 1, 6, 0]);
    bytes.extend((Balance::PARAMS.torques[2] as f32).to_le_bytes());
    bytes.extend([1, 0, 0, 0]);
    bytes.extend(0.0_f32.to_le_bytes()); // the bias
    bytes.extend(weights.iter().flat_map(|weight| weight.to_le_bytes()));
    let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&bytes);
    bytes.extend(checksum.to_le_bytes());
    bytes
}

/// How many of the machines hold, in percent.
fn held(
    machines: u64,
    holds: impl Fn(u64) -> Result<bool, Error> + Send + Sync,
) -> Result<f64, Error> {
    let results: Result<Vec<_>, _> = (0..machines).into_par_iter().map(holds).collect();
    Ok(100.0 * results?.iter().filter(|held| **held).count() as f64 / machines as f64)
}

fn main() -> anyhow::Result<()> {
    let Options { machines, policies, iterations, save } = Options::parse();
    let filter = Some(Draw::exactly(FILTER));
    let filtered = Instruments { velocity_filter: filter, ..Instruments::IDEAL };
    type Training<'a> = (&'a str, u64, &'a dyn Fn(Kind) -> (Instruments, Draws<f32>));
    let drawn = draws()?;
    if let Some(path) = save {
        let weights = train(KINDS[0].instruments(), drawn, 0, iterations)?;
        return fs::write(&path, file(&weights))
            .with_context(|| format!("{} is not written", path.display()));
    }
    let trainings: [Training<'_>; 4] = [
        ("the regulator, without training", 0, &|_| (filtered, Draws::NONE)),
        ("ideal instruments", iterations, &|_| (filtered, Draws::NONE)),
        ("the same, parameters drawn", iterations, &|_| (filtered, drawn)),
        ("instruments and parameters drawn", iterations, &|kind| (kind.instruments(), drawn)),
    ];
    let names = KINDS.map(|Kind { lag, zero }| format!("lag {:.0} ms, zeros {zero}°", 1e3 * lag));
    println!("| trained with | {} |", names.join(" | "));
    println!("|---|---|---|");
    for (name, iterations, settings) in trainings {
        let count = if iterations == 0 { 1 } else { policies };
        let mut cells = Vec::new();
        for kind in KINDS {
            let (instruments, draws) = settings(kind);
            let parts = (0..count).into_par_iter().map(|seed| {
                let weights = train(instruments, draws, seed, iterations)?;
                held(machines, |seed| holds(&weights, kind.hardware(seed), seed))
            });
            let parts = parts.collect::<Result<Vec<_>, _>>()?;
            let mean = parts.iter().sum::<f64>() / parts.len() as f64;
            let least = parts.iter().copied().fold(100.0, f64::min);
            let most = parts.iter().copied().fold(0.0, f64::max);
            cells.push(match count {
                1 => format!("{mean:.0} %"),
                _ => format!("{mean:.0} % ({least:.0} to {most:.0})"),
            });
        }
        println!("| {name} | {} |", cells.join(" | "));
    }
    let planned =
        KINDS.map(|kind| held(machines, |seed| planned(kind.hardware(seed), kind.lag, seed)));
    let [first, second] = planned;
    println!(
        "| the planner with its estimator, from hanging | {:.0} % | {:.0} % |",
        first?, second?
    );
    Ok(())
}
