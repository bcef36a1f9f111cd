//! The environment's contract beyond its numbers: ends, time limits, live changes, sizes and
//! auto-traits.

use acrobot::{
    Acrobot, Action, Arithmetic, Dynamics, Error, Fast, Form, Host, Micro, Observation, Params,
    Pcg64, Portable, REWARD_THRESHOLD, Real, SeedSequence, StartBounds, State, TimeLimit,
    Trajectory, Transition, energy, mass_matrix, tip_height, wrap,
};

const fn is_send_sync_clone<T: Send + Sync + Unpin + Clone + core::fmt::Debug + 'static>() {}

/// What firmware counts on; it need not run to be checked.
const _: () = {
    assert!(size_of::<Acrobot<Micro>>() == size_of::<Acrobot<Fast>>());
    assert!(size_of::<Acrobot<Portable>>() <= 352);
    assert!(size_of::<State<f32>>() == 16);
    assert!(size_of::<Observation>() == 24);
    assert!(size_of::<Action>() == 1);
    assert!(size_of::<Fast>() == 0);
    assert!(size_of::<SeedSequence>() == 32);
    assert!(size_of::<Transition<f32>>() <= 44);
    is_send_sync_clone::<Acrobot<Fast>>();
    is_send_sync_clone::<Acrobot<Host>>();
    is_send_sync_clone::<TimeLimit<Acrobot<Micro>>>();
    is_send_sync_clone::<Trajectory<f32, 10>>();
    is_send_sync_clone::<Pcg64>();
    is_send_sync_clone::<Error>();
};

#[test]
fn the_goal_ends_with_a_reward_of_zero_and_stepping_goes_on() {
    let mut acrobot = Acrobot::<Portable>::new(0);
    let upright = State {
        theta1: std::f64::consts::PI,
        ..State::default()
    };
    acrobot.set_state(upright).unwrap();
    for _ in 0..2 {
        let step = acrobot.step(Action::Zero);
        assert!(step.terminated);
        assert_eq!(step.reward, 0.0);
    }
    acrobot.set_state(State::default()).unwrap();
    let step = acrobot.step(Action::Zero);
    assert!(!step.terminated);
    assert_eq!(step.reward, -1.0);
    assert_eq!(REWARD_THRESHOLD, -100.0);
}

/// Cosines that put the tip at exactly the goal's height, for whatever angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct AtTheLine;

impl Arithmetic for AtTheLine {
    type Scalar = f64;
    const FORM: Form = Form::Gymnasium;

    fn sin_cos(_: f64) -> (f64, f64) {
        (0.0, -0.5)
    }
}

/// With nothing but what an arithmetic must have.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Least;

impl Arithmetic for Least {
    type Scalar = f64;
    const FORM: Form = Form::Gymnasium;

    fn sin_cos(x: f64) -> (f64, f64) {
        Portable::sin_cos(x)
    }
}

#[test]
fn what_an_arithmetic_has_by_default_is_portables() {
    let mut least = Acrobot::<Least>::new(3);
    let mut portable = Acrobot::<Portable>::new(3);
    for _ in 0..100 {
        assert_eq!(
            least.step(Action::Positive),
            portable.step(Action::Positive)
        );
        assert_eq!(least.state(), portable.state());
        assert_eq!(least.energy(), portable.energy());
    }
}

#[test]
fn the_goal_is_above_the_line_and_not_on_it() {
    let step = Acrobot::<AtTheLine>::new(0).step(Action::Zero);
    assert!(!step.terminated);
    assert_eq!(step.reward, -1.0);
}

