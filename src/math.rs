//! Numbers without physics: the scalars, numbers side by side, and sines.

mod lanes;
mod real;
mod simd;
pub mod sines;

pub use lanes::{Lanes, Numbers};
pub(crate) use real::sealed;
pub use real::{Real, SinCos};
pub(crate) use simd::Kernel;
pub use simd::SimdLevel;
