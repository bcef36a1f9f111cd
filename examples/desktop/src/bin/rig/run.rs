//! Shows the machine while the board controls it.

use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use acrobot::arithmetic::Damped;
use acrobot::control::mpc::Controller;
use acrobot::physics::Pendulum;
use acrobot::render::Figure;
use acrobot::{Fast, State};
use anyhow::ensure;
use clap::Args;
use wire::{Command, Load, Message};

use crate::Board;
use crate::machine::Rig;

/// A machine is upright within these angles, rad, for so long before the push and before the end,
/// s.
const UPRIGHT: f64 = 0.1;
const HELD: f64 = 1.0;
/// The time between two pictures.
const PICTURE: Duration = Duration::from_millis(50);

#[derive(Args)]
pub struct Options {
    /// How long, s. Without it until Ctrl-C; a machine that is played, 10 s.
    #[arg(long)]
    seconds: Option<f64>,
    /// After half of the time, how much a machine that is played is pushed: link 2, rad/s.
    #[arg(long, default_value_t = 6.0)]
    push: f64,
}

/// What the terminal shows.
#[derive(Default)]
struct Seen {
    torque: f32,
    state: State<f32>,
    misses: f32,
    plan_age: f32,
    load: Load,
}

pub fn run(board: &Board, options: &Options) -> anyhow::Result<()> {
    let rig = Rig::read(&board.machine)?;
    let settings = rig.settings()?;
    // Rejected here, because the board says no reason.
    Controller::<100>::new(settings)?;
    let mut figure = Pendulum::<Damped<Fast>>::new(settings.params, State::HANGING)?;
    let mut bench = board.open()?;
    let played = bench.played();
    bench.start(&Command::Control { settings, zeros: rig.zeros, played })?;

    let dt = f64::from(settings.params.dt);
    let seconds = options.seconds.unwrap_or(if played.is_some() { 10.0 } else { f64::INFINITY });
    let (half, end) = ((seconds / 2.0 / dt).round() as u32, (seconds / dt).round() as u32);
    // The tick after which the machine is upright: before the push, and after it.
    let (mut upright, mut seen, mut shown) = ([0; 2], Seen::default(), Instant::now());
    loop {
        match bench.receive()? {
            Message::Sample { tick, torque, .. } => {
                seen.torque = torque;
                if let Some(machine) = &mut bench.machine {
                    if machine.lean() > UPRIGHT {
                        let since = if tick > half { half + 1 } else { 0 };
                        upright[usize::from(tick > half)] = tick - since + 1;
                    }
                    if tick == half {
                        machine.push([0.0, options.push]);
                    }
                }
                if tick >= end {
                    break;
                }
            }
            Message::Estimate { state, misses, plan_age, load } => {
                seen = Seen { state: state.into(), misses, plan_age, load, ..seen };
                if shown.elapsed() > PICTURE && stderr().is_terminal() {
                    shown = Instant::now();
                    figure.set_state(seen.state)?;
                    let picture = Figure::of(&figure).with_torque(seen.torque).braille();
                    eprintln!("\x1b[H\x1b[2J{picture}\n{}", seen.line(bench.lost));
                }
            }
            Message::Stopped(_) => {}
        }
    }
    eprintln!("{}", seen.line(bench.lost));
    if played.is_some() {
        let Load { slowest, slices, slice_ticks, ram } = seen.load;
        let [upright_ms, again_ms] = upright.map(|ticks| (1e3 * f64::from(ticks) * dt) as u32);
        println!("real upright_ms {upright_ms}\nreal again_ms {again_ms}");
        println!("real tick_instructions {slowest}\nreal slices {slices}");
        println!("real slice_ticks {slice_ticks}\nreal ram_bytes {ram}");
        let in_time = (f64::from(half) * dt - HELD).max(0.0);
        let is_held = upright.iter().all(|ticks| f64::from(*ticks) * dt < in_time);
        ensure!(
            is_held,
            "the machine was not upright {HELD} s before the push, and before the end"
        );
    }
    Ok(())
}

impl Seen {
    fn line(&self, lost: u32) -> String {
        let Self { torque, state: State { theta1, theta2, .. }, misses, plan_age, load } = self;
        format!(
            "θ1 {theta1:5.2}, θ2 {theta2:5.2} rad, torque {torque:5.2} N m, plan {plan_age:.2} s \
             old, misses {misses:.1}, ticks lost {lost}\n\
             slowest tick {} cycles, slices of up to {} ticks",
            load.slowest, load.slice_ticks
        )
    }
}
