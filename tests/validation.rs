//! Promise 3: input out of range is rejected before anything changes. Extreme but valid input
//! neither hangs nor panics nor gives NaN.

use acrobot::arithmetic::{Arithmetic, Damped, Real};
use acrobot::batch::{Batch, Block};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::{Dynamics, Pendulum};
use acrobot::task::{ParamsRange, ResetBounds};
use acrobot::{Acrobot, Action, Error, Fast, Params, Portable, State, TimeLimit};
use common::{Repeating, in_every_arithmetic};

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// Every rule of every [`Error`]: the message names the value, its unit and what it must be.
#[test]
fn errors_name_the_value_and_the_rule() {
    fn params(change: fn(&mut Params)) -> Result<(), Error> {
        let mut params = Params::DEFAULT;
        change(&mut params);
        params.validate()
    }
    fn range(change: fn(&mut Params, &mut Params)) -> Result<(), Error> {
        let [mut low, mut high] = [Params::DEFAULT; 2];
        change(&mut low, &mut high);
        ParamsRange::new(low, high).map(drop)
    }
    fn bounds(low: f64, high: f64) -> Result<(), Error> {
        ResetBounds::new(low, high).map(drop)
    }
    type Memory<const LEN: usize> = ([Block; 3], [Pcg64; LEN]);
    fn batch<const LEN: usize>() -> Result<Batch<Fast, Memory<LEN>>, Error> {
        Batch::new(1, ([Block::EMPTY; 3], [Pcg64::UNSEEDED; LEN]))
    }
    fn seed(text: &str) -> Result<(), Error> {
        text.parse::<SeedSequence>().map(drop)
    }
    let mut members = batch::<35>().unwrap();
    let mut messages = Vec::new();
    for (result, message) in [
        (params(|p| p.gravity = f64::NAN), "gravity must be a finite number of m/s², got NaN"),
        (
            params(|p| p.torque_noise = -0.5),
            "torque_noise must be finite and at least 0 N m, got -0.5",
        ),
        (params(|p| p.dt = 0.0), "dt must be finite and above 0 s, got 0"),
        (
            params(|p| p.friction.joint2 = -0.1),
            "friction.joint2 must be finite and at least 0 N m s/rad, got -0.1",
        ),
        (
            params(|p| p.max_velocity2 = f64::INFINITY),
            "max_velocity2 must be from 1.2e-38 to 3.4e38 rad/s, got inf",
        ),
        (
            // Subnormal in `f32`: NEON of 32-bit ARM would take it for 0.
            params(|p| p.max_velocity1 = 1.1754942e-38),
            "max_velocity1 must be from 1.2e-38 to 3.4e38 rad/s, \
                got 0.000000000000000000000000000000000000011754942",
        ),
        (
            bounds(f64::NEG_INFINITY, 0.0),
            "low must be from -3.4e38 to 3.4e38 rad and rad/s, got -inf",
        ),
        (
            bounds(-0.1, 1e39),
            "high must be from -3.4e38 to 3.4e38 rad and rad/s, \
                got 1000000000000000000000000000000000000000",
        ),
        (
            bounds(0.2, -0.2),
            "the lower reset bound must not be above the upper one, got 0.2 and -0.2 rad and rad/s",
        ),
        (
            range(|low, _| low.mass2 = 3.0),
            "the lower mass2 must not be above the upper one, got 3 and 1 kg",
        ),
        (
            range(|low, high| (low.gravity, high.gravity) = (f64::MIN, f64::MAX)),
            "gravity must be a range of finite width in m/s², got inf",
        ),
        (range(|low, _| low.dt = -0.1), "dt must be finite and above 0 s, got -0.1"),
        (
            range(|_, high| high.dynamics = Dynamics::Nips),
            "dynamics must be the same in both bounds of a range",
        ),
        (
            params(|p| (p.inertia1, p.center_of_mass1) = (0.0, 0.0)),
            "inertia1 must be above 0 kg m² if the centre of mass is on the joint, got 0",
        ),
        (batch::<0>().map(drop), "a batch must have at least 1 acrobot, got 0 generators"),
        (batch::<17>().map(drop), "blocks must have 2 elements, got 3"),
        (members.set_state(35, State::default()), "member index must be below 35, got 35"),
        (
            Action::try_from(3).map(drop),
            "action must be 0 (negative torque), 1 (none) or 2 (positive), got 3",
        ),
        (seed("12x"), "seed must be a decimal integer of at least 0, got 'x' as character 3"),
        (seed(""), "seed must be a decimal integer of at least 0, got an empty text"),
    ] {
        let error = result.unwrap_err();
        assert_eq!(error.to_string(), message);
        messages.push(error.message());
    }
    messages.push(Error::SharedParams.message());
    messages.push(Error::OutOfMemory { len: 3 }.message());
    messages.push(Error::SeedTooLong { len: 3, limit: 2 }.message());
    messages.dedup();
    // The texts without numbers, in the same order.
    assert_eq!(
        messages,
        [
            "a number is out of range",
            "a lower bound is above the upper one",
            "a number is out of range",
            "dynamics must be the same in both bounds of a range",
            "a link has no moment of inertia",
            "a batch must have at least 1 acrobot",
            "an argument has the wrong length",
            "a batch has no acrobot with this index",
            "an action must be 0, 1 or 2",
            "a seed must be a decimal integer of at least 0",
            "a batch must have memory for the parameters of each acrobot",
            "a batch must fit into memory",
            "a seed has too many digits",
        ]
    );
}

