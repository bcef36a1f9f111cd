//! Snapshots of any acrobot resume to the same bits, and are harmless when damaged.

use acrobot::arithmetic::Damped;
use acrobot::batch::{Member, VecBatch};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::Dynamics;
use acrobot::{Acrobot, Action, Fast, Params, Portable, State, TimeLimit};
use common::{bits, in_every_arithmetic, params_range};
use proptest::prelude::*;
use rand_core::Rng;
use serde::{Deserialize, Serialize};

use crate::formats::again;
use crate::given::{Range, Tested, acrobot, holds, params, state};

/// An acrobot after some steps and draws, with any time limit.
fn running<A: Tested>() -> impl Strategy<Value = TimeLimit<Acrobot<A>>> {
    let given = (params::<A>(Range::Any), state(Range::Any), any::<u64>(), 0..4);
    let limit = prop_oneof![Just(1), Just(500), 1..=u32::MAX];
    (given, limit).prop_map(|((params, state, seed, steps), limit)| {
        let mut acrobot = TimeLimit::new(acrobot(params, state, seed), limit.try_into().unwrap());
        for _ in 0..steps {
            let action = Action::sample(acrobot.inner_mut().rng_mut());
            acrobot.step(action);
        }
        acrobot
    })
}

#[test]
fn snapshots_resume_to_the_same_bits() {
    fn check<A: Tested>() {
        holds(500, running::<A>(), |original| {
            let expected = serde_json::to_string(&original).unwrap();
            for (format, mut resumed) in again(&original) {
                let mut original = original.clone();
                assert_eq!(serde_json::to_string(&resumed).unwrap(), expected, "{format}");
                for _ in 0..3 {
                    assert_eq!(resumed, original);
                    let [state, other] = [&resumed, &original].map(|limited| limited.state());
                    assert_eq!(bits(state), bits(other));
                    let action = Action::sample(original.inner_mut().rng_mut());
                    assert_eq!(Action::sample(resumed.inner_mut().rng_mut()), action);
                    assert_eq!(resumed.step(action), original.step(action));
                }
            }
        });
    }
    // One arithmetic for each scalar, and one with friction: the others have other names only.
    check::<Portable>();
    check::<Fast>();
    check::<Damped<Fast>>();
}

#[test]
fn members_and_parts_load_as_stored() {
    let progress = any::<(u32, bool, u64, bool)>();
    let given = (params::<Damped<Fast>>(Range::Any), state(Range::Any), progress);
    holds(500, given, |(params, state, progress)| {
        let (elapsed, reset_pending, seed, half) = progress;
        let mut rng = Pcg64::new(seed);
        if half {
            rng.next_u32();
        }
        let member = Member::<Damped<Fast>> { params, state, elapsed, reset_pending, rng };
        for (_, loaded) in again(&member) {
            assert_eq!(bits(loaded.state), bits(member.state));
            assert_eq!(loaded, member);
        }
    });
    let given = (params::<Damped<Portable>>(Range::Any), state::<f64>(Range::Any));
    holds(500, given, |(params, state): (Params, State)| {
        for (_, loaded) in again(&params) {
            assert_eq!(loaded, params);
        }
        for (_, loaded) in again(&state) {
            assert_eq!(bits(loaded), bits(state));
        }
    });
}

/// A struct, which some formats need.
#[derive(Serialize, Deserialize)]
struct Saved {
    batch: VecBatch<Fast>,
}

#[test]
fn every_format_stores_batches() {
    let mut batch = VecBatch::with_own_params(SeedSequence::new(42), 3).unwrap();
    for range in [None, Some(params_range::<Fast>(Dynamics::Nips))] {
        batch.set_params_range(range).unwrap();
        batch.reset();
        let batch = batch.clone();
        let expected = serde_json::to_string(&batch).unwrap();
        for (format, loaded) in again(&Saved { batch }) {
            let found = serde_json::to_string(&loaded.batch).unwrap();
            assert_eq!(found, expected, "{format}");
        }
    }
}

#[test]
fn damaged_snapshots_are_rejected_or_valid() {
    fn check<A: Tested>() {
        let changes = prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4);
        let kept = any::<prop::sample::Index>();
        let given = (running::<A>(), changes, prop::option::weighted(0.2, kept));
        holds(2000, given, |(original, changes, kept)| {
            let mut bytes = postcard::to_stdvec(&original).unwrap();
            for (at, byte) in changes {
                let at = at.index(bytes.len());
                bytes[at] = byte;
            }
            if let Some(kept) = kept {
                bytes.truncate(kept.index(bytes.len()));
            }
            if let Ok(mut loaded) = postcard::from_bytes::<TimeLimit<Acrobot<A>>>(&bytes) {
                loaded.params().validate().unwrap();
                loaded.state().validate().unwrap();
                let observation = loaded.step(Action::Positive).observation;
                assert!(observation.as_ref().iter().all(|x| x.is_finite()));
                let bytes = postcard::to_stdvec(&loaded).unwrap();
                assert_eq!(postcard::from_bytes(&bytes), Ok(loaded));
            }
        });
    }
    in_every_arithmetic!(check);
}
