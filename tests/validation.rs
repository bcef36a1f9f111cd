//! Promise 3: input out of range is rejected before anything changes. Extreme but valid input
//! neither hangs nor panics nor gives NaN.

use acrobot::arithmetic::{Arithmetic, Damped, Real};
use acrobot::batch::{Batch, BatchMemory, Block};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::Pendulum;
use acrobot::task::{Draw, Draws, ResetBounds};
use acrobot::{Acrobot, Action, Error, Fast, Params, Portable, State, TimeLimit};
use common::{Repeating, in_every_arithmetic};

/// Errors of calls that not all languages have: `rejections.rs` has the others.
#[test]
fn errors_name_the_value_and_the_rule() {
    type Memory<const LEN: usize> = BatchMemory<[Block; 3], [Pcg64; LEN]>;
    fn batch<const LEN: usize>() -> Result<Batch<Fast, Memory<LEN>>, Error> {
        let (blocks, generators) = ([Block::EMPTY; 3], [Pcg64::UNSEEDED; LEN]);
        Batch::new(1, BatchMemory { blocks, generators, own: () })
    }
    fn seed(text: &str) -> Result<(), Error> {
        text.parse::<SeedSequence>().map(drop)
    }
    let gravity = Draw::Uniform { low: f64::MIN, high: f64::MAX };
    let mut messages = Vec::new();
    for (result, message) in [
        (
            // Subnormal in `f32`: NEON of 32-bit ARM would take it for 0.
            Params { max_velocity1: 1.1754942e-38, ..Params::DEFAULT }.validate(),
            "max_velocity1 must be at least 1.2e-38 rad/s, \
                got 0.000000000000000000000000000000000000011754942",
        ),
        (
            ResetBounds::new(-0.1, 1e39).map(drop),
            "high must be from -3.4e38 to 3.4e38 rad and rad/s, \
                got 1000000000000000000000000000000000000000",
        ),
        (
            Draws::new(Params { gravity, ..Draws::FIXED }).map(drop),
            "gravity must be drawn from a range of finite width in m/s², got inf",
        ),
        (batch::<0>().map(drop), "a batch must have at least 1 acrobot, got 0 generators"),
        (batch::<17>().map(drop), "blocks must have 2 elements, got 3"),
        (seed(""), "seed must be a number of 1 to 4300 decimal digits, got an empty text"),
    ] {
        let error = result.unwrap_err();
        assert_eq!(error.to_string(), message);
        messages.push(error.message());
    }
    messages.push(Error::NoSuchIndex { index: 3, len: 3 }.message());
    messages.push(Error::UnknownAction(3).message());
    messages.push(Error::SharedParams.message());
    messages.push(Error::OutOfMemory { of: "acrobots", len: 3 }.message());
    messages.dedup();
    // The texts without numbers, in the same order.
    assert_eq!(
        messages,
        [
            "a number is out of range",
            "a batch must have at least 1 acrobot",
            "an argument has the wrong length",
            "a seed must be a number of 1 to 4300 decimal digits",
            "a batch has no acrobot with this index",
            "an action must be 0, 1 or 2",
            "a batch must have memory for the parameters of each acrobot",
            "a batch and a plan must fit into memory",
        ]
    );
}

#[test]
fn a_link_needs_inertia_about_its_joint() {
    let point2 = |center_of_mass2| Params { inertia2: 0.0, center_of_mass2, ..Params::DEFAULT };
    let no_inertia =
        "inertia2 must be above 0 if the centre of mass is on the joint, in kg m², got 0";
    // The square of the second one underflows to 0 in f64.
    for center in [0.0, 1e-170] {
        let error = point2(center).validate().unwrap_err();
        assert_eq!(error.to_string(), no_inertia);
    }
    // This one underflows only in f32.
    let small = point2(1e-30);
    small.validate().unwrap();
    let error = small.cast::<f32>().validate().unwrap_err();
    assert_eq!(error.to_string(), no_inertia);
    // Point masses at the tips are a pendulum.
    Params { inertia1: 0.0, center_of_mass1: 1.0, ..point2(1.0) }.validate().unwrap();
}

