//! The bits that every target must compute: episodes, a batch, a training, a plan and drawings, with digests of all their bits.
//!
//! The library's tests compare these digests on the build machine, and the program of this crate compares them on any
//! target. The firmware of `examples/cortex-m` compares them while it draws, learns and plans.

#![no_std]

mod digest;
pub mod episodes;
pub mod oled;
pub mod plan;
pub mod training;

pub use digest::Digest;

use acrobot::Action;
use acrobot::arithmetic::Real;

/// The policy of these episodes: torque against θ̇1, in rad/s. It reaches the goal.
pub fn against<S: Real>(dtheta1: S) -> Action {
    if dtheta1 > S::ZERO {
        Action::Negative
    } else {
        Action::Positive
    }
}
