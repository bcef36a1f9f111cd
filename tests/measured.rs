//! The motor and the sensors of a real acrobot: what they do to torques and readings, with equal
//! bits alone and in batches, and what they reject.

use acrobot::arithmetic::{Arithmetic, Damped};
use acrobot::batch::{Autoreset, VecBatch};
use acrobot::env::Env;
use acrobot::physics::wrap;
use acrobot::task::{
    Balance, Draw, Encoders, Gymnasium, GymnasiumV0, Instruments, Measured, Pose, Swingup, Task,
};
use acrobot::{Acrobot, Action, Error, Fast, Portable, ResetOptions, State};
use common::smooth::Smooth;
use common::twins::{LEVELS, Twins};

const ALL: Instruments = {
    const fn uniform(low: f32, high: f32) -> Option<Draw<f32>> {
        Some(Draw::Uniform { low, high })
    }
    Instruments {
        action_delay: uniform(0.0, 4.0),
        observation_delay: uniform(0.0, 4.0),
        motor_lag: Some(Draw::LogUniform { low: 0.01, high: 0.2 }),
        torque_error: Some(Draw::Normal { mean: 0.0, std: 0.1, low: -0.3, high: 0.3 }),
        angle_noise: uniform(0.0, 0.01),
        encoder_zero1: uniform(-0.05, 0.05),
        encoder_zero2: uniform(-0.05, 0.05),
        encoder_counts: Some(Draw::exactly(4096.0)),
        velocity_filter: uniform(0.0, 0.1),
    }
};

fn twins<A: Arithmetic, T: Task>(instruments: Instruments) {
    let task = Measured::<T>::new(T::DEFAULT, instruments).unwrap();
    for level in LEVELS {
        for (own, mode) in [(false, Autoreset::SameStep), (true, Autoreset::NextStep)] {
            let mut twins = Twins::<A, 16, Measured<T>>::new(21, own, mode);
            twins.batch.set_simd_level(level);
            twins.batch.set_task(task);
            for alone in &mut twins.alone {
                alone.inner_mut().set_task(task);
            }
            if own {
                twins.batch.set_draws(common::draws::<A>()).unwrap();
            }
            twins.reset(None, ResetOptions::default());
            twins.swing(120);
            let mask: Vec<_> = (0..21).map(|i| i % 3 == 0).collect();
            twins.reset(Some(&mask), 7.into());
            twins.swing(20);
            twins.reset_to(&[State::from([3.0, 0.5, -2.0, 1.0]).cast(); 21]);
            twins.swing(20);
        }
    }
}

#[test]
fn a_batch_has_the_bits_of_single_acrobots() {
    twins::<Fast, Gymnasium>(ALL);
    twins::<Fast, Gymnasium>(Instruments { angle_noise: ALL.angle_noise, ..Instruments::IDEAL });
    twins::<Portable, Smooth>(ALL);
}

fn measured<A: Arithmetic, T: Task>(instruments: Instruments) -> Acrobot<A, Measured<T>> {
    let task = Measured::new(T::DEFAULT, instruments).unwrap();
    Acrobot::with_task(5, task).unwrap()
}

/// Also numbers that are drawn and 0.
#[test]
fn ideal_instruments_change_nothing() {
    let exact = Some(Draw::Fixed);
    let zeros = Instruments {
        action_delay: exact,
        observation_delay: exact,
        torque_error: exact,
        angle_noise: exact,
        encoder_zero1: exact,
        encoder_counts: exact,
        ..Instruments::IDEAL
    };
    for instruments in [Instruments::IDEAL, zeros] {
        let mut ideal = measured::<Fast, Gymnasium>(instruments);
        let mut plain = Acrobot::<Fast>::new(5);
        assert_eq!(ideal.observation(), plain.observation());
        for i in 0..500 {
            let torque = libm::sinf(i as f32 * 0.1);
            assert_eq!(ideal.step_torque(torque), plain.step_torque(torque));
        }
        assert_eq!(ideal.rng() == plain.rng(), instruments == Instruments::IDEAL);
    }
    // Every second episode of a balance begins beyond π.
    let mut ideal = measured::<Fast, Balance>(Instruments::IDEAL);
    let mut plain = Acrobot::<Fast, Balance>::new(5);
    for _ in 0..20 {
        assert_eq!(ideal.reset(), plain.reset());
    }
}

