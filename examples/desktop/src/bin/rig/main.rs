//! Measures and controls a machine at a board with the firmware `real` of `examples/cortex-m`.
//!
//! ```text
//! cargo run --release -p desktop --bin rig -- record drawn.toml /dev/ttyACM0 recording.csv
//! cargo run --release -p desktop --bin rig -- identify drawn.toml recording.csv machine.toml
//! cargo run --release -p desktop --bin rig -- run machine.toml /dev/ttyACM0
//! ```
//!
//! With `--play truth.toml` it plays a machine of these parameters for the board, which then uses
//! neither its encoders nor its motor. docs/real.md explains all.

mod bench;
mod identify;
mod line;
mod machine;
mod run;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use ::machine::Machine;
use anyhow::bail;
use clap::{Args, Parser};
use desktop::write;
use wire::{Command, Message};

use crate::bench::Bench;
use crate::line::Line;
use crate::machine::Rig;

/// Measures and controls a machine at a board.
#[derive(Parser)]
enum Options {
    /// Shakes the machine and writes what the encoders count.
    Record {
        #[command(flatten)]
        board: Board,
        /// The recording to write.
        recording: PathBuf,
        /// How long, s.
        #[arg(long, default_value_t = 10.0)]
        seconds: f32,
        /// The largest torque, as a part of the motor's.
        #[arg(long, default_value_t = 0.3)]
        part: f32,
    },
    /// Finds the parameters of a machine in a recording. Lengths and centres of mass must be right.
    Identify {
        /// The machine as it was drawn.
        drawn: PathBuf,
        recording: PathBuf,
        /// The file to write for `run`, and beside it the parameters in .rs and .h.
        out: PathBuf,
    },
    /// Swings the machine up and holds it, and shows it.
    Run {
        #[command(flatten)]
        board: Board,
        #[command(flatten)]
        run: run::Options,
    },
}

#[derive(Args)]
struct Board {
    /// The machine.
    machine: PathBuf,
    /// A serial port, or after `exec:` a program whose input and output are the line.
    port: String,
    #[arg(long, default_value_t = 1_000_000)]
    baud: u32,
    /// Play this machine for the board.
    #[arg(long, value_name = "MACHINE")]
    play: Option<PathBuf>,
    /// Draws the torques of `record`, and the errors of a machine that is played.
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

impl Board {
    fn open(&self) -> anyhow::Result<Bench> {
        let play = |path: &PathBuf| {
            let hardware = Rig::read(path)?.hardware()?;
            Ok::<_, anyhow::Error>(Machine::new(hardware, self.seed)?)
        };
        let played = self.play.as_ref().map(play).transpose()?;
        Ok(Bench::new(Line::open(&self.port, self.baud)?, played))
    }
}

fn record(board: &Board, recording: &Path, seconds: f32, part: f32) -> anyhow::Result<()> {
    let settings = Rig::read(&board.machine)?.settings()?;
    let (dt, most) = (settings.params.dt, part * settings.limit);
    let mut bench = board.open()?;
    let (seed, played) = (board.seed, bench.played());
    bench.start(&Command::Record { seed, dt, most, played })?;
    let (ticks, mut csv) = ((seconds / dt).round() as u32, format!("{}\n", identify::HEAD));
    let (ticks, half_second) = (ticks.max(1), ((0.5 / dt) as u32).max(1));
    loop {
        let Message::Sample { tick, counts: [count1, count2], torque } = bench.receive()? else {
            continue;
        };
        writeln!(csv, "{count1},{count2},{torque}")?;
        if bench.lost > 0 {
            bail!("a tick was lost before tick {tick}: take a higher baud rate or a longer `dt`");
        }
        if tick.is_multiple_of(half_second) {
            eprint!("\r{:3} %", 100 * (tick + 1) / ticks);
        }
        if tick + 1 >= ticks {
            eprintln!("\r100 %");
            return write(recording, csv);
        }
    }
}

fn main() -> anyhow::Result<()> {
    match Options::parse() {
        Options::Record { board, recording, seconds, part } => {
            record(&board, &recording, seconds, part)
        }
        Options::Identify { drawn, recording, out } => {
            identify::identify(Rig::read(&drawn)?, &recording, &out)
        }
        Options::Run { board, run } => run::run(&board, &run),
    }
}
