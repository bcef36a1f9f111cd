//! The book: how to begin, and what the numbers mean. It is documentation only.
//!
//! A first step, explained in [Rust](rust):
//!
//! ```
//! use acrobot::{Acrobot, Action, Fast};
//!
//! let step = Acrobot::<Fast>::new(42).step(Action::Positive);
//! assert!(!step.done());
//! ```

// Where examples of a page need a feature, `cargo test` without it leaves the page out.

#[cfg_attr(
    any(not(doctest), all(feature = "std", feature = "serde")),
    doc = include_str!("../docs/rust.md")
)]
pub mod rust {}

#[cfg_attr(any(not(doctest), feature = "serde"), doc = include_str!("../docs/embedded.md"))]
pub mod embedded {}

#[doc = include_str!("../docs/wasm.md")]
pub mod wasm {}

#[doc = include_str!("../docs/equations.md")]
pub mod equations {}

#[doc = include_str!("../docs/determinism.md")]
pub mod determinism {}

#[doc = include_str!("../docs/numbers.md")]
pub mod numbers {}

#[doc = include_str!("../ARCHITECTURE.md")]
pub mod architecture {}

// For its tests only: its links and pictures lead into the repository.
#[cfg(doctest)]
#[cfg_attr(feature = "std", doc = include_str!("../README.md"))]
pub mod readme {}