/// Every field of the parameters: its name, how to set it, and whether 0 and −1 are valid.
#[expect(clippy::type_complexity, reason = "a table")]
fn fields() -> [(&'static str, fn(&mut Params, f64), bool, bool); 16] {
    [
        ("length1", |p, x| p.length1 = x, false, false),
        ("length2", |p, x| p.length2 = x, false, false),
        ("mass1", |p, x| p.mass1 = x, false, false),
        ("mass2", |p, x| p.mass2 = x, false, false),
        ("center_of_mass1", |p, x| p.center_of_mass1 = x, true, false),
        ("center_of_mass2", |p, x| p.center_of_mass2 = x, true, false),
        ("inertia1", |p, x| p.inertia1 = x, true, false),
        ("inertia2", |p, x| p.inertia2 = x, true, false),
        ("gravity", |p, x| p.gravity = x, true, true),
        ("dt", |p, x| p.dt = x, false, false),
        ("max_velocity1", |p, x| p.max_velocity1 = x, false, false),
        ("max_velocity2", |p, x| p.max_velocity2 = x, false, false),
        ("torques[0]", |p, x| p.torques[0] = x, true, true),
        ("torques[1]", |p, x| p.torques[1] = x, true, true),
        ("torques[2]", |p, x| p.torques[2] = x, true, true),
        ("torque_noise", |p, x| p.torque_noise = x, true, false),
    ]
}

#[test]
fn parameters_out_of_range_are_rejected_by_name() {
    let mut acrobot = Acrobot::<Portable>::new(1);
    for (field, set, zero, negative) in fields() {
        for value in NOT_FINITE.into_iter().chain([0.0, -1.0, 2.0]) {
            let before = acrobot.clone();
            let mut params = Params::DEFAULT;
            set(&mut params, value);
            let valid = value == 2.0 || (value == 0.0 && zero) || (value == -1.0 && negative);
            let set = acrobot.set_params(params);
            assert_eq!(set.is_ok(), valid, "{field} = {value}");
            let Err(error) = set else {
                assert_eq!(*acrobot.params(), params);
                continue;
            };
            let text = error.to_string();
            let named = text.starts_with(&format!("{field} must be "));
            assert!(named && text.ends_with(&format!(", got {value}")), "{text}");
            assert_eq!(acrobot, before);
            let made = Pendulum::<Portable>::new(params, before.state());
            assert_eq!(made.unwrap_err().to_string(), text);
            // The constants stay, too.
            let mut twin = before;
            assert_eq!(acrobot.step(Action::Positive), twin.step(Action::Positive));
        }
    }
}

#[test]
fn a_link_needs_inertia_about_its_joint() {
    let point2 = |center_of_mass2| Params { inertia2: 0.0, center_of_mass2, ..Params::DEFAULT };
    // The square of the second one underflows to 0 in f64.
    for center in [0.0, 1e-170] {
        let error = point2(center).validate().unwrap_err();
        assert!(matches!(error, Error::NoInertia { value: 0.0, .. }), "{error}");
    }
    // This one underflows only in f32.
    let small = point2(1e-30);
    small.validate().unwrap();
    let error = small.cast::<f32>().validate().unwrap_err();
    assert!(matches!(error, Error::NoInertia { .. }), "{error}");
    // Point masses at the tips are a pendulum.
    Params { inertia1: 0.0, center_of_mass1: 1.0, ..point2(1.0) }.validate().unwrap();
}

#[test]
fn states_and_torques_that_are_not_finite_are_rejected() {
    let mut acrobot = TimeLimit::v1(Acrobot::<Portable>::new(1));
    let before = acrobot.clone();
    let mut pendulum = Pendulum::<Portable>::new(Params::DEFAULT, before.state()).unwrap();
    let pendulum_before = pendulum.clone();
    for value in NOT_FINITE {
        for (i, name) in ["theta1", "theta2", "dtheta1", "dtheta2"].into_iter().enumerate() {
            let mut numbers = [0.0; 4];
            numbers[i] = value;
            let unit = if i < 2 { "rad" } else { "rad/s" };
            let message = format!("{name} must be a finite number of {unit}, got {value}");
            let state = State::from(numbers);
            for result in [
                acrobot.set_state(state),
                pendulum.set_state(state),
                Pendulum::<Portable>::new(Params::DEFAULT, state).map(drop),
                Params::<f64>::DEFAULT.pendulum::<Portable>(state).map(drop),
                Params::<f32>::DEFAULT.pendulum::<Fast>(state.cast()).map(drop),
            ] {
                assert_eq!(result.unwrap_err().to_string(), message);
            }
        }
        let message = format!("torque must be a finite number of N m, got {value}");
        for error in [
            acrobot.step_torque(value).unwrap_err(),
            acrobot.inner_mut().step_torque(value).unwrap_err(),
            pendulum.step(value).unwrap_err(),
        ] {
            assert_eq!(error.to_string(), message);
        }
    }
    assert_eq!(acrobot, before);
    assert_eq!(pendulum, pendulum_before);
    assert_eq!(pendulum.sin_cos(), pendulum_before.sin_cos());
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

/// The largest draw of a generator is rounded to the upper bound.
#[test]
fn draws_of_parameters_are_within_their_range() {
    let range = common::params_range::<Damped<Fast>>(Dynamics::Book);
    assert_eq!(range.draw(&mut Repeating::new([u64::MAX])), *range.high());
    let mut rng = Pcg64::new(0);
    for _ in 0..1000 {
        let drawn = range.draw(&mut rng);
        assert!(ParamsRange::new(*range.low(), drawn).is_ok());
        assert!(ParamsRange::new(drawn, *range.high()).is_ok());
    }
}
