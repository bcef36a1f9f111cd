//! The bits that every target must compute: episodes, a batch, a training, a plan and drawings,
//! with digests of all their bits.
//!
//! The library's tests, the program of this crate and the firmware of `examples/cortex-m` compare
//! these digests.

#![no_std]

pub mod episodes;
pub mod oled;
pub mod plan;
pub mod training;

use acrobot::Action;
use acrobot::arithmetic::Real;

/// The policy of these episodes: torque against θ̇1, in rad/s. It reaches the goal.
pub fn against<S: Real>(dtheta1: S) -> Action {
    if dtheta1 > S::ZERO { Action::Negative } else { Action::Positive }
}

/// A digest of many bits: FNV-1a over 64-bit words instead of bytes, as in `tests/data/record.py`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(pub u64);

impl Default for Digest {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Digest {
    pub fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x100_0000_01b3);
    }
}
