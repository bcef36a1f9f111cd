//! How good can any policy be? The fewest known steps to the goal from 1,000 initial states, and a
//! bound.
//!
//! ```text
//! cargo run --release -p optimum -- table
//! cargo run --release -p optimum -- bound
//! ```
//!
//! docs/optimum.md explains both.

use acrobot::arithmetic::Reference;
use acrobot::{Acrobot, State};
use clap::Parser;

mod bound;
mod certificate;
mod sequences;
mod table;
mod taylor;

/// Compares policies with short sequences of actions to the goal, and proves a bound.
#[derive(Parser)]
enum Options {
    /// Prints the mean returns of policies, of the sequences and of the bound.
    Table,
    /// Proves the bound.
    Bound,
}

/// The initial states are those of the seeds from 0 on.
const SEEDS: u32 = 1000;

fn main() -> anyhow::Result<()> {
    match Options::parse() {
        Options::Table => table::print(&sequences::load()?),
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
