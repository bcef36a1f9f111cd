//! `swing_up` learns, and saves and loads its weights.

use std::fs;

use super::{Folder, command, gif_frames, printed, rejected, run, svg};

/// The figures of the line that `--quiet` prints: when it was solved, the greedy policy's mean and standard deviation,
/// and its misses. Checks the form of the line.
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

fn swing_up(arguments: &str, files: &[&str]) -> String {
    let arguments: Vec<&str> = arguments
        .split_whitespace()
        .chain(files.iter().copied())
        .collect();
    printed(run("swing_up", &arguments, ""))
}

#[test]
fn swing_up_learns_the_same_from_the_same_seed() {
    let folder = Folder::new("weights");
    let [one, two] = ["one", "two"].map(|name| {
        let path = folder.file(name);
        let line = swing_up("--quiet --episodes 300 --seed 1", &["--save", &path]);
        (line, fs::read(&path).unwrap())
    });
    assert!(one == two, "{} {}", one.0, two.0);
    assert_eq!(one.1.len(), 65_536 + 20);

    let (solved_at, mean, sd, misses) = figures(&one.0);
    assert!(solved_at.is_some_and(|n| (100..=115).contains(&n)) && misses == 0);
    assert!(mean > -100.0 && sd > 0.0, "{}", one.0);
    let other = folder.file("other");
    swing_up("--quiet --episodes 300 --seed 2", &["--save", &other]);
    assert!(
        fs::read(other).unwrap() != one.1,
        "the seed must change the weights"
    );

    // Loaded weights give the same figures, and are saved unchanged.
    let (one, again) = (folder.file("one"), folder.file("again"));
    let files = ["--load", &one, "--save", &again];
    let line = swing_up("--quiet --episodes 0 --seed 1", &files);
    assert_eq!(figures(&line), (None, mean, sd, misses));
    assert!(fs::read(one).unwrap() == fs::read(again).unwrap());
}

/// Untrained, all values tie, so the learner takes the first action, and mirroring turns that into torque against θ̇1.
/// Learning must improve on this baseline by more than chance.
#[test]
fn swing_up_is_better_than_torque_against_the_velocity() {
    let folder = Folder::new("swing-up");
    let pictures = ["--pictures", folder.0.to_str().unwrap()];
    let output = swing_up("--seed 42", &pictures);
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

    // The initial state and every step. An episode without the goal has 501 frames.
    let steps = output.split("last greedy episode, ").nth(1).unwrap();
    let steps: usize = steps.split(' ').next().unwrap().parse().unwrap();
    assert_eq!(gif_frames(&folder.file("swing_up.gif")), steps + 1);
    assert!((50..200).contains(&steps), "{output}");

    let untrained = figures(&swing_up("--quiet --episodes 0", &[]));
    assert_eq!(untrained, (None, against[0], against[1], 0));
}

#[test]
fn swing_up_draws_what_it_has_learnt() {
    let folder = Folder::new("drawn");
    let pictures = ["--pictures", folder.0.to_str().unwrap()];
    let [one, other] = [1, 2].map(|seed| {
        swing_up(&format!("--episodes 100 --seed {seed}"), &pictures);
        ["learning_curve.svg", "values.svg"].map(|name| svg(&folder.file(name)))
    });
    assert!(one[0] != other[0], "the seed must change the returns");
    assert!(one[1] != other[1], "the seed must change the values");
}

#[test]
fn swing_up_takes_every_preset_and_memory() {
    for (memory, bytes) in [("8k", 8192), ("16k", 16384), ("32k", 32768), ("64k", 65536)] {
        for preset in ["fast", "quality"] {
            let folder = Folder::new(&format!("{preset}-{memory}"));
            let path = folder.file("weights");
            let arguments = format!("--quiet --episodes 3 --preset {preset} --memory {memory}");
            assert_eq!(figures(&swing_up(&arguments, &["--save", &path])).0, None);
            assert_eq!(fs::read(path).unwrap().len(), bytes + 20);
        }
    }
}

#[test]
fn swing_up_rejects_weights_that_are_not_its_own() {
    let folder = Folder::new("rejected-weights");
    let weights = folder.file("weights");
    swing_up("--quiet --episodes 3", &["--save", &weights]);
    let bytes = fs::read(&weights).unwrap();
    let changed = |at: usize| {
        let mut bytes = bytes.clone();
        bytes[at] ^= 2;
        bytes
    };
    for (bytes, arguments, reason) in [
        (bytes[1..].to_vec(), "", "weights must begin with"),
        (vec![], "", "weights must begin with"),
        (changed(4), "", "weights must be of version 1, got 3"),
        (
            bytes[..65_555].to_vec(),
            "",
            "weights must have 65556 bytes, got 65555",
        ),
        (
            [&bytes[..], &[0]].concat(),
            "",
            "weights must have 65556 bytes, got 65557",
        ),
        (
            bytes.clone(),
            "--memory 16k",
            "weights must have 16404 bytes, got 65556",
        ),
        (changed(30_000), "", "damaged weights: "),
        (changed(65_555), "", "damaged weights: "),
        (bytes.clone(), "--preset quality", "weights must be of "),
    ] {
        fs::write(&weights, bytes).unwrap();
        let out = folder.file("out");
        let mut all: Vec<&str> = arguments.split_whitespace().collect();
        let pictures = folder.0.to_str().unwrap();
        all.extend(["--load", &weights, "--save", &out, "--pictures", pictures]);
        let errors = rejected("swing_up", &all, "");
        assert!(
            errors.contains(&weights) && errors.contains(reason),
            "{errors}"
        );
        assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 1, "{errors}");
    }
}

#[test]
fn swing_up_rejects_before_it_learns() {
    let folder = Folder::new("rejected-swing-up");
    for (arguments, reason) in [
        ("--preset slow", "possible values: fast, quality"),
        ("--memory 12k", "possible values: 8k, 16k, 32k, 64k"),
        ("--episodes -1", "-1 is not in 0..=4294967295"),
        (
            "--episodes 4294967296",
            "4294967296 is not in 0..=4294967295",
        ),
        ("--seed -1", "got '-' as character 1"),
        ("--load none/weights", "none/weights: "),
        (
            "--save none/weights",
            "must be a file in an existing folder",
        ),
        ("--pictures none", "must be an existing folder"),
    ] {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let mut swing_up = command("swing_up", &arguments);
        if arguments[0] != "--pictures" {
            swing_up.args(["--pictures", folder.0.to_str().unwrap()]);
        }
        let output = swing_up.output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{errors}");
        assert!(
            output.stdout.is_empty() && errors.contains(reason),
            "{errors}"
        );
        assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0, "{errors}");
    }
}
