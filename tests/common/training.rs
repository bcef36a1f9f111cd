//! A training from nothing in 16 KiB of weights, and a digest of all of them after 100 episodes. The host's tests, the
//! firmware `learn` in `examples/cortex-m` and the module in `examples/wasm-parity` share this file: promise 2.

use super::digest::Digest;

#[allow(dead_code, reason = "each program uses a part")]
#[path = "../../examples/sarsa/acrobot_task.rs"]
pub mod acrobot_task;

/// 16 KiB.
pub type Weights = [[f32; 2]; 2048];
pub const UNTRAINED: Weights = [[0.0; 2]; 2048];
pub type Learner<'w> = acrobot_task::Learner<'w, 2048, 20>;

/// Of the acrobot and of the learner's choices.
pub const SEED: u64 = 42;
/// To learn in.
pub const EPISODES: u32 = 200;
/// After so many the weights are compared.
pub const COMPARED: u32 = 100;

/// A digest of every weight's bits.
pub fn digest(learner: &Learner) -> u64 {
    let mut digest = Digest::new();
    for weight in learner.weights().iter().flatten() {
        digest.add(weight.to_bits().into());
    }
    digest.0
}

/// Trains and returns the digest; 0 where the learner is refused.
#[allow(
    dead_code,
    reason = "the firmware has a loop of its own, which reports"
)]
pub fn weights() -> u64 {
    let mut weights = UNTRAINED;
    let Ok(mut learner) = acrobot_task::Preset::Fast.learner(EPISODES, &mut weights) else {
        return 0;
    };
    let (mut env, mut choices) = acrobot_task::training(SEED.into());
    for _ in 0..COMPARED {
        acrobot_task::learn(&mut learner, &mut env, &mut choices);
    }
    digest(&learner)
}

pub const WEIGHTS: u64 = 0x2bfe_b0f3_c717_1ea7;
