//! A trajectory keeps the last transitions, in order, and writes them exactly. `properties/values.rs` has more.

use std::num::NonZeroU32;

use acrobot::numpy::Pcg64;
use acrobot::trajectory::{Trajectory, Transition};
use acrobot::{Acrobot, Action, Error, Fast, Step, TimeLimit};

fn record<const N: usize>(steps: usize) -> (Trajectory<f32, N>, Vec<Transition<f32>>) {
    let limit = NonZeroU32::new(20).unwrap();
    let mut acrobot = TimeLimit::new(Acrobot::<Fast>::new(4), limit);
    let mut trajectory = Trajectory::new();
    let mut all = Vec::new();
    for i in 0..steps {
        let action = Action::ALL[i % 3];
        let mut twin = acrobot.clone();
        let Step {
            reward,
            terminated,
            truncated,
            ..
        } = twin.step(action);
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

/// `step` and `step_torque` record and return the step of an acrobot, with or without a time limit.
#[test]
fn acrobots_step_the_same_with_a_trajectory() {
    let mut acrobot = Acrobot::<Fast>::new(4);
    let mut limited = TimeLimit::new(acrobot.clone(), NonZeroU32::new(3).unwrap());
    let (mut twin, mut limited_twin) = (acrobot.clone(), limited.clone());
    let [mut bare, mut with_limit] = [(); 2].map(|()| Trajectory::<f32, 10>::new());
    for (action, torque) in Action::ALL.into_iter().zip([-2.5, 0.5, 3.0]) {
        assert_eq!(bare.step(&mut acrobot, action), twin.step(action));
        assert_eq!(
            with_limit.step(&mut limited, action),
            limited_twin.step(action)
        );
        assert_eq!(
            bare.step_torque(&mut acrobot, torque),
            twin.step_torque(torque)
        );
        assert_eq!(
            with_limit.step_torque(&mut limited, torque),
            limited_twin.step_torque(torque)
        );
    }
    assert_eq!((acrobot, limited), (twin, limited_twin));
    let torques = [-1.0, -2.5, 0.0, 0.5, 1.0, 3.0];
    assert!(bare.iter().map(|row| row.torque).eq(torques));
    assert!(bare.iter().all(|row| !row.truncated));
    // The two trajectories differ only in the time limit.
    let truncated = bare.iter().zip(1..).map(|(row, number)| Transition {
        truncated: number >= 3,
        ..*row
    });
    assert!(with_limit.iter().copied().eq(truncated));
}

/// A torque that is rejected adds no transition and takes no step.
#[test]
fn rejected_torques_are_not_recorded() {
    let mut acrobot = TimeLimit::v1(Acrobot::<Fast>::new(4));
    let before = acrobot.clone();
    let mut trajectory = Trajectory::<f32, 10>::new();
    let error = trajectory.step_torque(&mut acrobot, f32::NAN).unwrap_err();
    assert!(matches!(error, Error::OutOfRange { name: "torque", .. }));
    assert_eq!(acrobot, before);
    assert!(trajectory.is_empty());
}

/// `write_header` and `write_row` write the text of `write_csv`, into a buffer that is exactly long enough.
#[test]
fn single_rows_equal_the_csv() {
    let (trajectory, _) = record::<10>(25);
    let mut csv = String::new();
    trajectory.write_csv(&mut csv).unwrap();
    let mut lines = csv.split_inclusive('\n');
    let mut buffer = [0; 200];
    let header = trajectory.write_header(&mut buffer).unwrap();
    assert_eq!(Some(header), lines.next());
    assert_eq!(header.len(), 182);
    for (index, line) in lines.enumerate() {
        let needed = line.len();
        assert_eq!(trajectory.write_row(index, &mut buffer[..needed]), Ok(line));
        let mut short = vec![0; needed - 1];
        let len = short.len();
        assert_eq!(
            trajectory.write_row(index, &mut short),
            Err(Error::BufferTooSmall { len, needed })
        );
    }
    assert_eq!(
        trajectory.write_header(&mut buffer[..181]),
        Err(Error::BufferTooSmall {
            len: 181,
            needed: 182
        })
    );
    assert_eq!(
        trajectory.write_header(&mut []),
        Err(Error::BufferTooSmall {
            len: 0,
            needed: 182
        })
    );
    for index in [10, usize::MAX] {
        let error = Error::NoSuchIndex {
            name: "row",
            index,
            len: 10,
        };
        assert_eq!(trajectory.write_row(index, &mut buffer), Err(error));
    }
}

/// A row of random episodes, with `f32` and Gymnasium's parameters, takes at most 150 bytes.
#[test]
fn rows_are_as_long_as_documented() {
    let mut acrobot = TimeLimit::v1(Acrobot::<Fast>::new(4));
    let mut actions = Pcg64::new(4);
    let (mut buffer, mut rows, mut longest) = ([0; 500], 0, 0);
    for _ in 0..20 {
        let mut trajectory = Trajectory::<f32, 500>::new();
        while !trajectory
            .step(&mut acrobot, Action::sample(&mut actions))
            .done()
        {}
        for index in 0..trajectory.len() {
            let row = trajectory.write_row(index, &mut buffer).unwrap();
            (rows, longest) = (rows + 1, longest.max(row.len()));
        }
        acrobot.reset();
    }
    println!("longest of {rows} rows: {longest} bytes");
    assert!(rows > 5000 && longest <= 150);
}

/// postcard stores a transition of `f32` in 42 bytes, and reads it back.
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
            assert_eq!(*text, number.to_string(), "the shortest text");
        }
        assert_eq!(row[11], u8::from(transition.terminated).to_string());
        assert_eq!(row[12], u8::from(transition.truncated).to_string());
    }
    assert_eq!(rows.next(), None);
}
