//! `random_agent` and `energy_control`.

use super::{printed, rejected, run};
use common::is_recorded_library;

#[test]
fn the_random_agent_takes_gymnasiums_episodes() {
    if !is_recorded_library() {
        return;
    }
    let rows = include_str!("../data/seeds.txt")
        .lines()
        .filter_map(|line| line.strip_prefix("agent "));
    let mut goals = 0;
    for row in rows.step_by(4) {
        let row: Vec<&str> = row.split(' ').collect();
        let output = printed(run(
            "random_agent",
            &["--seed", row[0], "--steps", "3000"],
            "",
        ));
        let mut lines = output.lines();
        let mut sum = 0;
        for (episode, number) in row[1..].chunks(2).zip(1..) {
            let length: i32 = episode[0].parse().unwrap();
            let (goal, end) = if episode[1] == "1" {
                (1, "terminated")
            } else {
                (0, "truncated")
            };
            goals += goal;
            sum += goal - length;
            let expected = format!(
                "episode {number}: {length} steps, return {}, {end}",
                goal - length
            );
            assert_eq!(lines.next(), Some(&*expected), "seed {}", row[0]);
        }
        let summary = lines.next().unwrap();
        let mean = f64::from(sum) / (row.len() / 2) as f64;
        assert!(
            summary.starts_with("3000 steps, ")
                && summary.contains(&format!("mean return {mean:.1}")),
            "{summary}"
        );
    }
    assert!(goals > 0, "one of the episodes should reach the goal");
}

#[test]
fn the_random_agent_helps_and_rejects() {
    let help = printed(run("random_agent", &["--help"], ""));
    assert!(
        help.contains("--seed") && help.contains("--steps"),
        "{help}"
    );
    assert!(printed(run("random_agent", &["--steps", "0"], "")).starts_with("0 steps, 0 episodes"));
    let errors = rejected("random_agent", &["--seed", "4x2"], "");
    assert!(errors.contains("got 'x' as character 2"), "{errors}");
    rejected("random_agent", &["--steps", "-1"], "");
}

#[test]
fn the_energy_controller_catches_the_upright() {
    let output = printed(run("energy_control", &["--episodes", "20"], ""));
    let row = |policy: &str, limit: &str| {
        let row = output
            .lines()
            .find(|line| line.starts_with(policy) && line.contains(limit));
        row.unwrap_or_else(|| panic!("{output}")).to_owned()
    };
    assert!(
        row("energy", "10 N m").matches("20 of 20 at").count() == 2,
        "{output}"
    );
    assert!(
        row("bang-bang", "1 N m").contains("20 of 20 at"),
        "{output}"
    );
    assert!(row("random", "1 N m").ends_with("0 of 20"), "{output}");
}
