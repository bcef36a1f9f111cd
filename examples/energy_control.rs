//! A controller that pumps energy until the acrobot can be caught upright, and holds it there, beside
//! two simpler policies: mean steps to the goal over a hundred seeds.
//!
//! ```text
//! cargo run --release --example energy_control -- --limit 10
//! ```
//!
//! Pumping: the motor adds energy where torque and θ̇2 have the same sign, and in the slower of the two
//! ways to swing θ̇2 runs against θ̇1. A torque against θ̇1, in proportion to the energy that is missing,
//! brings the acrobot to the energy of standing upright.
//!
//! Catching: a linear-quadratic regulator holds the upright within a region that nobody needs to know,
//! since a clone of the acrobot is the exact model: where a clone that is regulated from here on ends
//! upright, so will the original.

use std::array::from_fn;
use std::f64::consts::PI;
use std::io::{self, Write};
use std::process::ExitCode;

use acrobot::{Acrobot, Action, Params, Pcg64, Portable, SeedSequence, State, energy, wrap};
use clap::Parser;

#[path = "common/exit.rs"]
mod exit;

/// Compares policies by their steps to the goal, and catches the upright with one of them.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Seed of which the episodes' seeds are spawned: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// Episodes of each policy.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..))]
    episodes: u64,
    /// Torque limit of the strong energy controller, N m.
    #[arg(long, default_value_t = 10.0, value_parser = limit)]
    limit: f64,
}

fn limit(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(limit) if limit > 0.0 && f64::is_finite(limit) => Ok(limit),
        _ => Err("allowed is a finite number of N m above 0".into()),
    }
}

/// Episodes end here, in steps of 0.2 s.
const STEPS: u32 = 1000;
/// Held for so many steps in a row is caught.
const HELD: u32 = 50;

fn main() -> ExitCode {
    exit::status(compare(&Options::parse(), &mut io::stdout().lock()))
}

fn compare(options: &Options, out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "policy                torque limit  steps to the goal      caught upright"
    )?;
    let mut actions = Pcg64::new(options.seed.clone());
    let random = |acrobot: &Acrobot| acrobot.params().torque(Action::sample(&mut actions));
    writeln!(out, "{}", report(options, "random", 1.0, random))?;
    let bang_bang = |acrobot: &Acrobot| -acrobot.state().dtheta1.signum();
    writeln!(out, "{}", report(options, "bang-bang", 1.0, bang_bang))?;
    let regulator = Regulator::new();
    for limit in [1.0, options.limit] {
        let energy = |acrobot: &Acrobot| regulator.control(acrobot, limit);
        writeln!(out, "{}", report(options, "energy", limit, energy))?;
    }
    Ok(())
}

/// Plays the episodes of one policy and says in a line how they went.
fn report(
    options: &Options,
    name: &str,
    limit: f64,
    mut policy: impl FnMut(&Acrobot) -> f64,
) -> String {
    let mut parent = options.seed.clone();
    let (mut goals, mut catches) = (Vec::new(), Vec::new());
    for seed in parent.spawn(options.episodes) {
        let (goal, catch) = play(Acrobot::new(seed), &mut policy);
        goals.extend(goal);
        catches.extend(catch);
    }
    let of = |steps: &[u32]| {
        let mean = steps.iter().sum::<u32>() as f64 / steps.len() as f64;
        let share = format!("{} of {}", steps.len(), options.episodes);
        if steps.is_empty() {
            share
        } else {
            format!("{share} at {mean:.1}")
        }
    };
    format!(
        "{name:<20}  {limit:>8} N m  {:<21}  {}",
        of(&goals),
        of(&catches)
    )
}

/// The steps to the goal, and to when the acrobot stood still upright.
fn play(
    mut acrobot: Acrobot,
    policy: &mut impl FnMut(&Acrobot) -> f64,
) -> (Option<u32>, Option<u32>) {
    let (mut goal, mut held) = (None, 0);
    for step in 1..=STEPS {
        let torque = policy(&acrobot);
        let reached = acrobot
            .step_torque(torque)
            .expect("policies give finite torques")
            .terminated;
        if reached && goal.is_none() {
            goal = Some(step);
        }
        held = if is_upright(acrobot.state()) {
            held + 1
        } else {
            0
        };
        if held == HELD {
            return (goal, Some(step - HELD));
        }
    }
    (goal, None)
}

