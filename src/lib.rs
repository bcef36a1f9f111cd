//! Gymnasium's two-link Acrobot, without a heap, a panic or a hang, and with the same bits on a microcontroller, in a
//! browser and on a server.
//!
//! ```
//! use acrobot::{Acrobot, Action, Fast};
//!
//! let mut acrobot = Acrobot::<Fast>::new(42); // the start of Gymnasium's reset(seed=42)
//! let [cos1, sin1, cos2, sin2, dtheta1, dtheta2] = *acrobot.observation();
//! let step = acrobot.step(Action::Positive);
//! assert_eq!(step.reward, -1.0);
//! ```
//!
//! # The book
//!
//! - To begin: [on a host](guide::host), [on a chip](guide::chip), [in a page](guide::page).
//! - To understand: [the equations](guide::equations), [determinism](guide::determinism),
//!   [numbers](guide::numbers).
//! - To look up: [the README](guide::readme), with every figure, the [features](guide::readme#features) and the
//!   [examples](guide::readme#examples); the items below, each with its units and sources.
//! - To work on it: the next section, and `CONTRIBUTING.md`.
//!
#![doc = include_str!("../ARCHITECTURE.md")]
#![no_std]
#![deny(missing_docs, unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]
// No panic by construction: what could panic is refused here, outside of unit tests.
#![cfg_attr(
    not(test),
    deny(
        clippy::expect_used,
        clippy::indexing_slicing,
        clippy::panic,
        clippy::unreachable,
        clippy::unwrap_used
    )
)]

#[cfg(feature = "std")]
extern crate std;

mod acrobot;
mod action;
mod arithmetic;
mod batch;
mod bounds;
mod dynamics;
#[cfg(feature = "std")]
pub mod env;
mod error;
#[cfg(doc)]
pub mod guide;
mod lanes;
mod observation;
mod params;
#[cfg(feature = "graphics")]
mod render;
mod rk4;
mod rng;
mod seed;
#[cfg(feature = "serde")]
mod snapshot;
mod state;
mod time_limit;
mod trajectory;

#[cfg(feature = "std")]
pub use arithmetic::Host;

pub use acrobot::{Acrobot, REWARD_THRESHOLD, Step};
pub use action::Action;
pub use arithmetic::{Arithmetic, Fast, Form, Micro, Portable, Real};
pub use batch::{Autoreset, Batch, Block, Member, Observations, Output, Vectors};
pub use bounds::{bound, wrap};
pub use dynamics::{derivative, energy, mass_matrix, tip_height};
pub use error::Error;
pub use observation::Observation;
pub use params::{Dynamics, Params};
#[cfg(feature = "graphics")]
pub use render::{Figure, Theme};
pub use rk4::rk4;
pub use rng::{Pcg64, integers, uniform};
pub use seed::SeedSequence;
pub use state::{StartBounds, State};
pub use time_limit::{LimitedStep, TimeLimit};
pub use trajectory::{Trajectory, Transition};