#[test]
fn delays_are_whole_steps() {
    for (action, observation) in [(0, 3), (2, 0), (4, 4), (1, 2)] {
        let mut late = measured::<Fast, Gymnasium>(Instruments {
            action_delay: Some(Draw::exactly(action as f32)),
            observation_delay: Some(Draw::exactly(observation as f32)),
            ..Instruments::IDEAL
        });
        let mut plain = Acrobot::<Fast>::new(5);
        let (mut torques, mut rows) = (vec![0.0; action], vec![plain.observation(); observation]);
        for i in 0..50 {
            torques.push(libm::sinf(i as f32 * 0.3));
            let expected = plain.step_torque(torques[i]).unwrap();
            rows.push(expected.observation);
            let found = late.step_torque(torques[i + action]).unwrap();
            assert_eq!((found.observation, found.reward), (rows[i], expected.reward));
            assert_eq!(late.state(), plain.state());
        }
    }
}

#[test]
fn each_delay_is_drawn_equally_often() {
    let instruments = Instruments { action_delay: ALL.action_delay, ..Instruments::IDEAL };
    let task = Measured::<Gymnasium>::new(Gymnasium, instruments).unwrap();
    let batch = VecBatch::<Fast, _>::with_task(1, task, 5000).unwrap();
    let mut counts = [0; 5];
    for i in 0..5000 {
        let drawn = Measured::<Gymnasium>::drawn(&batch.memory(i).unwrap());
        counts[drawn.action_delay as usize] += 1;
        assert_eq!(drawn.motor_lag, 0.0);
    }
    // Four standard deviations.
    assert!(counts.iter().all(|count| (1000_i32 - count).abs() < 114), "{counts:?}");
}

/// The error of each reading of θ1 and θ2, rad, while 40 acrobots hang.
fn errors(instruments: Instruments, steps: usize) -> Vec<Vec<[f64; 2]>> {
    let task = Measured::<GymnasiumV0>::new(GymnasiumV0, instruments).unwrap();
    let mut batch = VecBatch::<Portable, _>::with_task(3, task, 40).unwrap();
    batch.set_autoreset(Autoreset::Disabled);
    batch.reset_to(&[State::HANGING; 40]).unwrap();
    let mut errors = vec![vec![]; 40];
    for _ in 0..steps {
        let rows = &batch.step(&[Action::Zero; 40]).unwrap().observations;
        for (errors, [theta1, theta2, ..]) in errors.iter_mut().zip(rows) {
            errors.push([f64::from(*theta1), f64::from(*theta2)]);
        }
    }
    errors
}

