//! The results of Sutton's experiment. The example itself tests its simulator.

use super::{Folder, printed};

#[test]
fn the_experiment_reports_its_runs() {
    let folder = Folder::new();
    let run = |threads: &str, seed: u32| {
        let line = format!("sutton1996 --runs 4 --episodes 12 --seed {seed}");
        let text = printed(folder.command(&line).env("RAYON_NUM_THREADS", threads));
        let csv = String::from_utf8(folder.read("sutton1996.csv")).unwrap();
        (text, csv, folder.svg("sutton1996.svg"))
    };
    let one = run("1", 7);
    assert!(one == run("2", 7), "the number of threads changes a byte");
    let other = run("1", 8);
    assert!(
        one.1 != other.1 && one.2 != other.2,
        "the seed must change the results"
    );

    let (text, csv, _) = one;
    let numbers = |row: &str| -> Vec<f64> { row.split(',').map(|x| x.parse().unwrap()).collect() };
    let rows: Vec<_> = csv.lines().skip(1).map(numbers).collect();
    assert_eq!(rows.len(), 12);
    for (name, learner) in [("Sutton's learner", 1), ("this crate's learner", 4)] {
        let median = |row: usize| rows[row][learner + 1];
        assert!(median(11) < median(0) / 2.0, "learns: {csv}");
        for row in &rows {
            assert!(row[learner..learner + 3].is_sorted(), "quartiles: {csv}");
        }
        let first = format!("{name:<24}{:>7.1}", median(0));
        assert!(text.contains(&first), "{first} in {text}");
    }
}
