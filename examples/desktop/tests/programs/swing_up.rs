//! `swing_up` learns, and saves and loads its weights.

use super::Folder;

/// The figures of the line that `--quiet` prints: the episode that solved the task, the greedy
/// policy's mean and standard deviation, and its misses. Checks the form of the line.
fn figures(line: &str) -> (Option<u32>, f64, f64, u32) {
    let words: Vec<&str> = line.split_whitespace().collect();
    let number = |i: usize| words[i].parse::<f64>().unwrap();
    let solved_at = words[1].parse().ok();
    let (mean, sd, misses) = (number(3), number(5), number(7));
    let solved = solved_at.map_or("never".into(), |n: u32| n.to_string());
    assert_eq!(
        line,
        format!("solved_at {solved} greedy_mean {mean:.2} greedy_sd {sd:.2} misses {misses:.0}\n")
    );
    (solved_at, mean, sd, misses as u32)
}

impl Folder {
    fn swing_up(&self, arguments: &str) -> String {
        self.printed(&format!("swing_up {arguments}"))
    }
}

#[test]
fn swing_up_learns_the_same_from_the_same_seed() {
    let folder = Folder::new("learns");
    let [one, two] = ["one", "two"].map(|name| {
        let line = folder.swing_up(&format!("--quiet --episodes 300 --seed 1 --save {name}"));
        (line, folder.read(name))
    });
    assert!(one == two, "{} {}", one.0, two.0);
    assert_eq!(one.1.len(), 6144 * 8 + 20);

    let (solved_at, mean, sd, misses) = figures(&one.0);
    assert!(solved_at.is_some_and(|n| (100..=150).contains(&n)) && misses == 0);
    assert!(mean > -100.0 && sd > 0.0, "{}", one.0);
    folder.swing_up("--quiet --episodes 300 --seed 2 --save other");
    assert!(folder.read("other") != one.1, "the seed must change the weights");

    // Loaded weights give the same figures, and are saved unchanged.
    let line = folder.swing_up("--quiet --episodes 0 --seed 1 --load one --save again");
    assert_eq!(figures(&line), (None, mean, sd, misses));
    assert!(folder.read("again") == one.1);
}

/// Untrained, all values tie, so the learner takes the first action, and mirroring turns that into
/// torque against θ̇1. Learning must improve on this baseline by more than chance.
#[test]
fn swing_up_is_better_than_torque_against_the_velocity() {
    let folder = Folder::new("baseline");
    let output = folder.swing_up("--seed 42");
    let row = |policy: &str| -> [f64; 3] {
        let row = output.lines().find_map(|line| line.strip_prefix(policy));
        let row = row.unwrap_or_else(|| panic!("{output}")).replace('±', "");
        let numbers = row.split_whitespace().map(|word| word.parse().unwrap());
        numbers.collect::<Vec<f64>>().try_into().unwrap()
    };
    let [learnt, against, random] = ["learnt", "torque against θ̇1", "random"].map(row);
    // Three standard errors of the difference, with 1,000 episodes each.
    let chance = 3.0 * ((learnt[1] * learnt[1] + against[1] * against[1]) / 1000.0).sqrt();
    assert!(learnt[0] - against[0] > chance, "{output}");
    assert_eq!([learnt[2], against[2]], [0.0, 0.0], "{output}");
    assert!(random[0] < -490.0 && random[2] > 900.0, "{output}");

    let steps = output.split("a greedy episode, ").nth(1).unwrap();
    let steps: usize = steps.split(' ').next().unwrap().parse().unwrap();
    assert!((50..200).contains(&steps), "{output}");

    let untrained = figures(&folder.swing_up("--quiet --episodes 0"));
    assert_eq!(untrained, (None, against[0], against[1], 0));
}

#[test]
fn swing_up_draws_its_results() {
    let folder = Folder::new("draws");
    let [one, other] = [1, 2].map(|seed| {
        folder.swing_up(&format!("--episodes 100 --seed {seed}"));
        ["learning_curve.svg", "values.svg", "swing_up.svg"].map(|name| folder.svg(name))
    });
    assert!(one[0] != other[0], "the seed must change the returns");
    assert!(one[1] != other[1], "the seed must change the values");
    assert!(one[2] != other[2], "the seed must change the episode");
}

/// Each of the evaluations comes after the first episode that ends beyond another 2,000 steps.
#[test]
fn swing_up_evaluates_during_a_budget_of_steps() {
    let folder = Folder::new("evaluates");
    let output = folder.swing_up("--quiet --steps 7000 --evaluate 2000 --seed 1");
    let lines: Vec<&str> = output.lines().collect();
    assert_eq!(lines.len(), 4, "{output}");
    for (line, least) in lines.iter().zip([2000, 4000, 6000]) {
        let [_, steps, _, mean] = line.split(' ').collect::<Vec<_>>().try_into().unwrap();
        let (steps, mean): (u32, f64) = (steps.parse().unwrap(), mean.parse().unwrap());
        assert!((least..least + 500).contains(&steps), "{output}");
        assert!((-500.0..-50.0).contains(&mean), "{output}");
    }
    // Evaluations change nothing.
    let alone = folder.swing_up("--quiet --steps 7000 --seed 1");
    assert_eq!(lines[3], alone.trim_end());
}

/// Each memory has its slots. The learner's own tests damage every byte.
#[test]
fn swing_up_rejects_weights_of_another_learner() {
    let folder = Folder::new("weights");
    folder.swing_up("--quiet --episodes 3 --save weights");
    for (memory, bytes) in [("16k", 11284), ("32k", 23572)] {
        let line = format!("swing_up --load weights --save out --memory {memory}");
        folder.assert_rejects(&line, &format!("weights must have {bytes} bytes, got 49172"));
        assert!(!folder.path("out").exists());
    }
}
