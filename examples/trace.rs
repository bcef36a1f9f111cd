//! Replays actions and prints every bit of the states, to compare them with another implementation.
//!
//! ```text
//! echo 0 1 2 2 2 | cargo run --release --features std --example trace -- --seed 42
//! ```
//!
//! The first line is the initial state and every other line a step: the bits of θ1, θ2, θ̇1 and θ̇2 as f64, then the
//! reward and whether the state is in the goal. Steps past the goal continue.

use std::error::Error;
use std::io::{self, BufWriter, Read, Write};
use std::process::ExitCode;

use acrobot::arithmetic::{Arithmetic, Host, Micro, Real, Reference};
use acrobot::numpy::SeedSequence;
use acrobot::physics::{Dynamics, ResetBounds};
use acrobot::{Acrobot, Action, Fast, Params, Portable, ResetOptions, State};
use clap::{Parser, ValueEnum};
use examples_common::exit;

/// Reads actions (digits 0, 1 and 2; white space is ignored) from standard input and prints the
/// bits of each state.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Seed of the initial state and of the torque noise: a decimal integer of any size.
    #[arg(long)]
    seed: SeedSequence,
    /// Lower bound of the initial state, rad and rad/s.
    #[arg(long, default_value_t = ResetBounds::DEFAULT.low(), allow_hyphen_values = true)]
    low: f64,
    /// Upper bound of the initial state, rad and rad/s.
    #[arg(long, default_value_t = ResetBounds::DEFAULT.high(), allow_hyphen_values = true)]
    high: f64,
    /// Equations of motion.
    #[arg(long, value_enum, default_value = "book")]
    dynamics: DynamicsName,
    /// Torque noise, N m.
    #[arg(long, default_value_t = Params::DEFAULT.torque_noise, allow_hyphen_values = true)]
    noise: f64,
    /// Duration of a step, s.
    #[arg(long, default_value_t = Params::DEFAULT.dt, allow_hyphen_values = true)]
    dt: f64,
    /// Arithmetic of the steps.
    #[arg(long, value_enum, default_value = "host")]
    arithmetic: ArithmeticName,
}

#[derive(Clone, Copy, ValueEnum)]
enum DynamicsName {
    Book,
    Nips,
}

#[derive(Clone, Copy, ValueEnum)]
enum ArithmeticName {
    Host,
    Reference,
    Portable,
    Fast,
    Micro,
}

fn main() -> ExitCode {
    exit::run(|options: &Options| match options.arithmetic {
        ArithmeticName::Host => trace::<Host>(options),
        ArithmeticName::Reference => trace::<Reference>(options),
        ArithmeticName::Portable => trace::<Portable>(options),
        ArithmeticName::Fast => trace::<Fast>(options),
        ArithmeticName::Micro => trace::<Micro>(options),
    })
}

/// The longest input in bytes, which is kept in memory.
const MOST: u64 = 1 << 26;

/// Reads and checks everything before it prints the first line.
fn trace<A: Arithmetic>(options: &Options) -> Result<(), Box<dyn Error>> {
    let bounds = ResetBounds::new(options.low, options.high)?;
    let params = Params {
        dt: options.dt,
        torque_noise: options.noise,
        dynamics: match options.dynamics {
            DynamicsName::Book => Dynamics::Book,
            DynamicsName::Nips => Dynamics::Nips,
        },
        ..Params::DEFAULT
    };
    params.validate()?;
    let mut acrobot = Acrobot::<A>::new(0);
    // Checked again, because f32 can round a valid number to 0 or to infinity.
    let rounded = acrobot.set_params(params.cast());
    rounded.map_err(|error| format!("rounded to the arithmetic's f32, {error}"))?;
    let mut input = Vec::new();
    let read = io::stdin().take(MOST + 1).read_to_end(&mut input);
    read.map_err(|error| format!("cannot read standard input: {error}"))?;
    if input.len() as u64 > MOST {
        return Err(format!("the input must have at most {MOST} bytes, got more").into());
    }
    let actions = parse(&input)?;

    acrobot.reset_with(ResetOptions {
        seed: Some(options.seed.clone()),
        bounds: Some(bounds),
    });
    let out = BufWriter::new(io::stdout().lock());
    Ok(print(&mut acrobot, &actions, out)?)
}

/// White space in Python but not in Rust.
const VERTICAL_TAB: u8 = 0x0b;

/// The actions of an input, or an error with the first other byte.
fn parse(input: &[u8]) -> Result<Vec<Action>, String> {
    let bytes = input
        .iter()
        .zip(1..)
        .filter(|(byte, _)| !(byte.is_ascii_whitespace() || **byte == VERTICAL_TAB));
    bytes
        .map(|(&byte, position)| {
            let action = Action::try_from(byte.wrapping_sub(b'0'));
            action.map_err(|_| {
                let found = byte.escape_ascii();
                format!("the input must be actions (0, 1 and 2) and white space, got '{found}' as byte {position}")
            })
        })
        .collect()
}

fn print<A: Arithmetic>(
    acrobot: &mut Acrobot<A>,
    actions: &[Action],
    mut out: impl Write,
) -> io::Result<()> {
    writeln!(out, "{}", words(acrobot.state()))?;
    for &action in actions {
        let step = acrobot.step(action);
        let terminated = u8::from(step.terminated);
        writeln!(
            out,
            "{} {} {terminated}",
            words(acrobot.state()),
            step.reward
        )?;
    }
    out.flush()
}

fn words<S: Real>(state: State<S>) -> String {
    let [a, b, c, d] = <[S; 4]>::from(state).map(|x| x.to_f64().to_bits());
    format!("{a:016x} {b:016x} {c:016x} {d:016x}")
}
