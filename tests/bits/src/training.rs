//! A training from untrained weights (16 KiB), and a digest of all weights after 100 episodes.

use acrobot::numpy::SeedSequence;
use learners::Budget;
use learners::task;

use crate::Digest;

/// 16 KiB.
pub type Weights = [[f32; 2]; 2048];
pub const UNTRAINED: Weights = [[0.0; 2]; 2048];
pub type Learner<'w> = task::Sarsa<'w, 2048, 20>;

/// The seed of the acrobot and of the learner's choices.
pub const SEED: u64 = 42;
/// The episodes after which the learner's schedules end.
pub const EPISODES: u32 = 200;
/// The episodes after which the weights are compared.
pub const COMPARED: u32 = 100;

/// A digest of every weight's bits.
pub fn digest(learner: &Learner) -> u64 {
    let mut digest = Digest::default();
    for weight in learner.weights().iter().flatten() {
        digest.add(weight.to_bits().into());
    }
    digest.0
}

/// Trains and returns the digest; 0 if the learner is rejected.
pub fn weights() -> u64 {
    let mut weights = UNTRAINED;
    let Ok(mut learner) = task::sarsa(Budget::Episodes(EPISODES), &mut weights) else {
        return 0;
    };
    let (mut env, mut choices) = task::training(SeedSequence::new(SEED));
    for _ in 0..COMPARED {
        task::learn(&mut learner, &mut env, &mut choices);
    }
    digest(&learner)
}

pub const WEIGHTS: u64 = 0x2bfe_b0f3_c717_1ea7;
