//! A controller that pumps energy until it can catch the acrobot upright, and holds it there. Prints the mean steps to
//! the goal over a hundred seeds, also for two simpler policies.
//!
//! ```text
//! cargo run --release --example energy_control -- --limit 10
//! ```
//!
//! Pumping: the motor adds energy while torque and θ̇2 have the same sign, and in the faster mode of swinging θ̇2
//! is opposite to θ̇1. A torque against θ̇1, in proportion to the missing energy, brings the acrobot to the energy of
//! standing upright.
//!
//! Catching: a linear-quadratic regulator holds the acrobot upright from some states. A clone of the pendulum is an
//! exact model, so the controller need not know which states these are: it regulates a clone for 40 steps, and starts
//! to regulate when the clone ends upright.

use std::io::{self, Write};
use std::process::ExitCode;

use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics;
use acrobot::physics::control::{Lqr, difference, discretize, lqr};
use acrobot::{Acrobot, Action, Params, Portable, State};
use clap::Parser;
use examples_common::exit;

/// Compares policies by their steps to the goal. One of them also balances the acrobot upright.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Seed whose children seed the episodes: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// Episodes of each policy.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..))]
    episodes: u64,
    /// Torque limit of the second energy controller, N m.
    #[arg(long, default_value_t = 10.0, value_parser = limit)]
    limit: f64,
}

fn limit(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(limit) if limit > 0.0 && f64::is_finite(limit) => Ok(limit),
        _ => Err("must be finite and above 0 N m".into()),
    }
}

/// The steps of an episode, each 0.2 s.
const STEPS: u32 = 1000;
/// The acrobot is caught when it is upright for this many steps in a row.
const HELD: u32 = 50;

type Pendulum = physics::Pendulum<Portable>;

fn main() -> ExitCode {
    exit::run(|options| compare(options, &mut io::stdout().lock()))
}

fn compare(options: &Options, out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "policy                torque limit  reached the goal             held upright"
    )?;
    let mut actions = Pcg64::from(options.seed.clone());
    let random = |pendulum: &Pendulum| pendulum.params().torque(Action::sample(&mut actions));
    writeln!(out, "{}", report(options, "random", 1.0, random))?;
    let bang_bang = |pendulum: &Pendulum| -pendulum.state().dtheta1.signum();
    writeln!(out, "{}", report(options, "bang-bang", 1.0, bang_bang))?;
    let regulator = Regulator::new();
    for limit in [1.0, options.limit] {
        let energy = |pendulum: &Pendulum| regulator.control(pendulum, limit);
        writeln!(out, "{}", report(options, "energy", limit, energy))?;
    }
    Ok(())
}

/// Plays the episodes of one policy. Returns a line with the results.
fn report(
    options: &Options,
    name: &str,
    limit: f64,
    mut policy: impl FnMut(&Pendulum) -> f64,
) -> String {
    let mut parent = options.seed.clone();
    let (mut goals, mut catches) = (Vec::new(), Vec::new());
    for seed in parent.spawn(options.episodes) {
        let initial = Acrobot::<Portable>::with_rng(Pcg64::from(seed)).state();
        let (goal, catch) = play(initial, &mut policy);
        goals.extend(goal);
        catches.extend(catch);
    }
    let of = |steps: &[u32]| {
        let sum: u64 = steps.iter().copied().map(u64::from).sum();
        let mean = sum as f64 / steps.len() as f64;
        let share = format!("{} of {}", steps.len(), options.episodes);
        if steps.is_empty() {
            share
        } else {
            format!("{share} in {mean:.1} steps")
        }
    };
    format!(
        "{name:<20}  {limit:>8} N m  {:<27}  {}",
        of(&goals),
        of(&catches)
    )
}

/// Plays an episode. Returns the steps to the goal, and the steps until the acrobot is held upright.
fn play(initial: State, policy: &mut impl FnMut(&Pendulum) -> f64) -> (Option<u32>, Option<u32>) {
    let mut pendulum = at(initial);
    let (mut goal, mut held) = (None, 0);
    for step in 1..=STEPS {
        let torque = policy(&pendulum);
        let reached = pendulum.step(torque).expect("policies give finite torques");
        if reached && goal.is_none() {
            goal = Some(step);
        }
        held = if is_upright(pendulum.state()) {
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

/// The difference of the state from standing upright.
fn from_upright(state: State) -> [f64; 4] {
    difference::<Portable>(state, State::UPRIGHT)
}

fn is_upright(state: State) -> bool {
    from_upright(state).iter().all(|x| x.abs() < 0.05)
}

fn at(state: State) -> Pendulum {
    Pendulum::new(Params::DEFAULT, state).expect("a finite state")
}

/// A linear-quadratic regulator about the upright position, for steps of 0.2 s, and a controller of the energy.
struct Regulator {
    lqr: Lqr,
    /// The energy of standing upright, J.
    upright: f64,
}

impl Regulator {
    /// It minimizes the sum of x² + torque².
    fn new() -> Self {
        const IDENTITY: [[f64; 4]; 4] = [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ];
        let upright = at(State::UPRIGHT);
        let lqr = discretize(&upright, 0.0).and_then(|model| lqr(&model, &IDENTITY, 1.0));
        Self {
            lqr: lqr.expect("the motor can hold the acrobot upright"),
            upright: upright.energy(),
        }
    }

    fn control(&self, pendulum: &Pendulum, limit: f64) -> f64 {
        let torque = if self.catches(pendulum.clone(), limit) {
            self.regulate(pendulum)
        } else {
            -(self.upright - pendulum.energy()) * pendulum.state().dtheta1
        };
        torque.clamp(-limit, limit)
    }

    fn regulate(&self, pendulum: &Pendulum) -> f64 {
        self.lqr.torque(from_upright(pendulum.state()))
    }

    /// Whether `model` ends upright if it is regulated from now on.
    fn catches(&self, mut model: Pendulum, limit: f64) -> bool {
        for _ in 0..40 {
            let torque = self.regulate(&model).clamp(-limit, limit);
            if model.step(torque).is_err() {
                return false;
            }
        }
        is_upright(model.state())
    }
}
