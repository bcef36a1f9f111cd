//! The bits that every target must compute: episodes, a batch, a training, a plan and drawings,
//! with digests of all their bits. `tests/results.rs` records the rest of control, which the tests
//! of C compare, also on a Cortex-M4F.
//!
//! The library's tests, the program of this crate and the firmware of `examples/cortex-m` compare
//! these digests.

#![no_std]

pub mod episodes;
pub mod oled;
pub mod plan;
pub mod training;

use acrobot::arithmetic::{Damped, Micro, Real, Reference};
use acrobot::task::{Balance, Swingup};
use acrobot::{Action, Fast, Portable};

use episodes::*;

/// Calls `report` with the name, the digests and the recorded digests of each.
pub fn compare(mut report: impl FnMut(&str, &[u64], &[u64])) {
    report("Reference", &[sixteen::<Reference>()], &[REFERENCE]);
    report("Portable", &[sixteen::<Portable>()], &[PORTABLE]);
    report("Fast", &[sixteen::<Fast>()], &[FAST]);
    report("Micro", &[sixteen::<Micro>()], &[MICRO]);
    let [reference, portable] = [subnormal::<Reference>(), subnormal::<Portable>()];
    let found = [reference, portable, subnormal::<Fast>(), subnormal::<Micro>()];
    report("subnormal numbers", &found, &SUBNORMAL);
    report("friction", &[damped::<Damped<Reference>>(), damped::<Damped<Fast>>()], &DAMPED);
    let found = [task::<Damped<Reference>, Swingup>(), task::<Damped<Fast>, Swingup>()];
    report("swing-up", &found, &SWINGUP);
    report("balance", &[task::<Reference, Balance>(), task::<Fast, Balance>()], &BALANCE);
    report("batches of 1 lane", &batches::<1, 20, 8>(), &BATCHES);
    report("batches of 4 lanes", &batches::<4, 5, 2>(), &BATCHES);
    // More of them do not fit into 256 KiB of flash.
    report("batch of 8 lanes", &[shared_params::<8, 3>()], &BATCHES[..1]);
    // The learner and the plan do not fit into 16 KiB of RAM. The firmware `learn` and `balance`
    // compare them.
    if !cfg!(target_os = "none") {
        report("training", &[training::weights()], &[training::WEIGHTS]);
        report("plan", &[plan::planned()], &[plan::PLAN]);
    }
}

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
