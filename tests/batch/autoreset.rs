//! Resets are pending only in mode `NextStep`, also those of members that `set_member` placed in the batch.

use acrobot::batch::{Autoreset, Member, VecBatch};
use acrobot::numpy::SeedSequence;
use acrobot::physics::ResetBounds;
use acrobot::{Fast, Params};

/// One acrobot with noise, and with reset bounds that tell its initial states from others.
fn one(autoreset: Autoreset) -> VecBatch<Fast> {
    let mut batch = VecBatch::new(SeedSequence::new(42), 1).unwrap();
    let noisy = Params {
        torque_noise: 1.0,
        ..Params::default()
    };
    batch.set_params(noisy).unwrap();
    batch.set_reset_bounds(ResetBounds::new(0.5, 0.6).unwrap());
    batch.set_autoreset(autoreset);
    batch
}

fn pending() -> Member<Fast> {
    Member {
        reset_pending: true,
        elapsed: 7,
        ..one(Autoreset::NextStep).member(0).unwrap()
    }
}

/// The acrobot is in an initial state, and its reset is not pending.
fn assert_reset(batch: VecBatch<Fast>) {
    let initial = batch.member(0).unwrap();
    assert!((0.5..0.6).contains(&initial.state.theta1), "{initial:?}");
    assert_eq!(initial.elapsed, 0);
    assert_steps(batch);
}

/// The reset is not pending: a step counts and draws noise.
fn assert_steps(mut batch: VecBatch<Fast>) {
    let before = batch.member(0).unwrap();
    assert!(!before.reset_pending);
    batch.step(&[1_u8]).unwrap();
    let stepped = batch.member(0).unwrap();
    assert_eq!(
        (stepped.elapsed, stepped.reset_pending),
        (before.elapsed + 1, false)
    );
    assert_ne!(stepped.rng, before.rng, "no noise was drawn");
}

#[test]
fn a_pending_member_is_reset_immediately_in_mode_same_step() {
    let mut batch = one(Autoreset::SameStep);
    batch.set_member(0, pending()).unwrap();
    assert_reset(batch);

    let mut batch = one(Autoreset::NextStep);
    batch.set_member(0, pending()).unwrap();
    assert_eq!(batch.member(0), Some(pending()));
}

#[test]
fn a_pending_acrobot_is_reset_when_the_mode_becomes_same_step() {
    let mut batch = one(Autoreset::NextStep);
    batch.set_member(0, pending()).unwrap();
    batch.set_autoreset(Autoreset::SameStep);
    assert_reset(batch);
}

/// In mode `Disabled` an acrobot whose reset is pending continues from its state, whether `set_member` placed it or the mode changed.
#[test]
fn a_pending_acrobot_continues_in_mode_disabled() {
    let mut put = one(Autoreset::Disabled);
    put.set_member(0, pending()).unwrap();
    let mut changed = one(Autoreset::NextStep);
    changed.set_member(0, pending()).unwrap();
    changed.set_autoreset(Autoreset::Disabled);
    for batch in [put, changed] {
        let expected = Member {
            reset_pending: false,
            ..pending()
        };
        assert_eq!(batch.member(0), Some(expected));
        assert_steps(batch);
    }
}
