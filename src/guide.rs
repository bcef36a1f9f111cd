//! The book: how to begin, and what the numbers mean.
//!
//! It is there for readers alone; no code can import it. Its pages are in `docs/`.

#[doc = include_str!("../docs/host.md")]
pub mod host {}

#[doc = include_str!("../docs/chip.md")]
pub mod chip {}

#[doc = include_str!("../docs/page.md")]
pub mod page {}

#[doc = include_str!("../docs/equations.md")]
pub mod equations {}

#[doc = include_str!("../docs/determinism.md")]
pub mod determinism {}

#[doc = include_str!("../docs/numbers.md")]
pub mod numbers {}

#[doc = include_str!("../README.md")]
pub mod readme {}
