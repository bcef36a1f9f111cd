//! A trajectory keeps the last transitions, in order, and writes them exactly.

use std::num::NonZeroU32;

use acrobot::trajectory::{HEADER, Trajectory, Transition};
use acrobot::{Acrobot, Action, Error, Fast, Step, TimeLimit};

fn record<const N: usize>(steps: usize) -> (Trajectory<f32, N>, Vec<Transition<f32>>) {
    let limit = NonZeroU32::new(20).unwrap();
    let mut acrobot = TimeLimit::new(Acrobot::<Fast>::new(4), limit);
    let mut trajectory = Trajectory::new();
    let mut all = Vec::new();
    for i in 0..steps {
        let action = Action::ALL[i % 3];
        let mut twin = acrobot.clone();
        let Step { reward, terminated, truncated, .. } = twin.step(action);
        all.push(Transition {
            state: acrobot.state(),
            torque: [-1.0, 0.0, 1.0][i % 3],
            reward,
            next: twin.state(),
            terminated,
            truncated,
        });
        trajectory.step(&mut acrobot, action);
        assert_eq!(acrobot, twin);
    }
    (trajectory, all)
}

#[test]
fn torques_are_recorded_too() {
    let limit = NonZeroU32::new(2).unwrap();
    let mut acrobot = TimeLimit::new(Acrobot::<Fast>::new(4), limit);
    let mut twin = acrobot.clone();
    let mut trajectory = Trajectory::<f32, 10>::new();
    for torque in [-2.5, 0.5, 3.0] {
        let step = trajectory.step_torque(&mut acrobot, torque);
        assert_eq!(step, twin.step_torque(torque));
    }
    let recorded = trajectory.iter().map(|row| (row.torque, row.truncated));
    assert!(recorded.eq([(-2.5, false), (0.5, true), (3.0, true)]));

    // A torque that is rejected adds no transition and takes no step.
    let error = trajectory.step_torque(&mut acrobot, f32::NAN).unwrap_err();
    assert!(matches!(error, Error::OutOfRange { name: "torque", .. }));
    assert_eq!(acrobot, twin);
    assert_eq!(trajectory.len(), 3);
}

#[test]
fn a_transition_takes_42_bytes() {
    let (_, all) = record::<10>(25);
    for transition in all {
        let bytes = postcard::to_stdvec(&transition).unwrap();
        assert_eq!(bytes.len(), 42);
        assert_eq!(postcard::from_bytes(&bytes), Ok(transition));
    }
}

#[test]
fn a_trajectory_keeps_the_last_transitions_in_order() {
    for steps in [0, 1, 9, 10, 11, 25] {
        let (mut trajectory, all) = record::<10>(steps);
        let kept = steps.min(10);
        assert_eq!(trajectory.len(), kept);
        assert_eq!(trajectory.is_empty(), steps == 0);
        assert!(trajectory.iter().eq(&all[steps - kept..]));
        trajectory.clear();
        assert!(trajectory.is_empty());
        all.iter().for_each(|transition| trajectory.push(*transition));
        let first = trajectory.rows().next().map(|row| row.to_string());
        let number = format!("{},", steps - kept + 1);
        assert!(first.is_none_or(|first| first.starts_with(&number)));
    }
}

#[test]
fn a_row_of_csv_reads_back_as_its_transition() {
    let (trajectory, all) = record::<10>(25);
    let mut csv = String::new();
    trajectory.write_csv(&mut csv).unwrap();
    assert!(csv.ends_with('\n'));
    let mut rows = csv.lines();
    assert_eq!(rows.next(), Some(HEADER));
    assert_eq!(HEADER.split(',').count(), 13);
    assert!(rows.clone().eq(trajectory.rows().map(|row| row.to_string())));
    for (i, transition) in all.iter().enumerate().skip(15) {
        let row: Vec<&str> = rows.next().unwrap().split(',').collect();
        assert_eq!(row[0], (i + 1).to_string());
        let before = <[_; 4]>::from(transition.state);
        let after = <[_; 4]>::from(transition.next);
        let numbers = [&before[..], &[transition.torque, transition.reward], &after].concat();
        for (text, number) in row[1..11].iter().zip(numbers) {
            assert_eq!(text.parse(), Ok(number));
            assert_eq!(*text, number.to_string(), "the shortest text");
        }
        assert_eq!(row[11], u8::from(transition.terminated).to_string());
        assert_eq!(row[12], u8::from(transition.truncated).to_string());
    }
    assert_eq!(rows.next(), None);
}
