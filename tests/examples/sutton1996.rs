//! Sutton's experiment: its simulator, its numbers and its errors.

use super::{Folder, command, printed, rejected};
use acrobot::numpy::SeedSequence;
use acrobot::physics::{derivative, energy};
use acrobot::{Params, Portable, State};
use std::f64::consts::PI;
use std::fs;

#[path = "../../examples/sutton1996/learners.rs"]
mod learners;
#[path = "../../examples/sutton1996/simulator.rs"]
mod simulator;

use simulator::{advance, decide, is_goal};

const PARAMS: Params = simulator::PARAMS;

/// Updates both angles with the old velocities.
fn explicit_euler(state: &State) -> State {
    let rates = derivative::<Portable>(&PARAMS, state, 0.0);
    let y = <[f64; 4]>::from(*state);
    std::array::from_fn::<f64, 4, _>(|i| y[i] + PARAMS.dt * rates[i]).into()
}

#[test]
fn the_simulator_keeps_the_energy_where_explicit_euler_does_not() {
    let start = State::from([1.0, -0.5, 0.0, 0.0]);
    let of = |state: &State| energy::<Portable>(&PARAMS, state);
    let farthest = |step: fn(&State) -> State| {
        let mut state = start;
        let errors = (0..2000).map(|_| {
            state = step(&state);
            (of(&state) - of(&start)).abs()
        });
        errors.fold(0.0, f64::max)
    };
    // In 100 s without torque; from hanging to upright are 39.2 J.
    let [kept, fed] = [
        farthest(|state| advance(state, 0.0)),
        farthest(explicit_euler),
    ];
    assert!(kept < 2.0, "{kept} J");
    assert!(fed > 10.0, "{fed} J");
}

#[test]
fn the_simulator_updates_the_velocities_first_and_bounds_them() {
    let state = State::from([0.3, -0.2, 1.0, -2.0]);
    let [_, _, acceleration1, acceleration2] = derivative::<Portable>(&PARAMS, &state, 1.0);
    let next = advance(&state, 1.0);
    assert_eq!(next.dtheta1, 1.0 + 0.05 * acceleration1);
    assert_eq!(next.dtheta2, -2.0 + 0.05 * acceleration2);
    assert_eq!(next.theta1, 0.3 + 0.05 * next.dtheta1);
    assert_eq!(next.theta2, -0.2 + 0.05 * next.dtheta2);

    let whirling = advance(&State::from([0.0, 0.0, 50.0, -50.0]), 0.0);
    assert_eq!([whirling.dtheta1, whirling.dtheta2], [4.0 * PI, -9.0 * PI]);
}

#[test]
fn the_goal_ends_a_decision_early() {
    let rising = State::from([2.0, 0.0, 1.0, 0.0]);
    assert!(!is_goal(&rising));
    let (mut state, mut steps) = (rising, 0);
    while !is_goal(&state) {
        state = advance(&state, 0.0);
        steps += 1;
    }
    assert!(steps < 4, "{steps}");
    assert_eq!(decide(rising, 0.0), state);
    let hanging = State::default();
    let four = (0..4).fold(hanging, |state, _| advance(&state, 1.0));
    assert_eq!(decide(hanging, 1.0), four);
}