fn assert_goal_is_by_height<A: Arithmetic>() {
    let mut acrobot = Acrobot::<A>::new(0);
    let dt = A::Scalar::from_f64(1e-6);
    let params = Params {
        dt,
        ..*acrobot.params()
    };
    acrobot.set_params(params).unwrap();
    let mut terminated = 0;
    for [i, j] in (0..64).flat_map(|i| (0..64).map(move |j| [i, j])) {
        let [theta1, theta2] = [i, j].map(|k| A::Scalar::from_f64(0.1 * f64::from(k) - 3.13));
        let state = State {
            theta1,
            theta2,
            ..State::default()
        };
        acrobot.set_state(state).unwrap();
        let height = acrobot.tip_height().to_f64();
        if (height - 1.0).abs() > 1e-4 {
            let step = acrobot.step(Action::Zero);
            assert_eq!(step.terminated, height > 1.0, "{state:?}");
            terminated += u32::from(step.terminated);
        }
    }
    assert!(terminated > 500);
}

#[test]
fn the_goal_is_by_height_in_every_arithmetic() {
    assert_goal_is_by_height::<Fast>();
    assert_goal_is_by_height::<Micro>();
    assert_goal_is_by_height::<Portable>();
    assert_goal_is_by_height::<Host>();
}

#[test]
fn time_limits_truncate_apart_from_termination() {
    for (mut acrobot, limit) in [
        (TimeLimit::v1(Acrobot::<Fast>::new(1)), 500),
        (TimeLimit::v0(Acrobot::<Fast>::new(1)), 200),
    ] {
        assert_eq!(acrobot.limit().get(), limit);
        for n in 1..limit {
            assert!(!acrobot.step(Action::Zero).truncated, "step {n}");
        }
        let upright = State {
            theta1: core::f32::consts::PI,
            ..State::default()
        };
        acrobot.inner_mut().set_state(upright).unwrap();
        let last = acrobot.step(Action::Zero);
        assert!(last.terminated && last.truncated, "both on the last step");
        assert_eq!(acrobot.elapsed(), limit);
        acrobot.inner_mut().set_state(State::default()).unwrap();
        let beyond = acrobot.step(Action::Zero);
        assert!(!beyond.terminated && beyond.truncated, "as in Gymnasium");
        assert!(beyond.ended() && last.ended());
        acrobot.reset();
        assert_eq!(acrobot.elapsed(), 0);
        assert!(!acrobot.step(Action::Zero).ended());
    }
}

#[test]
fn parameters_change_on_a_running_acrobot() {
    let mut acrobot = Acrobot::<Portable>::new(9);
    acrobot
        .set_state(State::from([1.0, 1.0, 2.0, -1.0]))
        .unwrap();
    let mut nips = acrobot.clone();
    nips.set_params(Params {
        dynamics: Dynamics::Nips,
        ..*nips.params()
    })
    .unwrap();
    assert_eq!(nips.state(), acrobot.state());
    let mut short = acrobot.clone();
    short
        .set_params(Params {
            dt: 0.05,
            ..*short.params()
        })
        .unwrap();
    let mut noisy = acrobot.clone();
    noisy
        .set_params(Params {
            torque_noise: 0.5,
            ..*noisy.params()
        })
        .unwrap();

    let plain = acrobot.step(Action::Positive);
    assert_ne!(nips.step(Action::Positive), plain);
    assert_ne!(short.step(Action::Positive), plain);
    assert_ne!(noisy.step(Action::Positive), plain);
    // Noise draws from the generator, and nothing else of a step does.
    assert_ne!(noisy.rng(), acrobot.rng());
    assert_eq!(nips.rng(), acrobot.rng());
}

#[test]
fn acrobots_are_equal_by_parameters_state_and_generator() {
    let acrobot = Acrobot::<Portable>::new(0);
    assert_eq!(acrobot, acrobot.clone());

    let mut heavier = acrobot.clone();
    let params = Params {
        mass2: 1.5,
        ..*heavier.params()
    };
    heavier.set_params(params).unwrap();
    assert_ne!(acrobot, heavier);

    let mut moved = acrobot.clone();
    moved.set_state(State::default()).unwrap();
    assert_ne!(acrobot, moved);

    let mut drawn = acrobot.clone();
    Action::sample(drawn.rng_mut());
    assert_ne!(acrobot, drawn);
}

