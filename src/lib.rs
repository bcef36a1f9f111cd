#![doc = include_str!("../README.md")]
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
