//! Numbers without physics: the scalars, numbers side by side, matrices, and sines.

mod lanes;
pub mod matrix;
mod real;
mod simd;
pub mod sines;
mod zeros;

pub use lanes::{Lanes, Numbers};
pub(crate) use lanes::{lanes, pair, set_lanes};
pub(crate) use real::sealed;
pub use real::{Real, SinCos};
pub(crate) use simd::Kernel;
pub use simd::SimdLevel;
pub use zeros::Zeros;
