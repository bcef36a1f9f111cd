//! Nothing recorded is lost: the last transitions, in order, and in CSV to the bit.

use std::num::NonZeroU32;

use acrobot::{Acrobot, Action, Fast, LimitedStep, State, TimeLimit, Trajectory, Transition};

fn record<const N: usize>(steps: usize) -> (Trajectory<f32, N>, Vec<Transition<f32>>) {
    let limit = NonZeroU32::new(20).unwrap();
    let mut acrobot = TimeLimit::new(Acrobot::<Fast>::new(4), limit);
    let mut trajectory = Trajectory::new();
    let mut all = Vec::new();
    for i in 0..steps {
        let action = Action::ALL[i % 3];
        let mut twin = acrobot.clone();
        let LimitedStep {
            reward,
            terminated,
            truncated,
            ..
        } = twin.step(action);
        all.push(Transition {
            state: acrobot.inner().state(),
            torque: [-1.0, 0.0, 1.0][i % 3],
            reward,
            next: twin.inner().state(),
            terminated,
            truncated,
        });
        trajectory.step(&mut acrobot, action);
        assert_eq!(acrobot, twin);
    }
    (trajectory, all)
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
    }
}

#[test]
fn a_trajectory_reads_back_from_csv_to_the_same_bits() {
    let (trajectory, all) = record::<10>(25);
    let mut csv = String::new();
    trajectory.write_csv(&mut csv).unwrap();
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(names[..2], ["step", "theta1 (rad)"]);
    for ((line, number), expected) in lines.by_ref().zip(16..).zip(&all[15..]) {
        let fields: Vec<f32> = line
            .split(',')
            .map(|field| field.parse().unwrap())
            .collect();
        assert_eq!(fields.len(), names.len());
        assert_eq!(fields[0], number as f32);
        let state = |fields: &[f32]| State::from(<[f32; 4]>::try_from(fields).unwrap());
        let flag = |x: f32| x == 1.0;
        let read = Transition {
            state: state(&fields[1..5]),
            torque: fields[5],
            reward: fields[6],
            next: state(&fields[7..11]),
            terminated: flag(fields[11]),
            truncated: flag(fields[12]),
        };
        assert_eq!(read, *expected);
    }
    assert_eq!(csv.lines().count(), 11);
}
