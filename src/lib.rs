//! Gymnasium's two-link Acrobot without a heap, a panic or a hang, bit-identical on microcontrollers, in browsers and on
//! servers.
//!
//! ```
//! use acrobot::{Acrobot, Action, Fast};
//!
//! let mut acrobot = Acrobot::<Fast>::new(42); // the state after Gymnasium's reset(seed=42)
//! let velocity = acrobot.observation().dtheta1(); // rad/s
//! let step = acrobot.step(Action::Positive);
//! assert_eq!(step.reward, -1.0);
//! ```
//!
//! # Where to go
//!
//! - Begin: [in Rust](guide::rust), [on a microcontroller](guide::embedded), [in a browser](guide::wasm).
//! - [`arithmetic`] chooses the bits, [`physics`] is the pendulum alone, [`batch`] steps many acrobots with SIMD,
//!   [`numpy`] has Gymnasium's random numbers, [`trajectory`] records steps, `render` (feature `graphics`) draws, and `env`
//!   (feature `std`) has Gymnasium's `make`, spaces and wrappers.
//! - Understand: [the equations](guide::equations), [determinism](guide::determinism), [numbers](guide::numbers).
//! - All figures, the features and the examples: the repository's README.
//! - Contribute: [the architecture](guide::architecture).
#![no_std]
#![deny(missing_docs, unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]
// No panic by construction: code that could panic does not compile, except in unit tests.
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

#[cfg(all(target_arch = "x86", not(target_feature = "sse2")))]
compile_error!(
    "acrobot needs SSE2 on 32-bit x86: without it the FPU computes in 80 bits, and results are wrong. \
    Compile for i686 instead of i586."
);

#[cfg(feature = "std")]
extern crate std;

mod acrobot;
mod action;
pub mod arithmetic;
pub mod batch;
#[cfg(feature = "std")]
pub mod env;
mod error;
#[cfg(doc)]
pub mod guide;
pub mod numpy;
mod observation;
pub mod physics;
#[cfg(feature = "graphics")]
pub mod render;
#[cfg(feature = "serde")]
mod snapshot;
mod time_limit;
pub mod trajectory;

pub use acrobot::{Acrobot, REWARD_THRESHOLD, ResetOptions, Step};
pub use action::Action;
pub use arithmetic::{Fast, Portable};
pub use error::Error;
pub use observation::Observation;
pub use physics::{Params, State};
pub use time_limit::TimeLimit;
