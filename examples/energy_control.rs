//! A controller that pumps energy until it can catch the acrobot upright, and holds it there. Prints the mean steps to
//! the goal over a hundred seeds, also for two simpler policies.
//!
//! ```text
//! cargo run --release --example energy_control -- --limit 10
//! ```
//!
//! Pumping: the motor adds energy while torque and θ̇2 have the same sign, and in the slower mode of swinging θ̇2
//! is opposite to θ̇1. A torque against θ̇1, in proportion to the missing energy, brings the acrobot to the energy of
//! standing upright.
//!
//! Catching: a linear-quadratic regulator holds the acrobot upright from some states. A clone of the pendulum is an
//! exact model, so the controller need not know which states these are: it regulates a clone for 40 steps, and starts
//! to regulate when the clone ends upright.

use std::array::from_fn;
use std::f64::consts::PI;
use std::io::{self, Write};
use std::process::ExitCode;

use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::{self, wrap};
use acrobot::{Acrobot, Action, Portable, State};
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
    let [theta1, theta2, dtheta1, dtheta2] = state.into();
    [wrap::<Portable>(theta1 - PI), theta2, dtheta1, dtheta2]
}

fn is_upright(state: State) -> bool {
    from_upright(state).iter().all(|x| x.abs() < 0.05)
}

fn at(state: State) -> Pendulum {
    Pendulum::at(state).expect("a finite state")
}

type Matrix = [[f64; 4]; 4];

/// A discrete linear-quadratic regulator about the upright position, for steps of 0.2 s.
struct Regulator {
    /// N m per rad and per rad/s.
    gain: [f64; 4],
    /// The energy of standing upright, J.
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
            upright: at(upright).energy(),
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
        let x = from_upright(pendulum.state());
        -x.iter()
            .zip(self.gain)
            .map(|(x, gain)| gain * x)
            .sum::<f64>()
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

/// The derivatives of the next state with respect to state and torque at the upright position, from central
/// differences of a step.
fn linearize() -> (Matrix, [f64; 4]) {
    const H: f64 = 1e-5;
    let next = |mut x: [f64; 4], torque| {
        x[0] += PI;
        let mut pendulum = at(x.into());
        pendulum.step(torque).expect("a finite torque");
        from_upright(pendulum.state())
    };
    let slope = |x: [f64; 4], torque: f64| {
        let (ahead, behind) = (next(x, torque), next(x.map(|x| -x), -torque));
        from_fn(|i| (ahead[i] - behind[i]) / (2.0 * H))
    };
    let columns: Matrix = from_fn(|j| slope(from_fn(|i| if i == j { H } else { 0.0 }), 0.0));
    (from_fn(|i| from_fn(|j| columns[j][i])), slope([0.0; 4], H))
}

/// The gain that minimizes Σ x² + torque², from iterating the Riccati equation to its fixed point.
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
