//! dm_control's swing-up: its model, steps, observations and rewards equal those that
//! `tests/data/swingup.py` recorded.

use std::f64::consts::PI;

use acrobot::arithmetic::{Arithmetic, Damped, Host, Micro, Real, Reference};
use acrobot::batch::VecBatch;
use acrobot::task::{Swingup, Task};
use acrobot::{Acrobot, Action, Fast, Params, Portable, State, TimeLimit};
use common::{distance, numbers, text_of};

/// This crate's angles are from hanging, dm_control's from upright.
fn state(numbers: &[f64]) -> State {
    let [theta1, rest @ ..] = <[f64; 4]>::try_from(numbers).unwrap();
    let [theta2, dtheta1, dtheta2] = rest;
    State::from([theta1 + PI, theta2, dtheta1, dtheta2])
}

/// The largest error of a state, an observation and a reward, over the steps of ten episodes. The
/// reward is 1 where dm_control's sparse reward is.
fn errors<A: Arithmetic>() -> [f64; 3] {
    let mut acrobot = Acrobot::<A, Swingup>::new(0);
    let (mut worst, mut count) = ([0.0_f64; 3], 0);
    let text = text_of("tests/data/swingup.txt");
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let recorded = numbers(line);
        acrobot.set_state(state(&recorded[..4]).cast()).unwrap();
        let step = acrobot.step_torque(Real::from_f64(2.0 * recorded[4])).unwrap();
        assert!(!step.terminated);
        assert_eq!(f64::from(u8::from(step.reward == 1.0)), recorded[16]);
        let seen = step.observation.iter().zip(&recorded[9..15]);
        let errors = [
            distance(acrobot.state().cast(), state(&recorded[5..9])),
            seen.fold(0.0, |most, (x, y)| most.max((f64::from(*x) - y).abs())),
            (f64::from(step.reward) - recorded[15]).abs(),
        ];
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = worst.max(error);
        }
        count += 1;
    }
    assert_eq!(count, 1000, "steps in tests/data/swingup.txt: edit this count");
    worst
}

#[test]
fn steps_observations_and_rewards_are_dm_controls() {
    for ([state, observation, reward], limit) in [
        (errors::<Damped<Reference>>(), 1e-12),
        (errors::<Damped<Portable>>(), 1e-12),
        (errors::<Damped<Host>>(), 1e-12),
        (errors::<Damped<Fast>>(), 5e-6),
        (errors::<Damped<Micro>>(), 1e-5),
    ] {
        assert!(state < limit, "{state:e}");
        // Observations and rewards are `f32`.
        assert!(observation < limit + 1e-6, "{observation:e}");
        assert!(reward < limit + 1e-6, "{reward:e}");
    }
}

/// Also within 0.1 mm beyond, where the nearest `f32` is 1. Both links lean to the same side, or to
/// different sides.
fn rewards_below_1_beyond_the_target<A: Arithmetic>() {
    let mut acrobot = Acrobot::<A, Swingup>::new(0);
    let params = Params { dt: 1e-9, ..Params::<f64>::SWINGUP };
    acrobot.set_params(params.cast()).unwrap();
    for index in (-1000..1000).filter(|index: &i32| index.abs() > 20) {
        let beyond = f64::from(index) * 1e-7;
        let distance = 0.2 + beyond;
        for (lean, theta2) in
            [(2.0 * (distance / 4.0).asin(), 0.0), ((1.0 - distance / 2.0).acos(), -2.0)]
        {
            let state = State::from([PI + lean, theta2 * lean, 0.0, 0.0]);
            acrobot.set_state(state.cast()).unwrap();
            let reward = acrobot.step(Action::Zero).reward;
            assert_eq!(reward == 1.0, beyond < 0.0, "{beyond:e} m: {reward}");
        }
    }
}

#[test]
fn a_reward_of_1_is_the_sparse_one() {
    rewards_below_1_beyond_the_target::<Damped<Reference>>();
    rewards_below_1_beyond_the_target::<Damped<Fast>>();
}

/// Where a link points up, down or aside, a rounding can lead beyond 1. Alone and in a batch.
fn orientations_within_1<A: Arithmetic>() {
    let within = |seen: &[f32; 6]| {
        let [sin1, sin_sum, cos1, cos_sum, ..] = *seen;
        let lengths = [sin1.hypot(cos1), sin_sum.hypot(cos_sum)];
        assert!(lengths.iter().all(|x| (x - 1.0).abs() < 3e-6), "{seen:?}");
        assert!(seen[..4].iter().all(|x| x.abs() <= 1.0), "{seen:?}");
    };
    let mut acrobot = Acrobot::<A, Swingup>::new(0);
    let mut batch = VecBatch::<A, Swingup>::new(1, 20_000).unwrap();
    for index in 0..batch.len() {
        let drawn = batch.state(index).unwrap();
        let aside = f64::from(index as u32 % 8) * (PI / 2.0) - drawn.theta1.to_f64();
        let theta2 = Real::from_f64(aside);
        let state = State { theta2, ..drawn };
        batch.set_state(index, state).unwrap();
        acrobot.set_state(state).unwrap();
        within(&acrobot.observation());
        within(&acrobot.step(Action::Zero).observation);
    }
    // No step of the batch: those of five arithmetics take a minute to compile.
    batch.observations().iter().for_each(within);
}

#[test]
fn orientations_are_within_1() {
    orientations_within_1::<Damped<Reference>>();
    orientations_within_1::<Damped<Host>>();
    orientations_within_1::<Damped<Portable>>();
    orientations_within_1::<Damped<Fast>>();
    orientations_within_1::<Damped<Micro>>();
}

/// With lengths so large that the distance from the target overflows, too.
#[test]
fn rewards_are_finite_from_0_to_1() {
    for length2 in [1e-3, 1.0, 1e3, 1e30] {
        let params = Params { length2, ..Params::<f32>::SWINGUP };
        let mut acrobot = Acrobot::<Damped<Fast>, Swingup>::new(1);
        acrobot.set_params(params).unwrap();
        for _ in 0..200 {
            let step = acrobot.step(Action::Positive);
            assert!((0.0..=1.0).contains(&step.reward), "{}", step.reward);
        }
    }
    let mut upright = Acrobot::<Damped<Fast>, Swingup>::new(0);
    upright.set_state(State::UPRIGHT).unwrap();
    assert_eq!(upright.step(Action::Zero).reward, 1.0);
}

#[test]
fn episodes_begin_at_rest_anywhere_and_last_a_thousand_steps() {
    let mut acrobot = Acrobot::<Damped<Fast>, Swingup>::new(42);
    let mut quadrants = [0; 16];
    for _ in 0..1000 {
        let State { theta1, theta2, dtheta1, dtheta2 } = acrobot.state();
        assert_eq!([dtheta1, dtheta2], [0.0; 2]);
        let quadrant = |x: f32| ((x + 3.2) / 1.6) as usize;
        quadrants[4 * quadrant(theta1) + quadrant(theta2)] += 1;
        acrobot.reset();
    }
    assert!(quadrants.into_iter().all(|count| count > 30), "{quadrants:?}");

    let mut episode = TimeLimit::new(acrobot, Swingup::MAX_STEPS);
    let lengths = (1..).find(|_| episode.step(Action::Positive).is_done());
    assert_eq!(lengths, Some(1000));
}
