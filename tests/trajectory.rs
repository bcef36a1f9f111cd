//! Nothing recorded is lost: what steps did, in order. `properties/values.rs` has the rest.

use std::num::NonZeroU32;

use acrobot::{Acrobot, Action, Fast, LimitedStep, TimeLimit, Trajectory, Transition};

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
fn a_row_of_csv_reads_back_as_its_transition() {
    let (trajectory, all) = record::<10>(25);
    let mut csv = String::new();
    trajectory.write_csv(&mut csv).unwrap();
    let mut rows = csv.lines();
    assert_eq!(rows.next().unwrap().split(',').count(), 13);
    for (i, transition) in all.iter().enumerate().skip(15) {
        let row: Vec<&str> = rows.next().unwrap().split(',').collect();
        assert_eq!(row[0], (i + 1).to_string());
        let before = <[_; 4]>::from(transition.state);
        let after = <[_; 4]>::from(transition.next);
        let numbers = [&before[..], &[transition.torque, transition.reward], &after].concat();
        for (text, number) in row[1..11].iter().zip(numbers) {
            assert_eq!(text.parse(), Ok(number));
        }
        assert_eq!(row[11], u8::from(transition.terminated).to_string());
        assert_eq!(row[12], u8::from(transition.truncated).to_string());
    }
    assert_eq!(rows.next(), None);
}
