//! `plan` is better than the learnt policy.

use std::fs;

use super::{Folder, printed, run};

#[test]
fn planning_beats_the_learnt_policy_within_fixed_memory() {
    let short = ["--learn", "300", "--episodes", "20", "--depth", "30"];
    let text = printed(run("plan", &short, ""));
    assert_eq!(text, printed(run("plan", &short, "")));
    let mean = |name: &str| -> f64 {
        let (_, rest) = text.split_once(name).unwrap();
        rest.split_whitespace().next().unwrap().parse().unwrap()
    };
    // The values of 300 episodes are coarse.
    assert!(mean("30 steps ahead") > -72.0, "{text}");
    assert!(mean("30 steps ahead") > mean("greedy") + 5.0, "{text}");
    let (_, search) = text.split_once("the search takes ").unwrap();
    let bytes: usize = search.split_once(" bytes").unwrap().0.parse().unwrap();
    assert!(bytes <= 4096, "{text}");
}

#[test]
fn planning_rejects_bad_input() {
    let folder = Folder::new("rejected-plan");
    let weights = folder.file("weights.bin");
    fs::write(&weights, b"TILE").unwrap();
    for (option, value, reason) in [
        ("--depth", "0", "0 is not in 1..=128"),
        ("--depth", "129", "129 is not in 1..=128"),
        ("--episodes", "0", "0 is not in 1.."),
        ("--load", &weights, "weights must have 65556 bytes, got 4"),
        ("--load", &folder.file("none.bin"), "none.bin: "),
    ] {
        let output = run("plan", &[option, value], "");
        assert_eq!(output.status.code(), Some(2), "{option} {value}");
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains(reason), "{message}");
    }
}
