//! Numbers without physics: the scalars, numbers side by side, and sines.

mod lanes;
mod real;
pub mod sines;

pub use lanes::{Lanes, Numbers};
pub(crate) use real::sealed;
pub use real::{Real, SinCos};
