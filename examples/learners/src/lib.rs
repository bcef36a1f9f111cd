//! Sarsa(λ), and Q(λ) with replay, with tile coding: no heap, `f32`, bit-identical on every machine.
//!
//! It uses only sums, differences, products, quotients and comparisons, each rounded once, so a laptop, a Cortex-M4F
//! and a browser learn the same weights from the same seed. Section numbers refer to R. S. Sutton and A. G. Barto,
//! *Reinforcement Learning: An Introduction*, 2nd edition (2018).
//!
//! ```
//! use rand_pcg::Pcg32;
//! use learners::{Dimension, Group, Learn as _, Sarsa, Schedule, Settings, Symmetry, Table, TileCoder, displacement};
//!
//! // One number in [0, 1], 4 tilings of 8 intervals; two actions: towards 0 and towards 1, which is the goal.
//! let line = [Dimension::bounded(0.0, 1.0, 8)];
//! let coder = TileCoder::<1, 4>::new(line, &[Group::new(&[0], 4)], Table::Direct, displacement)?;
//! let settings = Settings {
//!     gamma: 1.0,
//!     lambda: 0.9,
//!     alpha: Schedule::constant(0.5),
//!     epsilon: Schedule::constant(0.0),
//!     symmetry: Symmetry::None,
//! };
//! let mut weights = [[0.0; 2]; 36];
//! let mut agent = Sarsa::new(coder, settings, &mut weights)?;
//! let mut rng = Pcg32::new(1, 1);
//! let mut steps = 0;
//! for _episode in 0..20 {
//!     let mut x = 0.5_f32;
//!     let mut action = agent.start(&[x], &mut rng);
//!     steps = 1;
//!     loop {
//!         x = if action == 0 { (x - 0.1).max(0.0) } else { x + 0.1 };
//!         if x >= 0.95 {
//!             agent.end(0.0);
//!             break;
//!         }
//!         action = agent.step(-1.0, &[x], &mut rng);
//!         steps += 1;
//!     }
//! }
//! assert_eq!(steps, 5);
//! # Ok::<(), learners::Error>(())
//! ```
#![no_std]
#![forbid(unsafe_code)]

mod error;
mod learn;
mod q_lambda;
mod sarsa;
mod schedule;
mod store;
pub mod task;
mod tiles;
mod traces;
mod values;

pub use error::{Error, LoadError};
pub use learn::Learn;
pub use q_lambda::{QLambda, Transition};
pub use sarsa::Sarsa;
pub use schedule::{Budget, Schedule};
pub use tiles::{Dimension, Group, Place, Table, TileCoder, displacement};
pub use values::{Features, Settings, Symmetry, Values};
