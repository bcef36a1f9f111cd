//! How good can any policy be? The fewest known steps to the goal from 1,000 initial states, and a
//! bound.
//!
//! ```text
//! cargo run --release -p optimum -- search
//! cargo run --release -p optimum -- table
//! cargo run --release -p optimum -- bound
//! ```
//!
//! docs/optimum.md explains all three.

use std::path::{Path, PathBuf};

use acrobot::arithmetic::Reference;
use acrobot::{Acrobot, State};
use anyhow::bail;
use clap::Parser;
use desktop::write;
use indicatif::ParallelProgressIterator;
use rayon::prelude::*;

mod beam;
mod bound;
mod certificate;
mod sequences;
mod table;
mod taylor;
mod values;

use sequences::{load, text};
use values::Values;

/// Finds short sequences of actions to the goal, compares policies with them, and proves a bound.
#[derive(Parser)]
enum Options {
    /// Searches for shorter sequences than the file has.
    Search {
        /// States that are followed at the same time.
        #[arg(long, default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(1..))]
        width: u32,
        #[arg(long, value_name = "FILE", default_value = FILE)]
        file: PathBuf,
    },
    /// Prints the mean returns of policies, of the sequences and of the bound.
    Table,
    /// Proves the bound.
    Bound,
}

const FILE: &str = "research/optimum/sequences.txt";
/// The initial states are those of the seeds from 0 on.
const SEEDS: u32 = 1000;
/// No shortest sequence is longer.
const DEPTH: usize = 100;

fn main() -> anyhow::Result<()> {
    match Options::parse() {
        Options::Search { width, file } => search(width as usize, &file),
        Options::Table => table::print(&load(Path::new(FILE))?),
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

fn search(width: usize, file: &Path) -> anyhow::Result<()> {
    let mut known = if file.exists() { load(file)? } else { vec![Vec::new(); SEEDS as usize] };
    let values = Values::compute();
    let found = (0..SEEDS).into_par_iter().progress().map(|seed| {
        let depth = known[seed as usize].len().checked_sub(1).unwrap_or(DEPTH);
        beam::search(&values, width, initial(seed.into()), depth)
    });
    let found: Vec<_> = found.collect();
    let shorter = found.iter().flatten().count();
    for (known, found) in known.iter_mut().zip(found) {
        *known = found.unwrap_or(std::mem::take(known));
    }
    if let Some(seed) = known.iter().position(Vec::is_empty) {
        bail!("no sequence found for seed {seed}, try a wider beam");
    }
    write(file, text(&known))?;
    let steps: usize = known.iter().map(Vec::len).sum();
    let mean = mean_return(steps as f64);
    println!("{shorter} shorter sequences; the mean return is {mean:.3}");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beam_without_states_and_a_missing_file_are_rejected_with_a_reason() {
        let parsed = Options::try_parse_from(["optimum", "search", "--width", "0"]);
        assert!(parsed.err().unwrap().to_string().contains("0 is not in 1.."));
        assert_eq!(load(Path::new("none.txt")).unwrap_err().to_string(), "none.txt");
    }
}