/// Moments, tails and correlations of 80,000 draws, within four standard deviations of an estimate.
#[test]
fn noise_is_nearly_normal_and_independent() {
    let angle_noise = Some(Draw::exactly(0.5));
    let errors = errors(Instruments { angle_noise, ..Instruments::IDEAL }, 1000);
    let z = |i: usize, step: usize, angle: usize| 2.0 * errors[i][step][angle];
    let mean = |f: &dyn Fn(usize, usize) -> f64| {
        let all = (0..40).flat_map(|i| (1..1000).map(move |step| (i, step)));
        all.map(|(i, step)| f(i, step)).sum::<f64>() / (40.0 * 999.0)
    };
    let of_both = |f: &dyn Fn(f64) -> f64| 0.5 * mean(&|i, k| f(z(i, k, 0)) + f(z(i, k, 1)));
    assert!(of_both(&|z| z).abs() < 4.0 / 80_000_f64.sqrt());
    assert!((of_both(&|z| z * z) - 1.0).abs() < 0.019);
    assert!(of_both(&|z| z.powi(3)).abs() < 0.05);
    assert!((of_both(&|z| z.powi(4)) - 2.7).abs() < 0.12);
    for limit in [2.0, 3.0] {
        let expected = (2.0 - limit / 3_f64.sqrt()).powi(4) / 12.0; // of a sum of four
        let beyond = of_both(&|z| f64::from(u8::from(z.abs() > limit)));
        let deviation = f64::sqrt(expected / 80_000.0);
        assert!((beyond - expected).abs() < 4.0 * deviation, "{limit}: {beyond}");
    }
    let limit = 4.0 / 40_000_f64.sqrt();
    let correlations = [
        mean(&|i, k| z(i, k, 0) * z(i, k, 1)),
        mean(&|i, k| z(i, k, 0) * z(i, k - 1, 0)),
        mean(&|i, k| z(i, k, 0) * z(i, k - 1, 1)),
        mean(&|i, k| z(i, k, 0) * z((i + 1) % 40, k, 0)),
        mean(&|i, k| z(i, k, 1) * z((i + 16) % 40, k, 1)),
    ];
    assert!(correlations.iter().all(|r| r.abs() < limit), "{correlations:?}");
}

#[test]
fn readings_have_zeros_and_whole_counts() {
    let errors = errors(
        Instruments {
            angle_noise: Some(Draw::exactly(0.02)),
            encoder_zero1: Some(Draw::exactly(0.3)),
            encoder_zero2: Some(Draw::exactly(-0.2)),
            encoder_counts: Some(Draw::exactly(1000.0)),
            ..Instruments::IDEAL
        },
        100,
    );
    for (angle, zero) in [(0, 0.3), (1, -0.2)] {
        let readings: Vec<f64> = errors.iter().flatten().map(|both| both[angle]).collect();
        let mean = readings.iter().sum::<f64>() / readings.len() as f64;
        assert!((mean - f64::from(zero as f32)).abs() < 4.0 * 0.02 / 4000_f64.sqrt(), "{mean}");
        let counts = readings.iter().map(|x| x / std::f64::consts::TAU * 1000.0);
        assert!(counts.clone().all(|counts| (counts - counts.round()).abs() < 1e-4));
        let [low, high] = [counts.clone().fold(0.0, f64::min), counts.fold(0.0, f64::max)];
        assert!(high.max(-low) > 30.0, "{low} {high}");
    }
}

#[test]
fn velocities_are_filtered_differences_of_readings() {
    let velocity_filter = Some(Draw::exactly(0.2));
    let mut slow =
        measured::<Fast, Gymnasium>(Instruments { velocity_filter, ..Instruments::IDEAL });
    let (mut before, mut velocity) = (slow.state(), slow.state().dtheta1);
    for _ in 0..200 {
        let [.., seen, _] = slow.step(Action::Positive).observation;
        let difference = wrap(slow.state().theta1 - before.theta1) / 0.2;
        velocity += 0.5 * (difference - velocity);
        assert!((seen - velocity).abs() < 1e-4, "{seen} {velocity}");
        before = slow.state();
    }
}

