//! The contract of `Env` for any valid parameters.

use acrobot::env::{AcrobotEnv, Env, RenderMode, make_with};
use acrobot::numpy::Pcg64;
use acrobot::{Action, Fast, Params, TimeLimit};
use common::in_every_arithmetic;
use proptest::prelude::*;

use crate::given::{Range, Tested, holds, params};

/// Parameters that are also valid in `f32`.
fn fitting() -> impl Strategy<Value = Params> {
    params::<Fast>(Range::Any).prop_map(|params| params.cast())
}

/// Steps at random to the end, within the spaces. Returns the observations and rewards.
fn play(env: &mut TimeLimit<AcrobotEnv>, mut rng: Pcg64) -> Vec<(Vec<f32>, f32)> {
    let mut steps = Vec::new();
    loop {
        let step = env.step(Action::sample(&mut rng));
        assert!(env.observation_space().contains(&step.observation), "{step:?}");
        assert!(step.reward.is_finite(), "{step:?}");
        let done = step.done();
        steps.push((step.observation, step.reward));
        if done {
            return steps;
        }
    }
}

#[test]
fn environments_of_any_parameters_keep_the_contract() {
    fn check<A: Tested>() {
        holds(10, (fitting(), any::<u64>(), 1..600_u32), |(params, seed, limit)| {
            let rng = Pcg64::new(seed);
            let made = make_with::<A>("Acrobot-v1", params, RenderMode::None).unwrap();
            let mut env = TimeLimit::new(made.into_inner(), limit.try_into().unwrap());
            let mut other = env.clone();
            let first = (env.reset_with_seed(seed), play(&mut env, rng.clone()));
            assert!(env.observation_space().contains(&first.0));
            let again = (other.reset_with_seed(seed), play(&mut other, rng.clone()));
            assert_eq!(again, first, "a seed determines an episode");
            env.reset();
            other = env.clone();
            assert_eq!(play(&mut other, rng.clone()), play(&mut env, rng), "a clone is equal");
        });
    }
    in_every_arithmetic!(check);
}