#[test]
fn start_bounds_are_what_they_were_made_of() {
    let bounds = StartBounds::new(-0.2, 0.3).unwrap();
    assert_eq!((bounds.low(), bounds.high()), (-0.2, 0.3));
}

#[test]
fn a_seeded_reset_is_a_new_acrobot() {
    let mut acrobot = TimeLimit::v1(Acrobot::<Portable>::new(0));
    acrobot.step(Action::Zero);
    acrobot.reset_seeded(7);
    assert_eq!(acrobot, TimeLimit::v1(Acrobot::new(7)));
}

#[test]
fn the_bounds_are_gymnasiums() {
    // As its observation space prints them: 4π and 9π in f32.
    let (four_pi, nine_pi) = (12.566_371, 28.274_334);
    assert_eq!(*Observation::HIGH, [1.0, 1.0, 1.0, 1.0, four_pi, nine_pi]);
    assert_eq!(*Observation::LOW, Observation::HIGH.map(|x| -x));
    let pi = core::f32::consts::PI;
    assert_eq!(*Observation::V0_HIGH, [pi, pi, four_pi, nine_pi]);
    assert_eq!(*Observation::V0_LOW, Observation::V0_HIGH.map(|x| -x));
}

#[test]
fn both_readings_show_the_state() {
    let mut acrobot = Acrobot::<Portable>::new(0);
    acrobot
        .set_state(State::from([0.5, -2.0, 3.0, -4.0]))
        .unwrap();
    let (sin1, cos1) = Portable::sin_cos(0.5);
    let (sin2, cos2) = Portable::sin_cos(-2.0);
    assert_eq!(
        *acrobot.observation(),
        [cos1, sin1, cos2, sin2, 3.0, -4.0].map(|x| x as f32)
    );
    assert_eq!(
        *Observation::<4>::from(acrobot.state()),
        [0.5, -2.0, 3.0, -4.0]
    );
}

#[test]
fn the_methods_of_an_acrobot_are_of_its_state_and_parameters() {
    let mut acrobot = Acrobot::<Portable>::new(0);
    acrobot
        .set_state(State::from([1.7e308, 1.7e308, 0.0, 0.0]))
        .unwrap();
    assert!(acrobot.energy().is_finite() && acrobot.tip_height().is_finite());
    let params = Params {
        mass1: 2.0,
        length1: 1.5,
        length2: 0.5,
        ..Params::DEFAULT
    };
    let state = State::from([0.5, -2.0, 3.0, -4.0]);
    acrobot.set_params(params).unwrap();
    acrobot.set_state(state).unwrap();
    assert_eq!(acrobot.energy(), energy::<Portable>(&params, &state));
    assert_eq!(
        acrobot.mass_matrix(),
        mass_matrix::<Portable>(&params, &state)
    );
    let height = -1.5 * Portable::cos(0.5) - 0.5 * Portable::cos(-1.5);
    assert_eq!(acrobot.tip_height(), height);
    assert_eq!(tip_height::<Portable>(&params, &state), height);
}

#[test]
fn angles_wrap() {
    use std::f64::consts::{PI, TAU};
    for (x, wrapped) in [
        (0.5, 0.5),
        (PI, PI),
        (-PI, -PI),
        (4.0, 4.0 - TAU),
        (-4.0, TAU - 4.0),
    ] {
        assert_eq!(wrap::<Portable>(x), wrapped);
    }
    // Beyond 64 turns, where the remainder takes over: seamlessly but for rounding.
    for turns in [60.0, 63.0, 64.0, 65.0, 70.0, 1e6] {
        for x in [-3.0, -1.0, 0.25, 3.0] {
            for turns in [-turns, turns] {
                let wrapped = wrap::<Portable>(x + turns * TAU);
                let error = (wrapped - x).abs();
                assert!(
                    error <= 1e-15 * turns * turns,
                    "{x} + {turns} turns: {wrapped}"
                );
            }
        }
    }
}
