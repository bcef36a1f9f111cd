//! `random_agent` and `energy_control`.

use super::{Folder, printed};
use common::is_recorded_library;

#[test]
fn the_random_agent_takes_gymnasiums_episodes() {
    if !is_recorded_library() {
        return;
    }
    let folder = Folder::new();
    let rows = include_str!("../data/seeds.txt")
        .lines()
        .filter_map(|line| line.strip_prefix("agent "));
    let mut goals = 0;
    for row in rows.step_by(4) {
        let (seed, episodes) = row.split_once(' ').unwrap();
        let episodes: Vec<i32> = episodes.split(' ').map(|x| x.parse().unwrap()).collect();
        let (mut expected, mut sum) = (String::new(), 0);
        for (episode, number) in episodes.chunks(2).zip(1..) {
            let &[length, goal] = episode else {
                panic!("{row}")
            };
            let (gained, end) = (goal - length, ["truncated", "terminated"][goal as usize]);
            expected += &format!("episode {number}: {length} steps, return {gained}, {end}\n");
            goals += goal;
            sum += gained;
        }
        expected += "3000 steps, ";
        let mean = 2.0 * f64::from(sum) / episodes.len() as f64;
        let output =
            printed(&mut folder.command(&format!("random_agent --seed {seed} --steps 3000")));
        assert!(output.starts_with(&expected), "seed {seed}: {output}");
        assert!(
            output.contains(&format!("mean return {mean:.1}")),
            "{output}"
        );
    }
    assert!(goals > 0, "one of the episodes should reach the goal");
    let none = printed(&mut folder.command("random_agent --steps 0"));
    assert!(none.starts_with("0 steps, 0 episodes"), "{none}");
}

#[test]
fn the_energy_controller_catches_the_upright() {
    let output = printed(&mut Folder::new().command("energy_control --episodes 20"));
    let row = |policy: &str, limit: &str| {
        let mut lines = output.lines();
        let row = lines.find(|line| line.starts_with(policy) && line.contains(limit));
        row.unwrap_or_else(|| panic!("{output}"))
    };
    assert_eq!(row("energy", "10 N m").matches("20 of 20 in").count(), 2);
    assert!(row("bang-bang", "1 N m").contains("20 of 20 in"));
    assert!(row("random", "1 N m").ends_with("0 of 20"));
}
