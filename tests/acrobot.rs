//! The environment's contract beyond its numbers: construction, resets, terminations, time limits,
//! live changes, sizes and auto-traits.

use acrobot::arithmetic::{Arithmetic, Damped, Form, Host, Micro, Reference};
use acrobot::batch::{Block, LaneParams};

use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::{Dynamics, Pendulum};
use acrobot::task::{Draws, GymnasiumV0, ResetBounds, Task};
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
    assert!(size_of::<Acrobot<Reference>>() <= 432);
    assert!(size_of::<Acrobot<Portable>>() <= 432);
    assert!(size_of::<State<f32>>() == 16);
    assert!(REWARD_THRESHOLD == -100.0);
    assert!(ResetBounds::new(-0.25, 0.5).is_ok() && ResetBounds::new(0.5, -0.25).is_err());
    assert!(size_of::<Action>() == 1);
    assert!(size_of::<Fast>() == 0);
    assert!(size_of::<SeedSequence>() == 48);
    assert!(size_of::<Transition<f32>>() <= 44);
    assert!(size_of::<Block<Fast, 1>>() == 64 && size_of::<Block<Fast, 16>>() == 640);
    assert!(size_of::<LaneParams<Fast, 16>>() == 2240 && size_of::<Draws<f32>>() == 424);
    is_send_sync_clone::<Acrobot<Fast>>();
    is_send_sync_clone::<Pendulum<Fast>>();
    is_send_sync_clone::<Acrobot<Host>>();
    is_send_sync_clone::<TimeLimit<Acrobot<Micro>>>();
    is_send_sync_clone::<Trajectory<f32, 10>>();
    is_send_sync_clone::<Pcg64>();
    is_send_sync_clone::<Error>();
    is_send_sync_clone::<Error>();
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
        assert!((1..limit).all(|_| !acrobot.step(Action::Zero).truncated));
        acrobot.inner_mut().set_state(State::UPRIGHT).unwrap();
        let last = acrobot.step(Action::Zero);
        assert!(last.terminated && last.truncated && last.is_done(), "both on the last step");
        acrobot.inner_mut().set_state(State::HANGING).unwrap();
        let beyond = acrobot.step(Action::Zero);
        assert!(!beyond.terminated && beyond.truncated && beyond.is_done(), "as in Gymnasium");
        acrobot.reset();
        assert!(!acrobot.step(Action::Zero).is_done());
        acrobot.set_max_steps(3.try_into().unwrap());
        assert!(!acrobot.step(Action::Zero).is_done());
        assert!(acrobot.step(Action::Zero).truncated, "the count goes on");
        assert_eq!(acrobot.elapsed_steps(), 3);
    }
    check(TimeLimit::with_task_limit(Acrobot::<Fast>::new(1)), 500);
    check(TimeLimit::with_task_limit(Acrobot::<Fast, GymnasiumV0>::new(1)), 200);
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
    let new = TimeLimit::with_task_limit(Acrobot::<Fast>::new(7));
    let mut acrobot = TimeLimit::with_task_limit(Acrobot::new(0));
    let resets: [fn(&mut TimeLimit<Acrobot<Fast>>) -> _; 3] = [
        |acrobot| acrobot.reset_with_seed(7),
        |acrobot| acrobot.reset_with(7.into()),
        |acrobot| acrobot.reset_with(SeedSequence::new(7).into()),
    ];
    for reset in resets {
        acrobot.step(Action::Zero);
        assert_eq!(reset(&mut acrobot), new.observation());
        assert_eq!(acrobot, new);
    }

    // Without a seed the stream continues.
    let bounds = ResetBounds::new(-3.0, 5.0).unwrap();
    let mut rng = Pcg64::new(7);
    for options in [ResetOptions { bounds: Some(bounds), ..7.into() }, bounds.into()] {
        acrobot.step(Action::Zero);
        let observation = acrobot.reset_with(options);
        assert_eq!(acrobot.state(), bounds.draw(&mut rng).cast());
        assert_eq!((observation, acrobot.elapsed_steps()), (acrobot.observation(), 0));
    }
}

#[test]
fn acrobots_made_by_the_compiler_equal_those_made_at_run_time() {
    fn check<A: Arithmetic>(made: &Acrobot<A>, state: State) {
        let mut made = made.clone();
        let mut set = Acrobot::<A>::with_params(0, *made.params()).unwrap();
        *set.rng_mut() = Pcg64::new(42);
        set.set_state(state.cast()).unwrap();
        assert_eq!(made, set);
        assert_eq!(made.observation(), set.observation());
        for step in 0..100 {
            let action = Action::ALL[step % 3];
            assert_eq!(made.step(action), set.step(action));
            assert_eq!(bits(made.state()), bits(set.state()));
        }
    }
    macro_rules! check_static {
        ($($arithmetic:ty),*) => {$({
            static HANGING: Acrobot<$arithmetic> = Acrobot::hanging(Pcg64::new(42));
            static GIVEN: Acrobot<$arithmetic> = {
                let state = State { theta1: 2.5, theta2: -4.0, dtheta1: 3.0, dtheta2: -30.0 };
                let params = Params::<<$arithmetic as Arithmetic>::Scalar> {
                    length1: 0.7,
                    center_of_mass2: 0.6,
                    torque_noise: 0.5,
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
fn a_step_is_stored() {
    let step = Acrobot::<Fast>::new(42).step(Action::Positive);
    let json = serde_json::to_string(&step).unwrap();
    assert_eq!(serde_json::from_str::<Step>(&json).unwrap(), step);
}