/// `rejections.rs` tries all numbers of a state.
#[test]
fn states_and_torques_that_are_not_finite_are_rejected() {
    let state = State { dtheta2: f64::NAN, ..State::HANGING };
    let mut acrobot = TimeLimit::with_task_limit(Acrobot::<Portable>::new(1));
    let mut pendulum = Pendulum::<Portable>::new(Params::DEFAULT, acrobot.state()).unwrap();
    let before = (acrobot.clone(), pendulum.clone());
    for result in [
        acrobot.inner_mut().set_state(state),
        pendulum.set_state(state),
        Pendulum::<Portable>::new(Params::DEFAULT, state).map(drop),
        Params::<f64>::DEFAULT.pendulum::<Portable>(state).map(drop),
    ] {
        let message = "dtheta2 must be a finite number of rad/s, got NaN";
        assert_eq!(result.unwrap_err().to_string(), message);
    }
    for error in [
        acrobot.step_torque(f64::INFINITY).unwrap_err(),
        acrobot.inner_mut().step_torque(f64::INFINITY).unwrap_err(),
        pendulum.step(f64::INFINITY).unwrap_err(),
    ] {
        assert_eq!(error.to_string(), "torque must be a finite number of N m, got inf");
    }
    assert_eq!(pendulum.sin_cos(), before.1.sin_cos());
    assert_eq!((acrobot, pendulum), before);
}

#[test]
fn results_that_are_not_finite_keep_the_angles_and_stop() {
    fn check<A: Arithmetic>() {
        let number = A::Scalar::from_f64;
        let mut acrobot = Acrobot::<A>::new(3);
        let huge = number(if number(1e300).is_finite() { 1e300 } else { 1e38 });
        let state = State::from([0.5, -0.25, 1.0, 2.0]).cast::<A::Scalar>();
        // The angles stay and the velocities are 0.
        acrobot.set_params(Params { dt: huge, ..Params::default() }).unwrap();
        acrobot.set_state(state).unwrap();
        acrobot.step(Action::Positive);
        assert_eq!(
            acrobot.state(),
            State { dtheta1: A::Scalar::ZERO, dtheta2: A::Scalar::ZERO, ..state }
        );
        // Later steps are as usual.
        acrobot.set_params(Params::default()).unwrap();
        acrobot.step(Action::Positive);
        assert_ne!(acrobot.state().dtheta1, A::Scalar::ZERO);
    }
    in_every_arithmetic!(check);
}

/// They are stored as a number, so that JSON can hold it, and no velocity in `f64` is beyond `f32`.
#[test]
fn infinite_bounds_of_velocity_are_none() {
    fn check<A: Arithmetic>() {
        let [infinite, largest] = [f64::INFINITY, f32::MAX.into()].map(A::Scalar::from_f64);
        let (max_velocity1, max_velocity2) = (infinite, infinite);
        let params = Params { max_velocity1, max_velocity2, ..Params::default() };
        let stored = Params { max_velocity1: largest, max_velocity2: largest, ..params };
        assert_eq!(*Acrobot::<A>::with_params(0, params).unwrap().params(), stored);
    }
    in_every_arithmetic!(check);
}

/// `data/draws.csv` has other draws.
#[test]
fn extreme_draws_of_parameters_are_within_their_range() {
    // The largest draw of a generator is rounded to the upper bound.
    let (draws, params) = (common::draws::<Damped<Fast>>(), Params::DEFAULT);
    let highest = draws.draw(&params, &mut Repeating::new([u64::MAX])).numbers();
    for ((name, highest), (_, draw)) in highest.into_iter().zip(draws.params().numbers()) {
        assert!(matches!(draw, Draw::Uniform { high, .. } if high == highest), "{name}");
    }
    // It never lets a normal draw pass.
    let mass1 = Draw::Normal { mean: 1.0, std: 0.1, low: 0.5, high: 2.0 };
    let draws = Draws::<f32>::new(Params { mass1, ..Draws::FIXED }).unwrap();
    assert_eq!(draws.draw(&params, &mut Repeating::new([u64::MAX])).mass1, 1.0);
    // Bounds beyond 8 standard deviations, as draws.py computes it with NumPy.
    let mass1 = Draw::Normal { mean: 1.0, std: 0.01, low: 0.5, high: 2.0 };
    let draws = Draws::new(Params { mass1, ..Draws::FIXED }).unwrap();
    let drawn = draws.draw(&Params::<f64>::DEFAULT, &mut Pcg64::new(42));
    assert_eq!(drawn.mass1, 0.990946271812373);
}