/// A policy sees on a machine, whose encoders count turns, what it saw in training.
#[test]
fn encoders_give_the_readings_of_a_simulation() {
    let instruments = Instruments {
        encoder_counts: Some(Draw::exactly(1000.0)),
        velocity_filter: Some(Draw::exactly(0.05)),
        ..Instruments::IDEAL
    };
    let mut acrobot = measured::<Fast, Gymnasium>(instruments);
    acrobot.set_state(State::HANGING).unwrap();
    let mut encoders = Encoders::new(1000, 0.05, 0.2, [5000, -3000]).unwrap();
    let mut turns = 0;
    for i in 0..500 {
        let action = if i / 9 % 2 == 0 { Action::Positive } else { Action::Negative };
        let observation = acrobot.step(action).observation;
        let of_a_radian = 1000.0 * std::f64::consts::TAU.recip() as f32;
        let State { theta1, theta2, .. } = acrobot.state();
        let counts = [theta1, theta2].map(|x| libm::rintf(x * of_a_radian) as i32);
        turns += i32::from(counts[1].abs() > 400);
        let state = encoders.read([counts[0] + 1000 * turns, counts[1] - 7000]);
        assert_eq!(Gymnasium.observe::<Fast, f32>(&Pose::of::<Fast>(state)), observation);
    }
    assert!(turns > 5, "{turns}");
    let rejected =
        |of_a_turn, filter, dt| Encoders::new(of_a_turn, filter, dt, [0; 2]).unwrap_err();
    assert_eq!(
        rejected(0, 0.0, 1.0).to_string(),
        "encoder_counts must be from 1 to 2²² a turn, got 0"
    );
    assert_eq!(rejected(1, -1.0, 1.0).name(), "velocity_filter");
    assert_eq!(rejected(1, 0.0, 0.0).name(), "dt");
    let mut extreme = Encoders::new(3, 0.0_f64, 1.0, [i32::MIN, i32::MAX]).unwrap();
    assert!(extreme.read([i32::MAX, i32::MIN]).theta1.abs() < 3.15);
}

#[test]
fn a_motor_lags_and_errs() {
    let mut slow = measured::<Portable, Gymnasium>(Instruments {
        motor_lag: Some(Draw::exactly(0.6)),
        torque_error: Some(Draw::exactly(0.5)),
        ..Instruments::IDEAL
    });
    let mut plain = Acrobot::<Portable>::new(5);
    let mut torque = 0.0;
    for _ in 0..100 {
        slow.step(Action::Positive);
        torque += 0.25 * (1.0 - torque);
        plain.step_torque(1.5 * torque).unwrap();
        assert!((slow.state().theta1 - plain.state().theta1).abs() < 1e-6);
    }
}

/// A number for each acrobot, which resets keep.
#[test]
fn acrobots_keep_their_own_instruments() {
    let encoder_zero1 = Some(Draw::Fixed);
    let instruments = Instruments { encoder_zero1, ..Instruments::IDEAL };
    let task = Measured::<GymnasiumV0>::new(GymnasiumV0, instruments).unwrap();
    let mut batch = VecBatch::<Fast, _>::with_task(1, task, 3).unwrap();
    for (i, zero) in [0.5, 0.0, -0.5].into_iter().enumerate() {
        let mut memory = batch.memory(i).unwrap();
        let drawn = Instruments { encoder_zero1: zero, ..Default::default() };
        Measured::<GymnasiumV0>::set_drawn(&mut memory, drawn).unwrap();
        batch.set_memory(i, memory).unwrap();
    }
    batch.reset();
    let read = batch.observations().iter().map(|[theta1, ..]| *theta1).collect::<Vec<_>>();
    let truth = [0, 1, 2].map(|i| batch.state(i).unwrap().theta1);
    assert_eq!(read, [truth[0] + 0.5, truth[1], truth[2] - 0.5]);
    let memory = batch.memory(0).unwrap();
    let beyond = Instruments { encoder_zero1: 3.2, ..Default::default() };
    let error = Measured::<GymnasiumV0>::set_drawn(&mut { memory }, beyond).unwrap_err();
    assert_eq!(error.to_string(), "encoder_zero1 must be from -π to π rad, got 3.200000047683716");
    assert_eq!(batch.set_memory(3, memory), Err(Error::NoSuchIndex { index: 3, len: 3 }));
}

#[test]
fn observations_are_in_their_space() {
    let mut acrobot = measured::<Fast, Gymnasium>(ALL);
    let space = Env::observation_space(&acrobot);
    let mut fastest = 0.0_f32;
    for i in 0..20_000 {
        let action = if i / 7 % 2 == 0 { Action::Positive } else { Action::Negative };
        let seen = acrobot.step(action).observation;
        assert!(space.contains(seen.as_ref()), "{seen:?}");
        fastest = fastest.max(seen[5].abs());
        if i % 500 == 0 {
            acrobot.reset();
        }
    }
    assert!(fastest > 10.0 && space.high()[4] > 15.7, "{fastest}");
}

