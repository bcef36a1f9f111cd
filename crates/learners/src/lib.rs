//! Q(λ) with replay and tile coding learns to swing up: no heap, `f32`, bit-identical on every
//! machine.
//!
//! Section numbers refer to R. S. Sutton and A. G. Barto, *Reinforcement Learning: An
//! Introduction*, 2nd edition (2018).
//!
//! ```
//! use acrobot::numpy::SeedSequence;
//! use learners::{Budget, Memory16, QLambda, evaluation, play, training};
//!
//! let seed = SeedSequence::new(42);
//! let mut memory = Memory16::EMPTY;
//! let mut learner = QLambda::new(Budget::Episodes(200), &mut memory);
//! let mut env = training(seed.clone());
//! for _episode in 0..200 {
//!     learner.learn(&mut env);
//! }
//! let (sum, reached) = play(&mut evaluation(&seed), |state| learner.greedy(state));
//! assert!(reached && sum > -100.0);
//! ```
#![no_std]
#![forbid(unsafe_code)]

mod memory;
mod q_lambda;
mod task;
mod tiles;
mod weights;

pub use memory::{Memory, Memory16, Memory32, Memory64};
pub use q_lambda::{Budget, QLambda};
pub use task::{Env, evaluation, play, training};
pub use tiles::TileCoder;
pub use weights::LoadError;