/// The state as it differs from standing upright.
fn from_upright(state: State) -> [f64; 4] {
    let State {
        theta1,
        theta2,
        dtheta1,
        dtheta2,
    } = state;
    [wrap::<Portable>(theta1 - PI), theta2, dtheta1, dtheta2]
}

fn is_upright(state: State) -> bool {
    from_upright(state).iter().all(|x| x.abs() < 0.05)
}

type Matrix = [[f64; 4]; 4];

/// A discrete linear-quadratic regulator about the upright, for a step of 0.2 s.
struct Regulator {
    /// N m per rad and per rad/s.
    gain: [f64; 4],
    /// Energy of standing upright, J.
    upright: f64,
}

impl Regulator {
    fn new() -> Self {
        let (a, b) = linearize();
        let upright = State {
            theta1: PI,
            ..State::default()
        };
        Self {
            gain: gain(a, b),
            upright: energy::<Portable>(&Params::DEFAULT, &upright),
        }
    }

    fn control(&self, acrobot: &Acrobot, limit: f64) -> f64 {
        let torque = if self.catches(acrobot.clone(), limit) {
            self.regulate(acrobot)
        } else {
            -(self.upright - acrobot.energy()) * acrobot.state().dtheta1
        };
        torque.clamp(-limit, limit)
    }

    fn regulate(&self, acrobot: &Acrobot) -> f64 {
        let x = from_upright(acrobot.state());
        -x.iter()
            .zip(self.gain)
            .map(|(x, gain)| gain * x)
            .sum::<f64>()
    }

    /// Whether regulating from here on ends upright.
    fn catches(&self, mut acrobot: Acrobot, limit: f64) -> bool {
        for _ in 0..40 {
            let torque = self.regulate(&acrobot).clamp(-limit, limit);
            if acrobot.step_torque(torque).is_err() {
                return false;
            }
        }
        is_upright(acrobot.state())
    }
}

/// How the next state depends on the state and on the torque, about the upright, by central
/// differences of the step itself.
fn linearize() -> (Matrix, [f64; 4]) {
    const H: f64 = 1e-5;
    let mut acrobot = Acrobot::<Portable>::new(0);
    let mut next = |mut x: [f64; 4], torque| {
        x[0] += PI;
        acrobot
            .set_state(x.into())
            .and_then(|()| acrobot.step_torque(torque))
            .expect("finite");
        from_upright(acrobot.state())
    };
    let mut slope = |x: [f64; 4], torque: f64| {
        let (ahead, behind) = (next(x, torque), next(x.map(|x| -x), -torque));
        from_fn(|i| (ahead[i] - behind[i]) / (2.0 * H))
    };
    let columns: Matrix = from_fn(|j| slope(from_fn(|i| if i == j { H } else { 0.0 }), 0.0));
    (from_fn(|i| from_fn(|j| columns[j][i])), slope([0.0; 4], H))
}

/// The gain that minimizes Σ x² + torque², by iterating the Riccati equation to its fixed point.
fn gain(a: Matrix, b: [f64; 4]) -> [f64; 4] {
    let dot = |x: [f64; 4], y: [f64; 4]| (0..4).map(|n| x[n] * y[n]).sum::<f64>();
    let column = |m: &Matrix, j: usize| from_fn(|i| m[i][j]);
    let mut value = Matrix::default();
    let mut gain = [0.0; 4];
    for _ in 0..1000 {
        let value_a: Matrix = from_fn(|i| from_fn(|j| dot(value[i], column(&a, j))));
        let value_b = from_fn(|i| dot(value[i], b));
        gain = from_fn(|j| dot(b, column(&value_a, j)) / (1.0 + dot(b, value_b)));
        value = from_fn(|i| {
            from_fn(|j| {
                let cost = if i == j { 1.0 } else { 0.0 };
                cost + dot(column(&a, i), column(&value_a, j))
                    - dot(column(&a, i), value_b) * gain[j]
            })
        });
    }
    gain
}
