//! Snapshots of any acrobot resume to the same bits.

use acrobot::arithmetic::{Damped, Modeled};
use acrobot::batch::VecBatch;
use acrobot::task::Draws;
use acrobot::{Acrobot, Action, Fast, Params, Portable, TimeLimit};
use common::{bits, draws};
use proptest::prelude::*;
use serde::de::DeserializeOwned;
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

/// Only bounds of velocity may be infinite. JSON has no infinity: its writers make `null` of it.
#[test]
fn infinite_bounds_of_parameters_are_loaded() {
    fn check<S: Modeled + Serialize + DeserializeOwned>() {
        let infinite = S::from_f64(f64::INFINITY);
        let (max_velocity1, max_velocity2) = (infinite, infinite);
        let params = Params::<S> { max_velocity1, max_velocity2, ..Params::default() };
        for (format, loaded) in again(&params) {
            assert_eq!(loaded, params, "{format}");
        }
        let text = serde_json::to_string(&params).unwrap();
        let error =
            serde_json::from_str::<Params<S>>(&text.replace("\"mass1\":1.0", "\"mass1\":null"));
        assert!(error.unwrap_err().to_string().starts_with("invalid type: null"));
        let missing = text.replace("\"max_velocity1\":null,", "");
        let error = serde_json::from_str::<Params<S>>(&missing).unwrap_err().to_string();
        assert!(error.starts_with("missing field `max_velocity1`"), "{error}");
    }
    check::<f32>();
    check::<f64>();
}

/// A struct, which some formats need.
#[derive(Serialize, Deserialize)]
struct Saved {
    batch: VecBatch<Fast>,
}

#[test]
fn every_format_stores_batches() {
    let mut batch = VecBatch::new(42, 3).unwrap();
    batch.own_params().unwrap();
    for draws in [Draws::NONE, draws::<Fast>()] {
        batch.set_draws(draws).unwrap();
        batch.reset();
        let batch = batch.clone();
        let expected = serde_json::to_string(&batch).unwrap();
        for (format, loaded) in again(&Saved { batch }) {
            let found = serde_json::to_string(&loaded.batch).unwrap();
            assert_eq!(found, expected, "{format}");
        }
    }
}
