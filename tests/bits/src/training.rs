//! A training from untrained weights (16 KiB), and a digest of all weights after 100 episodes.

use acrobot::numpy::SeedSequence;
use learners::{Budget, Env, Memory16, QLambda};

use crate::Digest;

pub type Learner<'w> = QLambda<'w, 1408, 16>;

/// The seed of the acrobot.
const SEED: u64 = 42;
/// The episodes over which the learner's step size falls.
pub const EPISODES: u32 = 200;
/// The episodes after which the weights are compared.
pub const COMPARED: u32 = 100;

/// An untrained learner.
pub fn learner(memory: &mut Memory16) -> Learner<'_> {
    QLambda::new(Budget::Episodes(EPISODES), memory)
}

/// The acrobot of the training.
pub fn env() -> Env {
    learners::training(SeedSequence::new(SEED))
}

/// The acrobot on which the policy is evaluated.
pub fn evaluation() -> Env {
    learners::evaluation(&SeedSequence::new(SEED))
}

/// A digest of every weight's bits.
pub fn digest(learner: &Learner) -> u64 {
    let mut digest = Digest::default();
    for weight in learner.weights().iter().flatten() {
        digest.add(weight.to_bits().into());
    }
    digest.0
}

/// Trains and returns the digest.
pub fn weights() -> u64 {
    let mut memory = Memory16::EMPTY;
    let (mut learner, mut env) = (learner(&mut memory), env());
    for _ in 0..COMPARED {
        learner.learn(&mut env);
    }
    digest(&learner)
}

pub const WEIGHTS: u64 = 0x196a_2cdc_caa6_d063;
