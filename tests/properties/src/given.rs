//! Inputs of the properties: numbers of every size, and values built from them.

use std::fmt::Debug;

use acrobot::arithmetic::{Arithmetic, Modeled, Real};
use acrobot::numpy::Pcg64;
use acrobot::physics::{Dynamics, Pendulum};
use acrobot::task::ResetBounds;
use acrobot::{Acrobot, Action, Params, State};
use proptest::num::{f32, f64};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

/// Tries a property on this many cases, the same in every run. In the environment, `PROPTEST_CASES`
/// changes their number and `PROPTEST_RNG_SEED` the cases.
pub fn holds<G: Strategy + 'static>(cases: u32, given: G, property: impl Fn(G::Value)) {
    hold(cases, given.boxed(), &property);
}

/// Separate from [`holds`] because it is large and compiled for each type of input.
fn hold<T: Debug>(cases: u32, given: BoxedStrategy<T>, property: &dyn Fn(T)) {
    let default = ProptestConfig::default();
    let asked = std::env::var_os("PROPTEST_CASES").is_some();
    let config = ProptestConfig {
        cases: if asked { default.cases } else { cases },
        rng_seed: match default.rng_seed {
            RngSeed::Random => RngSeed::Fixed(0),
            fixed => fixed,
        },
        max_local_rejects: u32::MAX,
        failure_persistence: None,
        ..default
    };
    let outcome = TestRunner::new(config).run(&given, |value| {
        property(value);
        Ok(())
    });
    if let Err(failure) = outcome {
        panic!("{failure}");
    }
}

/// An arithmetic whose scalar can be generated.
pub trait Tested: Arithmetic<Scalar: Number> {}

impl<A: Arithmetic<Scalar: Number>> Tested for A {}

pub trait Number: Modeled {
    /// Any finite number. All exponents are equally likely.
    fn finite() -> BoxedStrategy<Self>;
}

macro_rules! impl_number {
    ($($scalar:ident),*) => {$(
        impl Number for $scalar {
            fn finite() -> BoxedStrategy<Self> {
                use $scalar::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
                (POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO).boxed()
            }
        }
    )*};
}

impl_number!(f32, f64);

#[derive(Clone, Copy, PartialEq)]
pub enum Range {
    /// Within a factor of thirty of Gymnasium's values.
    Moderate,
    /// Mostly moderate, otherwise any finite number.
    Any,
}

pub fn number<S: Number>(range: Range) -> BoxedStrategy<S> {
    let moderate = (-30.0..30.0).prop_map(S::from_f64);
    match range {
        Range::Moderate => moderate.boxed(),
        Range::Any => prop_oneof![3 => moderate, 1 => S::finite()].boxed(),
    }
}

/// Numbers above 0, mostly `usual`.
fn positive<S: Number>(range: Range, usual: f64) -> BoxedStrategy<S> {
    let usual = S::from_f64(usual);
    let moderate = (-3.4..3.4_f64).prop_map(|exponent| S::from_f64(exponent.exp()));
    match range {
        Range::Moderate => prop_oneof![1 => Just(usual), 1 => moderate].boxed(),
        Range::Any => {
            let any = S::finite().prop_map(|x| if x < S::ZERO { -x } else { x });
            prop_oneof![8 => Just(usual), 5 => moderate, 1 => any].boxed()
        }
    }
}

pub fn params<A: Tested>(range: Range) -> BoxedStrategy<Params<A::Scalar>> {
    let zero = || Just(A::Scalar::ZERO);
    let above_0 = |usual| positive::<A::Scalar>(range, usual);
    let or_0 = |usual| prop_oneof![4 => above_0(usual), 1 => zero()].boxed();
    let numbers = Params::DEFAULT.numbers().map(|(name, usual)| match name {
        "center_of_mass1" | "center_of_mass2" | "inertia1" | "inertia2" => or_0(usual),
        "gravity" => prop_oneof![Just(A::Scalar::from_f64(usual)), number(range)].boxed(),
        "torques[0]" | "torques[1]" | "torques[2]" => number(range),
        "torque_noise" => prop_oneof![2 => zero(), 1 => above_0(1.0)].boxed(),
        _ if usual > 0.0 => above_0(usual),
        _ if A::HAS_FRICTION => or_0(0.05),
        _ => zero().boxed(),
    });
    let dynamics = prop_oneof![Just(Dynamics::Book), Just(Dynamics::Nips)];
    (numbers, dynamics)
        .prop_map(|(numbers, dynamics)| {
            let mut params = Params { dynamics, ..Params::DEFAULT };
            let places = params.numbers_mut().into_iter().zip(numbers);
            places.for_each(|(place, number)| *place = number);
            params
        })
        .prop_filter("valid parameters", |params| params.validate().is_ok())
        .boxed()
}

pub fn state<S: Number>(range: Range) -> BoxedStrategy<State<S>> {
    [(); 4].map(|()| number::<S>(range)).prop_map(State::from).boxed()
}

pub fn action() -> impl Strategy<Value = Action> {
    prop::sample::select(&Action::ALL[..])
}

pub fn reset_bounds() -> impl Strategy<Value = ResetBounds> {
    let bound = || {
        prop_oneof![number::<f64>(Range::Moderate), number::<f32>(Range::Any).prop_map(f64::from)]
    };
    (bound(), bound()).prop_map(|(x, y)| ResetBounds::new(x.min(y), x.max(y)).unwrap())
}

pub fn acrobot<A: Arithmetic>(
    params: Params<A::Scalar>,
    state: State<A::Scalar>,
    seed: u64,
) -> Acrobot<A> {
    Acrobot::from_pendulum(Pendulum::new(params, state).unwrap(), Pcg64::new(seed))
}
