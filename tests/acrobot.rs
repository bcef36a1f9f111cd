//! The environment's contract beyond its numbers: construction, resets, terminations, time limits,
//! live changes, sizes and auto-traits.

use acrobot::arithmetic::{Arithmetic, Damped, Form, Host, Micro, Real, Reference};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::control::ControlError;
use acrobot::physics::{Dynamics, Pendulum};
use acrobot::task::{Gymnasium, GymnasiumV0, ResetBounds, Task};
use acrobot::trajectory::{Trajectory, Transition};
use acrobot::{
    Acrobot, Action, Error, Fast, Params, Portable, REWARD_THRESHOLD, ResetOptions, State, Step,
    TimeLimit,
};
use common::bits;

const fn is_send_sync_clone<T: Send + Sync + Unpin + Clone + core::fmt::Debug + 'static>() {}

/// Firmware relies on these sizes and traits, and users on Gymnasium's threshold. The compiler
/// checks them.
const _: () = {
    assert!(size_of::<Acrobot<Micro>>() == size_of::<Acrobot<Fast>>());
    assert!(size_of::<Acrobot<Reference>>() <= 400);
    assert!(size_of::<Acrobot<Portable>>() <= 400);
    assert!(size_of::<State<f32>>() == 16);
    assert!(REWARD_THRESHOLD == -100.0);
    assert!(size_of::<Action>() == 1);
    assert!(size_of::<Fast>() == 0);
    assert!(size_of::<SeedSequence>() == 48);
    assert!(size_of::<Transition<f32>>() <= 44);
    is_send_sync_clone::<Acrobot<Fast>>();
    is_send_sync_clone::<Pendulum<Fast>>();
    is_send_sync_clone::<Acrobot<Host>>();
    is_send_sync_clone::<TimeLimit<Acrobot<Micro>>>();
    is_send_sync_clone::<Trajectory<f32, 10>>();
    is_send_sync_clone::<Pcg64>();
    is_send_sync_clone::<Error>();
    is_send_sync_clone::<ControlError>();
};

/// An arithmetic with only the required items. Its cosines put the tip at exactly the target
/// height, whatever the angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct AtTheTarget;

impl Arithmetic for AtTheTarget {
    const NAME: &'static str = "at the target";
    type Scalar = f64;
    const FORM: Form = Form::Gymnasium;

    fn sin_cos(_: f64) -> (f64, f64) {
        (0.0, -0.5)
    }
}

#[test]
fn a_tip_at_the_target_height_is_not_in_the_goal() {
    let step = Acrobot::<AtTheTarget>::new(0).step(Action::Zero);
    assert!(!step.terminated);
    assert_eq!(step.reward, -1.0);
}

#[test]
fn time_limits_truncate_whether_or_not_an_episode_terminates() {
    fn check<T: Task>(mut acrobot: TimeLimit<Acrobot<Fast, T>>, limit: u32) {
        assert_eq!(acrobot.max_steps().get(), limit);
        for n in 1..limit {
            assert!(!acrobot.step(Action::Zero).truncated, "step {n}");
        }
        let upright = State { theta1: core::f32::consts::PI, ..State::default() };
        acrobot.set_state(upright).unwrap();
        let last = acrobot.step(Action::Zero);
        assert!(last.terminated && last.truncated, "both on the last step");
        assert_eq!(acrobot.elapsed_steps(), limit);
        acrobot.set_state(State::default()).unwrap();
        let beyond = acrobot.step(Action::Zero);
        assert!(!beyond.terminated && beyond.truncated, "as in Gymnasium");
        assert!(beyond.done() && last.done());
        acrobot.reset();
        assert_eq!(acrobot.elapsed_steps(), 0);
        assert!(!acrobot.step(Action::Zero).done());
        acrobot.set_max_steps(3.try_into().unwrap());
        assert!(!acrobot.step(Action::Zero).done());
        assert!(acrobot.step(Action::Zero).truncated, "the count goes on");
    }
    check(TimeLimit::v1(Acrobot::new(1)), 500);
    check(TimeLimit::of(Acrobot::<Fast, GymnasiumV0>::new(1)), 200);
}

#[test]
fn acrobots_are_equal_by_parameters_state_and_generator() {
    let acrobot = Acrobot::<Portable>::new(0);
    assert_eq!(acrobot, acrobot.clone());
    let changes: [fn(&mut Acrobot<Portable>); 3] = [
        |other| other.set_params(Params { mass2: 1.5, ..Params::DEFAULT }).unwrap(),
        |other| other.set_state(State::default()).unwrap(),
        |other| _ = Action::sample(other.rng_mut()),
    ];
    for change in changes {
        let mut other = acrobot.clone();
        change(&mut other);
        assert_ne!(acrobot, other);
    }
}

