//! Promise 2 for batches: after any calls in any order, each acrobot is bit-identical to one alone.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Damped, Host, Micro, Real, Reference};
use acrobot::batch::{Autoreset, Member, SimdLevel};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::task::{Draws, Gymnasium, Measured, ResetBounds, Swingup, Task};
use acrobot::{Acrobot, Action, Fast, Params, Portable, ResetOptions, State, TimeLimit};
use common::draws;
use common::twins::{LEVELS, MODES, Twins};
use proptest::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::given::{Range, Tested, action, holds, number, params, reset_bounds, state};

/// The largest batch: three blocks of 16, of which one is not full.
const LEN: usize = 35;

#[derive(Clone, Debug)]
enum Call<S> {
    Settings(Autoreset, NonZeroU32, SimdLevel, ResetBounds),
    Params(Params<S>),
    /// Valid, or without mass.
    ParamsOf(usize, Params<S>, bool),
    Draws(bool),
    Reset(Option<Vec<bool>>, Option<u64>, Option<ResetBounds>),
    ResetTo(Vec<State<S>>),
    State(usize, State<S>),
    Store(usize),
    /// Sets a member to the stored one.
    Load(usize),
    Generator(usize, u64),
    /// Saves the batch, and goes on with the loaded one.
    Snapshot,
    Step(Vec<Action>),
    Torques(Vec<S>),
}

fn each<S: Strategy>(element: S) -> impl Strategy<Value = Vec<S::Value>> {
    prop::collection::vec(element, LEN)
}

fn call<A: Tested>() -> BoxedStrategy<Call<A::Scalar>> {
    // Lanes of the last block have no acrobot.
    let index = || 0..LEN + 16;
    let mode = prop::sample::select(&MODES[..]);
    let level = prop::sample::select(&LEVELS[..]);
    let limit = prop_oneof![1..5_u32, Just(500), Just(u32::MAX)];
    let limit = limit.prop_map(|limit| limit.try_into().unwrap());
    let bounds = || prop_oneof![Just(ResetBounds::DEFAULT), reset_bounds()];
    let reset =
        (prop::option::of(each(any::<bool>())), any::<Option<u64>>(), prop::option::of(bounds()));
    let of_one = (index(), params::<A>(Range::Any), prop::bool::weighted(0.8));
    prop_oneof![
        3 => (mode, limit, level, bounds()).prop_map(|(a, b, c, d)| Call::Settings(a, b, c, d)),
        1 => params::<A>(Range::Any).prop_map(Call::Params),
        3 => of_one.prop_map(|(index, params, valid)| Call::ParamsOf(index, params, valid)),
        1 => any::<bool>().prop_map(Call::Draws),
        3 => reset.prop_map(|(mask, seed, bounds)| Call::Reset(mask, seed, bounds)),
        2 => each(state(Range::Any)).prop_map(Call::ResetTo),
        2 => (index(), state(Range::Any)).prop_map(|(index, state)| Call::State(index, state)),
        2 => index().prop_map(Call::Store),
        2 => index().prop_map(Call::Load),
        1 => (index(), any::<u64>()).prop_map(|(index, seed)| Call::Generator(index, seed)),
        1 => Just(Call::Snapshot),
        12 => each(action()).prop_map(Call::Step),
        4 => each(number(Range::Any)).prop_map(Call::Torques),
    ]
    .boxed()
}

/// A member, the acrobot beside it, and whether its episode has ended.
type Stored<A, T> = (Member<A, <T as Task>::Memory>, TimeLimit<Acrobot<A, T>>, bool);

struct Model<A: Arithmetic, T: Task, const N: usize> {
    twins: Twins<A, N, T>,
    own_params: bool,
    stored: Option<Stored<A, T>>,
}

impl<A: Tested, T: Task + Serialize + DeserializeOwned, const N: usize> Model<A, T, N> {
    fn new(len: usize, own_params: bool) -> Self {
        Self { twins: Twins::new(len, own_params, Autoreset::NextStep), own_params, stored: None }
    }

