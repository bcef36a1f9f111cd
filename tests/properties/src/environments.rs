//! The contract of `Env` for any valid parameters.

use acrobot::env::{Options, RecordEpisodeStatistics, acrobot_v0, acrobot_v1, check_env};
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
            let options = Options { params, ..Options::default() };
            let env = acrobot_v1::<A>(options.clone()).unwrap();
            let env = TimeLimit::new(env, limit.try_into().unwrap());
            check_env(&env, seed).unwrap();
            let env = RecordEpisodeStatistics::new(acrobot_v0::<A>(options).unwrap());
            check_env(&env, seed).unwrap();
        });
    }
    in_every_arithmetic!(check);
}
