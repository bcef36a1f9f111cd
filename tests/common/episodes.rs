//! Sixteen fixed episodes and a digest of every bit of each. The host's tests, the firmware in
//! `examples/cortex-m` and the module in `examples/wasm-parity` share this file: promise 2.

use acrobot::{Acrobot, Action, Arithmetic, Observation, Pcg64, Real, TimeLimit};

/// FNV-1a over 64-bit words instead of bytes, as in `data/record.py`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(pub u64);

impl Digest {
    pub fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    pub fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x100_0000_01b3);
    }

    fn add_seen<A: Arithmetic>(&mut self, acrobot: &Acrobot<A>, Observation(seen): Observation) {
        for x in <[A::Scalar; 4]>::from(acrobot.state()) {
            self.add(x.to_f64().to_bits());
        }
        for x in seen {
            self.add(x.to_bits().into());
        }
    }
}

/// Every bit from the seed through the steps to the end, and of the start after it: random actions
/// in the even episodes, torque against θ̇1 in the odd ones.
pub fn digest<A: Arithmetic>(episode: u64) -> u64 {
    let mut digest = Digest::new();
    let mut acrobot = TimeLimit::v1(Acrobot::<A>::new(episode));
    let mut actions = Pcg64::new(episode);
    digest.add_seen(acrobot.inner(), acrobot.inner().observation());
    loop {
        let action = if episode.is_multiple_of(2) {
            Action::sample(&mut actions)
        } else if acrobot.inner().state().dtheta1 > A::Scalar::ZERO {
            Action::Negative
        } else {
            Action::Positive
        };
        let step = acrobot.step(action);
        digest.add_seen(acrobot.inner(), step.observation);
        digest.add(step.reward.to_bits().into());
        digest.add(u64::from(step.terminated) << 1 | u64::from(step.truncated));
        if step.ended() {
            let start = acrobot.reset();
            digest.add_seen(acrobot.inner(), start);
            return digest.0;
        }
    }
}

pub const PORTABLE: [u64; 16] = [
    0x8223_2046_106d_944e,
    0x4c89_90fa_fa91_5586,
    0xbeba_df88_0eca_4757,
    0x434a_ba86_c49d_4ba3,
    0x1e6a_94f8_d7e2_b360,
    0x3772_3ae5_0ffd_9a7a,
    0x3ca5_1abc_e12a_a977,
    0x3bed_08fd_4173_5d78,
    0x0b08_3114_5a83_5d74,
    0xa32a_0fb5_254d_7f12,
    0xd052_dfec_7efc_b6e2,
    0xd4c3_0a58_ba82_8318,
    0x56a7_bdc7_2a8d_37a2,
    0x086a_271d_193c_7438,
    0xfa1a_e515_202c_0b02,
    0xb76e_f1bf_c808_0ee6,
];
pub const FAST: [u64; 16] = [
    0xd34b_54ac_827a_ed31,
    0x8885_824b_3e27_d7c2,
    0x4694_31fc_b437_d527,
    0xaa5b_1c00_d700_63e5,
    0xcf65_5d20_bb9e_0a18,
    0x7f05_4783_dcbf_1104,
    0x29b2_df1e_bea3_5b0e,
    0x5d09_1dc7_8f23_588a,
    0x8326_4c92_eae5_fe4a,
    0x76df_7164_7675_7f36,
    0x8a1d_deb5_3ad4_31c6,
    0xb670_2f3f_3aa5_7eec,
    0xa791_b098_6468_0fbf,
    0xa973_c0c4_4bd8_1414,
    0x315e_bded_4818_3251,
    0x0c80_57ef_449a_00d0,
];
pub const MICRO: [u64; 16] = [
    0x46bb_fa7f_eb02_d426,
    0x52c4_2346_d443_0356,
    0x5569_c8af_1572_3d11,
    0x19e8_5d36_80b2_1a82,
    0x6335_5505_c6ee_a805,
    0x0318_b165_531f_a677,
    0xa8b6_a5a3_b1ea_31bf,
    0x56b8_3f2c_c7f0_66ac,
    0x3065_eeed_30b5_58f1,
    0x667b_ad90_2bd3_ab9d,
    0x89e0_4b67_9d75_e282,
    0x8cd4_5acb_2f7a_84aa,
    0x1e99_2e15_2495_7e9e,
    0xdb9b_2833_d4ae_59b2,
    0xe688_4f5f_57c3_3865,
    0x7a79_730d_23ae_8970,
];