    /// A rejected call leaves the batch as it was.
    fn call(&mut self, call: Call<A::Scalar>) {
        let Twins { batch, alone, done } = &mut self.twins;
        let len = alone.len();
        match call {
            Call::Settings(autoreset, limit, level, bounds) => {
                batch.set_reset_bounds(bounds);
                batch.set_max_steps(limit);
                batch.set_simd_level(level);
                batch.set_autoreset(autoreset);
                alone.iter_mut().for_each(|alone| alone.set_max_steps(limit));
                self.settle();
            }
            Call::Params(params) => self.twins.set_params(params),
            Call::ParamsOf(index, mut params, valid) => {
                if !valid {
                    params.mass1 = Real::ZERO;
                }
                let set = batch.set_params(index, params);
                assert_eq!(set.is_ok(), valid && self.own_params && index < len);
                if set.is_ok() {
                    alone[index].inner_mut().set_params(params).unwrap();
                }
            }
            Call::Draws(some) => {
                let set = batch.set_draws(if some { draws::<A>() } else { Draws::NONE });
                assert_eq!(set.is_ok(), self.own_params || !some);
            }
            Call::Reset(mask, seed, bounds) => {
                let mask = mask.as_ref().map(|mask| &mask[..len]);
                let seed = seed.map(SeedSequence::new);
                self.twins.reset(mask, ResetOptions { seed, bounds });
            }
            Call::ResetTo(states) => self.twins.reset_to(&states[..len]),
            Call::State(index, state) => {
                assert_eq!(batch.set_state(index, state).is_ok(), index < len);
                if let Some(alone) = alone.get_mut(index) {
                    alone.inner_mut().set_state(state).unwrap();
                }
            }
            Call::Store(index) => {
                let member = batch.member(index);
                assert_eq!(member.is_ok(), index < len);
                self.stored = member.ok().map(|member| (member, alone[index].clone(), done[index]));
            }
            Call::Load(index) => {
                let Some((member, stored, was_done)) = self.stored.clone() else {
                    return;
                };
                let fits = self.own_params || member.params == *alone[0].params();
                let set = batch.set_member(index, member);
                assert_eq!(set.is_ok(), fits && index < len);
                if set.is_ok() {
                    alone[index] = stored;
                    alone[index].set_max_steps(batch.max_steps());
                    // Shared parameters can differ from the stored ones in the sign of zero.
                    let params = batch.params(index).unwrap();
                    alone[index].inner_mut().set_params(params).unwrap();
                    done[index] = was_done;
                    self.settle();
                }
            }
            Call::Generator(index, seed) => {
                if let Some(rng) = batch.generators_mut().get_mut(index) {
                    *rng = Pcg64::new(seed);
                    *alone[index].inner_mut().rng_mut() = Pcg64::new(seed);
                }
            }
            Call::Snapshot => {
                let bytes = postcard::to_stdvec(batch).unwrap();
                *batch = postcard::from_bytes(&bytes).unwrap();
                assert_eq!(postcard::to_stdvec(batch).unwrap(), bytes);
            }
            Call::Step(actions) => self.twins.step(&actions[..len]),
            Call::Torques(torques) => self.twins.step_torques(&torques[..len]),
        }
        self.twins.assert_equal();
    }

    /// With `SameStep` no acrobot waits for a reset.
    fn settle(&mut self) {
        if self.twins.batch.autoreset() == Autoreset::SameStep {
            self.twins.reset_done();
        }
    }
}

#[test]
fn any_calls_in_any_order_equal_single_acrobots() {
    fn check<A: Tested, T: Task + Serialize + DeserializeOwned, const N: usize>() {
        let calls = prop::collection::vec(call::<A>(), 0..40);
        holds(120, (1..=LEN, any::<bool>(), calls), |(len, own, calls)| {
            let mut model = Model::<A, T, N>::new(len, own);
            calls.into_iter().for_each(|call| model.call(call));
        });
    }
    // Each takes seconds to compile.
    check::<Fast, Gymnasium, 3>();
    check::<Portable, Gymnasium, 4>();
    check::<Damped<Reference>, Gymnasium, 3>();
    check::<Damped<Fast>, Measured<Swingup>, 16>();
}

#[test]
fn every_arithmetic_equals_single_acrobots() {
    Twins::<Micro>::at_every_level();
    Twins::<Reference>::at_every_level();
    Twins::<Host>::at_every_level();
    Twins::<Micro>::at_any_angle();
}

/// Below and above the width of a vector.
#[test]
fn any_width_equals_single_acrobots() {
    Twins::<Fast, 1>::at_every_level();
    Twins::<Fast, 32>::at_every_level();
}
