//! `swing_up` learns, and saves and loads its weights.

use super::Folder;

impl Folder {
    /// The figures of the line that `--quiet` prints: the episode that solved the task, if any, the
    /// greedy policy's mean and standard deviation, and its misses.
    fn figures(&self, arguments: &str) -> [Option<f64>; 4] {
        let line = self.printed(&format!("swing_up --quiet {arguments}"));
        let words: Vec<&str> = line.split_whitespace().collect();
        assert_eq!(
            [0, 2, 4, 6].map(|i| words[i]),
            ["solved_at", "greedy_mean", "greedy_std", "misses"]
        );
        [1, 3, 5, 7].map(|i| words[i].parse().ok())
    }
}

#[test]
fn swing_up_learns_and_loads_what_it_saved() {
    let folder = Folder::new("learns");
    let figures = folder.figures("--episodes 300 --seed 1 --save one");
    let [solved_at, mean, std, misses] = figures.map(Option::unwrap);
    assert!((100.0..=150.0).contains(&solved_at) && misses == 0.0, "{figures:?}");
    assert!(mean > -100.0 && std > 0.0, "{figures:?}");
    let weights = folder.read("one");
    folder.figures("--episodes 300 --seed 2 --save other");
    assert!(folder.read("other") != weights, "the seed must change the weights");

    // Loaded weights give the same figures, and are saved unchanged.
    let loaded = folder.figures("--episodes 0 --seed 1 --load one --save again");
    assert_eq!(loaded, [None, Some(mean), Some(std), Some(misses)]);
    assert!(folder.read("again") == weights);
}

#[test]
fn swing_up_is_better_than_torque_against_the_velocity() {
    let folder = Folder::new("baseline");
    let output = folder.printed("swing_up --seed 42");
    let row = |policy: &str| -> [f64; 3] {
        let row = output.lines().find_map(|line| line.strip_prefix(policy));
        let row = row.unwrap_or_else(|| panic!("{output}")).replace('±', "");
        let numbers = row.split_whitespace().map(|word| word.parse().unwrap());
        numbers.collect::<Vec<f64>>().try_into().unwrap()
    };
    let [learnt, against, random] = ["learnt", "torque against θ̇1", "random"].map(row);
    // Far more than three standard errors, 3, of the means of 1,000 episodes.
    assert!(learnt[0] - against[0] > 10.0, "{output}");
    assert_eq!([learnt[2], against[2]], [0.0, 0.0], "{output}");
    assert!(random[0] < -490.0 && random[2] > 900.0, "{output}");

    let (_, steps) = output.split_once("a greedy episode, ").unwrap();
    let steps: usize = steps.split(' ').next().unwrap().parse().unwrap();
    assert!((50..200).contains(&steps), "{output}");
    let drawn = String::from_utf8(folder.read("swing_up.svg")).unwrap();
    assert!(drawn.starts_with("<svg") && drawn.ends_with("</svg>\n"));

    let untrained = folder.figures("--episodes 0");
    assert_eq!(untrained, [None, Some(against[0]), Some(against[1]), Some(0.0)]);
}
