//! Code that the benchmarks share: bare loops as yardsticks, and a random policy for batches.

mod loops;
mod measured;
mod play;

pub use loops::{Lanes, bare_f32, bare_f64};
pub use measured::measured;
pub use play::{Play, draw};
