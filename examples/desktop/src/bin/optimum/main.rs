//! How good can any policy be? The fewest known steps to the goal from 1,000 initial states, and a bound.
//!
//! ```text
//! cargo run --release -p desktop --bin optimum -- search
//! cargo run --release -p desktop --bin optimum -- table
//! cargo run --release -p desktop --bin optimum -- bound
//! ```
//!
//! `search` computes the steps to the goal on a grid of states, and follows the best states of each step from every
//! initial state. Where it finds a shorter sequence than the file has, it replaces that. `table` plays other policies
//! from the same states. `bound` proves that no policy takes fewer steps than a function of the initial state says.
//! docs/optimum.md explains all three.

use std::path::{Path, PathBuf};

use acrobot::arithmetic::Reference;
use acrobot::{Acrobot, State};
use anyhow::bail;
use clap::Parser;
use desktop::write;
use indicatif::ProgressBar;
use rayon::prelude::*;

mod beam;
mod bound;
mod certificate;
mod sequences;
mod table;
mod taylor;
mod values;

use beam::Beam;
use sequences::{load, reaches, text};
use values::{Stepper, Values};

/// Finds short sequences of actions to the goal, compares policies with them, and proves a bound.
#[derive(Parser)]
enum Options {
    /// Searches for shorter sequences than the file has.
    Search {
        /// States that are followed at the same time.
        #[arg(long, default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(1..))]
        width: u32,
        /// Cells per rad and per rad/s. The search follows only one state of each cell.
        #[arg(long, default_value_t = 10.0)]
        fineness: f32,
        #[arg(long, value_name = "FILE", default_value = FILE)]
        file: PathBuf,
    },
    /// Prints the mean returns of policies, of the sequences and of the bound.
    Table {
        #[arg(long, value_name = "FILE", default_value = FILE)]
        file: PathBuf,
    },
    /// Proves the bound.
    Bound,
}

const FILE: &str = "tests/data/optimum.txt";
/// The initial states are those of the seeds from 0 on.
const SEEDS: u32 = 1000;
/// No sequence is longer.
const DEPTH: usize = 100;

fn main() -> anyhow::Result<()> {
    match Options::parse() {
        Options::Search {
            width,
            fineness,
            file,
        } => search(width, fineness, &file),
        Options::Table { file } => table::print(&load(&file)?),
        Options::Bound => bound::prove(),
    }
}

/// The state after Gymnasium's `reset(seed=seed)`.
fn initial(seed: u64) -> State {
    Acrobot::<Reference>::new(seed).state()
}

/// The mean return, given the steps of all episodes.
fn mean_return(steps: f64) -> f64 {
    1.0 - steps / f64::from(SEEDS)
}

fn search(width: u32, fineness: f32, file: &Path) -> anyhow::Result<()> {
    let mut known = if file.exists() {
        load(file)?
    } else {
        vec![Vec::new(); SEEDS as usize]
    };
    let values = Values::compute();
    let progress = ProgressBar::new(SEEDS.into());
    let found = (0..SEEDS).into_par_iter().map(|seed| {
        let mut beam = Beam {
            width: width as usize,
            fineness,
            values: &values,
            stepper: Stepper::default(),
        };
        let depth = known[seed as usize].len().checked_sub(1).unwrap_or(DEPTH);
        let state = initial(seed.into());
        let path = beam.search(state.cast(), depth, |path| {
            reaches::<Reference>(state, path)
        });
        progress.inc(1);
        path
    });
    let found: Vec<_> = found.collect();
    progress.finish_and_clear();
    let shorter = found.iter().flatten().count();
    for (known, found) in known.iter_mut().zip(found) {
        *known = found.unwrap_or(std::mem::take(known));
    }
    if let Some(seed) = known.iter().position(Vec::is_empty) {
        bail!("no sequence found for seed {seed}, try a wider beam");
    }
    write(file, text(&known))?;
    let steps: usize = known.iter().map(Vec::len).sum();
    let states = (0..SEEDS).map(|seed| initial(seed.into()).cast());
    let values: f64 = states.map(|state| f64::from(values.at(&state))).sum();
    println!(
        "{shorter} shorter sequences; the mean return is {:.3}, and {:.3} by the values of the grid",
        mean_return(steps as f64),
        mean_return(values)
    );
    Ok(())
}