#[test]
fn bad_instruments_are_rejected() {
    let ideal = Instruments::IDEAL;
    let uniform = |low, high| Some(Draw::Uniform { low, high });
    let cases = [
        (Instruments { action_delay: uniform(0.0, 5.0), ..ideal }, "action_delay", 5.0),
        (Instruments { action_delay: uniform(-1.0, 2.0), ..ideal }, "action_delay", -1.0),
        (Instruments { observation_delay: uniform(0.5, 2.0), ..ideal }, "observation_delay", 0.5),
        (
            Instruments {
                observation_delay: Some(Draw::LogUniform { low: 1.0, high: 2.0 }),
                ..ideal
            },
            "observation_delay",
            1.0,
        ),
        (Instruments { motor_lag: uniform(-0.1, 0.1), ..ideal }, "motor_lag", -0.10000000149011612),
        (Instruments { motor_lag: uniform(0.2, 0.1), ..ideal }, "motor_lag", 0.20000000298023224),
        (Instruments { torque_error: uniform(-2.0, 0.0), ..ideal }, "torque_error", -2.0),
        (Instruments { angle_noise: uniform(0.0, 11.0), ..ideal }, "angle_noise", 11.0),
        (Instruments { encoder_zero2: uniform(-4.0, 0.0), ..ideal }, "encoder_zero2", -4.0),
        (Instruments { encoder_counts: uniform(0.0, 4096.0), ..ideal }, "encoder_counts", 0.0),
        (Instruments { velocity_filter: uniform(0.0, 2e3), ..ideal }, "velocity_filter", 2e3),
    ];
    for (instruments, named, given) in cases {
        match Measured::<Gymnasium>::new(Gymnasium, instruments) {
            Err(Error::OutOfRange { name, value, .. }) => assert_eq!((name, value), (named, given)),
            other => panic!("{other:?}"),
        }
    }
}

/// A snapshot has settings and memory. One of another task, of another longest delay or with
/// another number is rejected.
#[test]
fn snapshots_continue_with_equal_bits() {
    type One = Acrobot<Damped<Fast>, Measured<Swingup>>;
    type Many = VecBatch<Damped<Fast>, Measured<Swingup>>;
    let task = Measured::new(Swingup, ALL).unwrap();
    let mut one = One::with_task(1, task).unwrap();
    let mut many = Many::with_task(1, task, 20).unwrap();
    for _ in 0..30 {
        one.step(Action::Positive);
        many.step(&[Action::Positive; 20]).unwrap();
    }
    let bytes = postcard::to_stdvec(&(&one, &many)).unwrap();
    assert!(bytes.len() - postcard::to_stdvec(&many).unwrap().len() <= One::MAX_SNAPSHOT_SIZE);
    let (mut loaded, mut loaded_many): (One, Many) = postcard::from_bytes(&bytes).unwrap();
    assert_eq!(loaded, one);
    for _ in 0..30 {
        assert_eq!(loaded.step(Action::Negative), one.step(Action::Negative));
        let actions = [Action::Negative; 20];
        assert_eq!(loaded_many.step(&actions).unwrap(), many.step(&actions).unwrap());
    }
    let text = serde_json::to_string(&one).unwrap();
    assert_eq!(serde_json::from_str::<One>(&text).unwrap(), one);
    let error = |text: &str| serde_json::from_str::<One>(text).unwrap_err().to_string();
    let other = error(&text.replace("\"swingup\"", "\"balance\""));
    assert!(other.starts_with("the measured task must be \"swingup\" with delays"), "{other}");
    let longer = serde_json::from_str::<Acrobot<Damped<Fast>, Measured<Swingup, 8>>>(&text);
    assert!(longer.is_err());
    let (before, memory) = text.split_once("\"memory\":[").unwrap();
    let (delay, after) = memory.split_once(',').unwrap();
    let changed = error(&format!("{before}\"memory\":[{delay}5,{after}"));
    assert!(changed.starts_with("action_delay must be drawn uniformly from whole"), "{changed}");
}
