//! Sutton's experiment: its results and its errors. The example itself tests its simulator.

use std::fs;

use super::{Folder, command, printed, rejected, svg};

#[test]
fn the_experiment_reports_its_runs() {
    let folder = Folder::new("sutton1996");
    let (csv, picture) = (folder.file("curve.csv"), folder.file("curve.svg"));
    let run = |threads: &str, seed: &str| {
        let mut arguments = vec!["--runs", "4", "--episodes", "12", "--seed", seed];
        arguments.extend(["--csv", &csv, "--picture", &picture]);
        let mut experiment = command("sutton1996", &arguments);
        let output = experiment.env("RAYON_NUM_THREADS", threads).output();
        let csv = fs::read_to_string(&csv).unwrap();
        (printed(output.unwrap()), csv, svg(&picture))
    };
    let one = run("1", "7");
    assert!(one == run("2", "7"), "the number of threads changes a byte");
    let other = run("1", "8");
    assert!(
        one.1 != other.1 && one.2 != other.2,
        "the seed must change the results"
    );

    let (printed, csv, _) = one;
    let numbers = |row: &str| -> Vec<f64> { row.split(',').map(|x| x.parse().unwrap()).collect() };
    let rows: Vec<_> = csv.lines().skip(1).map(numbers).collect();
    assert_eq!(rows.len(), 12);
    for learner in [1, 4] {
        let median = |row: usize| rows[row][learner + 1];
        assert!(median(11) < median(0) / 2.0, "learns: {csv}");
        for row in &rows {
            assert!(row[learner..learner + 3].is_sorted(), "quartiles: {csv}");
        }
        let first = format!("{:.1}", median(0));
        assert!(printed.contains(&first), "{first} in {printed}");
    }
    for name in ["Sutton's learner", "this crate's"] {
        assert!(printed.contains(name), "{printed}");
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
