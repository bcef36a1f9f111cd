//! The contract of `Env` for any valid parameters, and after any calls.

use acrobot::env::{
    ArithmeticKind, Env, Error, Options, RecordEpisodeStatistics, RenderMode, Rendering, Space,
    acrobot_v0, acrobot_v1, check_env, make_with,
};
use acrobot::numpy::SeedSequence;
use acrobot::physics::ResetBounds;
use acrobot::{Action, Fast, Params, Portable, ResetOptions, State, TimeLimit};
use common::in_every_arithmetic;
use proptest::prelude::*;

use crate::given::{Range, Tested, action, holds, params, reset_bounds, state};

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

#[derive(Clone, Debug)]
enum Call {
    Reset(Option<u64>, ResetBounds),
    Step(Action),
    SetState(State),
    SetParams(Params),
    Render,
    Close,
}

fn call() -> impl Strategy<Value = Call> {
    let bounds = prop_oneof![Just(ResetBounds::DEFAULT), reset_bounds()];
    let reset = (any::<Option<u64>>(), bounds);
    prop_oneof![
        2 => reset.prop_map(|(seed, bounds)| Call::Reset(seed, bounds)),
        20 => action().prop_map(Call::Step),
        2 => state::<f64>(Range::Any).prop_map(Call::SetState),
        2 => params::<Portable>(Range::Any).prop_map(Call::SetParams),
        2 => Just(Call::Render),
        1 => Just(Call::Close),
    ]
}

/// Also steps before a reset and after an end. The render mode is the one with the fewest pixels.
#[test]
fn any_calls_in_any_order_keep_observations_in_their_space() {
    use ArithmeticKind::{Fast, Host, Micro, Portable, Reference};

    let arithmetic = prop::sample::select(&[Host, Reference, Portable, Fast, Micro][..]);
    let id = prop::sample::select(&["Acrobot-v0", "Acrobot-v1"][..]);
    let calls = prop::collection::vec(call(), 0..60);
    holds(300, (arithmetic, id, calls), |(arithmetic, id, calls)| {
        let limit = if id == "Acrobot-v0" { 200 } else { 500 };
        let options = Options { arithmetic, render_mode: RenderMode::Ansi, ..Options::default() };
        let mut env = RecordEpisodeStatistics::new(make_with(id, options).unwrap());
        let (mut elapsed, mut closed) = (0, false);
        for call in calls {
            match call {
                Call::Reset(seed, bounds) => {
                    let seed = seed.map(SeedSequence::new);
                    let bounds = Some(bounds);
                    let (observation, _) = env.reset_with(ResetOptions { seed, bounds });
                    assert!(observation.as_slice().iter().all(|x| x.is_finite()));
                    elapsed = 0;
                }
                Call::Step(action) => {
                    let step = env.step(action);
                    elapsed += 1;
                    let space = env.observation_space();
                    assert!(space.contains(&step.observation), "{:?}", step.observation);
                    assert_eq!(step.reward, if step.terminated { 0.0 } else { -1.0 });
                    assert_eq!(step.truncated, elapsed >= limit);
                    let ended = step.info.episode.map(|episode| episode.length);
                    assert_eq!(ended, step.done().then_some(elapsed));
                }
                // A state beyond the range of `f32` is rejected.
                Call::SetState(state) => {
                    let before = env.unwrapped().state();
                    if env.unwrapped_mut().set_state(state).is_err() {
                        assert_eq!(env.unwrapped().state(), before);
                    }
                }
                Call::SetParams(params) => {
                    let before = env.unwrapped().params();
                    if env.unwrapped_mut().set_params(params).is_err() {
                        assert_eq!(env.unwrapped().params(), before);
                    }
                }
                Call::Render => match env.render() {
                    Ok(Rendering::Text(text)) => assert_eq!(text.lines().count(), 21),
                    other => assert!(closed && other == Err(Error::NoRenderMode), "{other:?}"),
                },
                Call::Close => {
                    env.close();
                    closed = true;
                }
            }
        }
    });
}
