//! Gymnasium's `Acrobot-v1`, the two-link swing-up task, as a `no_std` crate that needs no heap and
//! never panics. An episode has the same bits on a microcontroller, in a browser and on a server.
//!
#![doc = include_str!("../docs/episode.svg")]
//!
//! ```
//! use acrobot::{Acrobot, Action, Fast, TimeLimit};
//!
//! let mut env = TimeLimit::with_task_limit(Acrobot::<Fast>::new(0)); // gym.make("Acrobot-v1")
//! let mut observation = env.reset_with_seed(42); // env.reset(seed=42)
//! loop {
//!     // Torque against the velocity of link 1.
//!     let [.., dtheta1, _] = observation;
//!     let action = match dtheta1 > 0.0 {
//!         true => Action::Negative,
//!         false => Action::Positive,
//!     };
//!     let step = env.step(action);
//!     if step.is_done() {
//!         break;
//!     }
//!     observation = step.observation;
//! }
//! assert_eq!(env.elapsed_steps(), 94);
//! ```
//!
//! [Control](guide::control#swing-up-by-a-plan) swings it up by a plan and holds it upright.
//!
//! Get started [in Rust](guide::rust), [on a microcontroller](guide::embedded), [in C](guide::c),
//! [in a browser](guide::wasm) or [in Python](guide::python).
//!
//! [`Acrobot`] is the environment. Its type parameters are the arithmetic, which is [`Fast`]
//! (`f32`), [`Portable`] (`f64`), or [another one](arithmetic), and the [task](task). A [`Step`]
//! has the [observation](task::Gymnasium#associatedtype.Observation). [`physics`] has the model,
//! [`control`] regulates it and plans. [`batch`] has many acrobots at once. The [`guide`] has a
//! page for each reader and each subject.
//!
//! # Features
//!
//! None is on by default. Features are additive and never change a result.
//!
//! - `alloc` adds a batch that owns its memory.
//! - `std` enables `alloc` and `graphics`, and adds `env`, the arithmetic `Host`, and batches with
//!   AVX2 or AVX-512.
//! - `graphics` adds `render`.
//! - `rayon` enables `std`, and adds batches on all cores.
//! - `serde` adds snapshots, whose version, task and arithmetic are checked when
//!   loaded.
//! - `defmt` adds `defmt::Format` for all public types except those of `env` and batches.
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
    "acrobot needs SSE2 on 32-bit x86: without it the FPU computes in 80 bits, and results are \
    wrong. Compile for i686 instead of i586."
);

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

mod acrobot;
mod action;
pub mod arithmetic;
pub mod batch;
pub mod control;
#[cfg(feature = "std")]
pub mod env;
mod error;
#[cfg(doc)]
pub mod guide;
mod math;
pub mod numpy;
pub mod physics;
#[cfg(feature = "graphics")]
pub mod render;
#[cfg(feature = "serde")]
mod snapshot;
pub mod task;
mod time_limit;
pub mod trajectory;

pub use acrobot::{Acrobot, REWARD_THRESHOLD, Step};
pub use action::Action;
pub use arithmetic::{Fast, Portable};
pub use error::Error;
pub use physics::{Params, State};
/// The traits of generators, in the version of this crate: 0.10.
#[doc(no_inline)]
pub use rand_core;
pub use task::ResetOptions;
pub use time_limit::TimeLimit;