#[test]
fn reset_with_takes_a_seed_and_bounds() {
    let bounds = ResetBounds::new(-3.0, 5.0).unwrap();
    let mut acrobot = TimeLimit::v1(Acrobot::<Fast>::new(0));
    let new = TimeLimit::v1(Acrobot::new(7));
    acrobot.step(Action::Zero);
    assert_eq!(acrobot.reset_with_seed(7), new.observation());
    assert_eq!(acrobot, new);
    for options in [ResetOptions::from(7), SeedSequence::new(7).into()] {
        acrobot.step(Action::Zero);
        assert_eq!(acrobot.reset_with(options), new.observation());
        assert_eq!(acrobot, new);
    }

    acrobot.step(Action::Zero);
    let observation = acrobot.reset_with(ResetOptions { bounds: Some(bounds), ..7.into() });
    let mut expected = TimeLimit::v1(Acrobot::hanging(Pcg64::new(7)));
    let draw = |acrobot: &mut Acrobot<_>| {
        let state = bounds.draw(acrobot.rng_mut());
        acrobot.set_state(state.cast()).unwrap();
        acrobot.observation()
    };
    assert_eq!(observation, draw(expected.inner_mut()));
    assert_eq!(acrobot, expected);

    acrobot.step(Action::Zero);
    acrobot.reset_with(bounds.into());
    draw(expected.inner_mut());
    assert_eq!(acrobot, expected, "without a seed the stream continues");
}

fn bits_of<A: Arithmetic>(acrobot: &Acrobot<A>, step: Step) -> ([u64; 4], [u64; 6], u32, bool) {
    (bits(acrobot.state()), bits(step.observation), step.reward.to_bits(), step.terminated)
}

#[test]
fn acrobots_made_by_the_compiler_equal_those_made_at_run_time() {
    fn check<A: Arithmetic>(made: &Acrobot<A>, state: State) {
        let (mut made, state) = (made.clone(), state.cast());
        let mut set = Acrobot::<A>::with_params(0, *made.params()).unwrap();
        *set.rng_mut() = Pcg64::new(42);
        set.set_state(state).unwrap();
        assert_eq!(made, set);
        assert_eq!(made.observation(), set.observation());
        let mut actions = Pcg64::new(1);
        for noise in [0.0, 0.5] {
            let torque_noise = A::Scalar::from_f64(noise);
            for acrobot in [&mut made, &mut set] {
                let params = Params { torque_noise, ..*acrobot.params() };
                acrobot.set_params(params).unwrap();
            }
            for _ in 0..200 {
                let action = Action::sample(&mut actions);
                let (step, expected) = (made.step(action), set.step(action));
                assert_eq!(bits_of(&made, step), bits_of(&set, expected));
            }
        }
        assert_eq!(made.reset(), set.reset());
        assert_eq!(made, set);
    }
    macro_rules! check_static {
        ($($arithmetic:ty),*) => {$({
            static HANGING: Acrobot<$arithmetic> = Acrobot::hanging(Pcg64::new(42));
            static GIVEN: Acrobot<$arithmetic> = {
                let state = State { theta1: 2.5, theta2: -4.0, dtheta1: 3.0, dtheta2: -30.0 };
                let params = Params::<<$arithmetic as Arithmetic>::Scalar> {
                    length1: 0.7,
                    center_of_mass1: 0.3,
                    center_of_mass2: 0.6,
                    dt: 0.05,
                    dynamics: Dynamics::Nips,
                    ..Params::DEFAULT
                };
                let Ok(pendulum) = params.pendulum::<$arithmetic>(state) else {
                    panic!()
                };
                Acrobot::from_pendulum(pendulum, Pcg64::new(42))
            };
            check(&HANGING, State::default());
            check(&GIVEN, State::from([2.5, -4.0, 3.0, -30.0]));
        })*};
    }
    static HOST: Acrobot<Host> = Acrobot::hanging(Pcg64::new(42));
    check(&HOST, State::default());
    check_static!(Reference, Portable, Fast, Micro, Damped<Fast>);
}

#[test]
fn an_observation_shows_the_state() {
    let state = State::from([0.5, -2.0, 3.0, -4.0]);
    let pendulum = Pendulum::<Portable>::new(Params::DEFAULT, state).unwrap();
    let acrobot = Acrobot::<_, Gymnasium, _>::from_pendulum(pendulum, ());
    let (sin1, cos1) = Portable::sin_cos(0.5);
    let (sin2, cos2) = Portable::sin_cos(-2.0);
    let seen = acrobot.observation();
    assert_eq!(seen, [cos1, sin1, cos2, sin2, 3.0, -4.0].map(|x| x as f32));
}

#[test]
fn a_step_is_stored() {
    let step = Acrobot::<Fast>::new(42).step(Action::Positive);
    let json = serde_json::to_string(&step).unwrap();
    assert_eq!(serde_json::from_str::<Step>(&json).unwrap(), step);
}
