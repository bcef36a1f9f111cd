//! Sixteen fixed episodes and a digest of every bit of each. The tests here, the firmware in `examples/cortex-m` and the
//! module in `examples/wasm-parity` share this file: promise 2.

use super::digest::Digest;
use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::batch::{Autoreset, Batch, Block, Observations, StepBuffers};
use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, Observation, TimeLimit};

/// Adds every bit of the state and of the observation.
fn add_seen<A: Arithmetic>(digest: &mut Digest, acrobot: &Acrobot<A>, seen: Observation) {
    for x in <[A::Scalar; 4]>::from(acrobot.state()) {
        digest.add(x.to_f64().to_bits());
    }
    for x in seen.to_array() {
        digest.add(x.to_bits().into());
    }
}

/// Every bit of one episode, from its initial state to its end, and of the next initial state. Even episodes have random
/// actions, odd ones torque against θ̇1.
pub fn digest<A: Arithmetic>(episode: u64) -> u64 {
    let mut digest = Digest::new();
    let mut acrobot = TimeLimit::v1(Acrobot::<A>::new(episode));
    let mut actions = Pcg64::new(episode);
    add_seen(&mut digest, acrobot.inner(), acrobot.inner().observation());
    loop {
        let action = if episode.is_multiple_of(2) {
            Action::sample(&mut actions)
        } else if acrobot.inner().state().dtheta1 > A::Scalar::ZERO {
            Action::Negative
        } else {
            Action::Positive
        };
        let step = acrobot.step(action);
        add_seen(&mut digest, acrobot.inner(), step.observation);
        digest.add(step.reward.to_bits().into());
        digest.add(u64::from(step.terminated) << 1 | u64::from(step.truncated));
        if step.done() {
            let start = acrobot.reset();
            add_seen(&mut digest, acrobot.inner(), start);
            return digest.0;
        }
    }
}

/// Every bit that a batch of twenty in `Fast` returns in 200 steps under torque against θ̇1, which ends episodes. It is
/// the same for any width `N`.
#[inline(never)] // one after the other, in 16 KiB
pub fn batch<const N: usize, const BLOCKS: usize>() -> u64 {
    const LEN: usize = 20;
    let (blocks, generators) = ([Block::EMPTY; BLOCKS], [Pcg64::UNSEEDED; LEN]);
    let Ok(mut batch) = Batch::<Fast, _, _, N>::new(42, blocks, generators) else {
        return 0;
    };
    batch.set_autoreset(Autoreset::SameStep);
    let mut digest = Digest::new();
    let (mut rewards, mut terminated, mut truncated) = ([0.0; LEN], [false; LEN], [false; LEN]);
    let (mut rows, mut finals) = ([[0.0; 6]; LEN], [[0.0; 6]; LEN]);
    for _ in 0..200 {
        let actions = rows.map(|[.., dtheta1, _]| match dtheta1 > 0.0 {
            true => Action::Negative,
            false => Action::Positive,
        });
        let buffers = StepBuffers {
            rewards: &mut rewards,
            terminated: &mut terminated,
            truncated: &mut truncated,
            observations: Observations::Rows(&mut rows),
            final_observations: Observations::Rows(&mut finals),
        };
        if batch.step(&actions, buffers).is_err() {
            return 0;
        }
        let seen = rows.iter().chain(&finals).flatten().chain(&rewards);
        seen.for_each(|x| digest.add(x.to_bits().into()));
        terminated.iter().for_each(|&x| digest.add(x.into()));
    }
    digest.0
}

pub const BATCH: u64 = 0xeae8_bc44_fb2b_ab5e;

pub const PORTABLE: [u64; 16] = [
    0x229b_1c42_16f9_1d85,
    0x0ef8_857a_6f61_c07c,
    0x5abd_7ae2_1dd1_3a13,
    0x5704_fc10_725a_9083,
    0x7e6a_1d34_2231_5080,
    0x7041_c024_a0e1_598e,
    0xd436_7a04_95e2_0379,
    0x8d08_7930_6383_2466,
    0x46fe_3ded_0e21_02a3,
    0x9db1_6113_cb30_3e01,
    0x1730_3de4_5b6a_9d5c,
    0xc320_1dbd_dc23_9411,
    0xbb8c_d534_50fb_3c19,
    0x683c_43b5_4b73_5081,
    0x2841_88f0_8b86_29d2,
    0xd19e_9c9f_9ea6_38ae,
];
pub const FAST: [u64; 16] = [
    0xa0f2_48e0_a096_4e5e,
    0x5d8d_ef03_d7b1_356a,
    0x5c68_e56a_db61_e0bb,
    0xaeb1_f46b_83d3_eb96,
    0x549d_7292_3fbf_b62f,
    0xcda3_a90b_ef1d_b8b5,
    0x9ab1_6d5c_afdf_78ec,
    0x82f4_200b_dc4f_48b4,
    0x119c_3901_757b_39eb,
    0xacc2_491c_6f29_603a,
    0x772d_c2e8_35fd_0d55,
    0xcd30_724f_d0de_9c29,
    0x7a45_677e_dcc5_b567,
    0x89cf_002d_68f0_1a07,
    0x92b4_9274_9578_9170,
    0xca8f_2fe9_54b2_2733,
];
pub const MICRO: [u64; 16] = [
    0x80b5_5cda_994d_906d,
    0xfd9a_26c5_8dbf_dfd2,
    0xe974_b345_20a1_ea9d,
    0xeefd_ec91_9636_7234,
    0x735d_a6d6_acfa_64bf,
    0x21a2_ee5d_af74_e2b4,
    0xc7f1_3659_ce4b_25b1,
    0x6629_9bd0_fcba_77eb,
    0x023f_97a7_2002_9a81,
    0x3ea0_3dea_270f_a6d6,
    0x25d5_1bd3_b25d_299d,
    0x7aa1_ed34_3de0_09a5,
    0x0b0a_e4e7_6f06_370c,
    0xf38c_f8c7_9cdb_c59f,
    0xce74_2a79_e838_f1da,
    0x9e60_c410_dbe6_2ec1,
];
