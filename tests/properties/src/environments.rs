//! The contract of `Env` for any valid parameters.

use acrobot::env::{RecordEpisodeStatistics, RenderMode, check_env, make_with};
use acrobot::{Fast, Params, TimeLimit};
use common::in_every_arithmetic;
use proptest::prelude::*;

use crate::given::{Range, Tested, holds, params};

/// Parameters that are also valid in `f32`.
fn fitting() -> impl Strategy<Value = Params> {
    params::<Fast>(Range::Any).prop_map(|params| params.cast())
}

#[test]
fn environments_of_any_parameters_keep_the_contract() {
    fn check<A: Tested>() {
        holds(10, (fitting(), any::<u64>(), 1..600_u32), |(params, seed, limit)| {
            let make = |id| make_with::<A>(id, params, RenderMode::None).unwrap();
            let env = TimeLimit::new(make("Acrobot-v1"), limit.try_into().unwrap());
            check_env(&env, seed).unwrap();
            check_env(&RecordEpisodeStatistics::new(make("Acrobot-v0")), seed).unwrap();
        });
    }
    in_every_arithmetic!(check);
}