#[test]
fn the_experiment_reports_its_runs() {
    let folder = Folder::new("sutton1996");
    let (csv, picture) = (folder.file("curve.csv"), folder.file("curve.svg"));
    let [one, two] = ["1", "2"].map(|threads| {
        let mut arguments: Vec<&str> = "--runs 4 --episodes 12 --seed 7".split(' ').collect();
        arguments.extend(["--csv", &csv, "--picture", &picture]);
        let mut experiment = command("sutton1996", &arguments);
        let output = experiment.env("RAYON_NUM_THREADS", threads).output();
        let printed = printed(output.unwrap());
        let svg = fs::read_to_string(&picture).unwrap();
        (printed, fs::read_to_string(&csv).unwrap(), svg)
    });
    assert!(one == two, "the number of threads changes a byte");
    let (printed, csv, svg) = one;

    let runs = [learners::sutton, learners::ours].map(|learner| {
        [0, 1, 2, 3].map(|run| learner(SeedSequence::new(7).child(run), 12).unwrap())
    });
    let mut rows = csv.lines();
    assert_eq!(
        rows.next().unwrap(),
        "episode,sutton_lower_quartile,sutton_median,sutton_upper_quartile,\
        ours_lower_quartile,ours_median,ours_upper_quartile"
    );
    let mut medians = Vec::new();
    for episode in 0..12 {
        let mut row = vec![(episode + 1).to_string()];
        for runs in &runs {
            let mut steps = [0, 1, 2, 3].map(|run| f64::from(runs[run][episode]));
            steps.sort_by(f64::total_cmp);
            let [a, b, c, d] = steps;
            row.extend(
                [(a + 3.0 * b) / 4.0, (b + c) / 2.0, (3.0 * c + d) / 4.0].map(|x| x.to_string()),
            );
            medians.push((b + c) / 2.0);
        }
        assert_eq!(rows.next().unwrap(), row.join(","));
    }
    assert_eq!(rows.next(), None);
    assert!(
        medians[22] < medians[0] / 2.0 && medians[23] < medians[1] / 2.0,
        "both learn: {medians:?}"
    );

    let mut lines = printed.lines();
    let mut words =
        |line: usize| -> Vec<&str> { lines.nth(line).unwrap().split_whitespace().collect() };
    for (learner, skipped) in [(0, 1), (1, 0)] {
        let expected = [0, 4, 9].map(|episode| format!("{:.1}", medians[2 * episode + learner]));
        let row = words(skipped);
        assert_eq!(row[2..5], expected, "{printed}");
        assert_eq!(row[5..], ["–"; 4], "{printed}");
    }
    assert_eq!(
        words(0)[3..],
        ["602.0", "338.0", "219.0", "116.0", "85.5", "82.5", "81.5"]
    );
    for (learner, skipped) in [(0, 2), (1, 0)] {
        let means = runs[learner]
            .each_ref()
            .map(|run| f64::from(run[..10].iter().sum::<u32>()) / 10.0);
        let mean = means.iter().sum::<f64>() / 4.0;
        let variance = means.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 4.0;
        let row = words(skipped);
        assert_eq!(
            row[2..5],
            [
                format!("{mean:.1}"),
                "±".into(),
                format!("{:.1}", variance.sqrt())
            ],
            "{printed}"
        );
        assert_eq!(row[5..], ["–"; 4], "{printed}");
    }

    // A line and a band for each learner.
    assert_eq!(svg.matches("<polygon").count(), 2);
    for text in [
        "quartiles of 4 runs",
        "Sutton's learner",
        "this crate's",
        "steps to the goal",
    ] {
        assert!(
            svg.contains(&text.replace('\'', "&apos;")) || svg.contains(text),
            "{text}"
        );
    }
}

#[test]
fn the_experiment_rejects_before_it_writes() {
    let folder = Folder::new("rejected-sutton1996");
    let (csv, picture) = (folder.file("curve.csv"), folder.file("curve.svg"));
    let missing = folder.file("none/curve.csv");
    for (option, value, reason) in [
        ("--runs", "0", "0 is not in 1..=10000"),
        ("--runs", "-1", "invalid value '-1' for '--runs"),
        ("--episodes", "1", "1 is not in 2..=10000"),
        ("--episodes", "many", "invalid digit"),
        ("--seed", "1e3", "got 'e' as character 2"),
        (
            "--csv",
            &missing,
            "must be a name that ends in .csv, in an existing folder",
        ),
        ("--csv", &picture, "must be a name that ends in .csv"),
        ("--picture", &csv, "must be a name that ends in .svg"),
    ] {
        let mut arguments = vec![option, value];
        for (other, valid) in [("--runs", "1"), ("--csv", &csv), ("--picture", &picture)] {
            if other != option {
                arguments.extend([other, valid]);
            }
        }
        let errors = rejected("sutton1996", &arguments, "");
        assert!(errors.contains(reason), "{errors}");
        assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0, "{arguments:?}");
    }
}
