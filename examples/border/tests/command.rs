//! The program trains, repeats itself for the same seed, and rejects invalid arguments.

use std::process::{Command, Output};

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_acrobot-border"))
        .args(arguments)
        .output()
        .unwrap()
}

/// The numbers at the ends of the lines: random, untrained and trained.
fn scores(output: &Output) -> Vec<f32> {
    let text = String::from_utf8_lossy(&output.stdout);
    let lines = text.lines().skip(1);
    lines
        .map(|line| line.rsplit(' ').next().unwrap().parse().unwrap())
        .collect()
}

#[test]
fn learns_and_repeats_itself() {
    let arguments = ["--seed", "7", "--steps", "5000"];
    let output = run(&arguments);
    assert!(output.status.success());
    let [random, _, trained] = scores(&output)[..] else {
        panic!("{output:?}");
    };
    assert!(trained > random + 200.0, "{random} {trained}");
    assert_eq!(run(&arguments), output);
}

#[test]
fn has_the_readmes_returns() {
    let readme = include_str!("../README.md").replace('−', "-");
    for score in scores(&run(&["--seed", "42", "--steps", "100000"])) {
        assert!(readme.contains(&format!("{score:.1} ")), "{score}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn errors_that_cannot_be_printed_keep_their_status() {
    let full = || std::fs::File::options().write(true).open("/dev/full");
    let mut border = Command::new(env!("CARGO_BIN_EXE_acrobot-border"));
    border.stdout(full().unwrap()).stderr(full().unwrap());
    assert_eq!(border.status().unwrap().code(), Some(1));
}

/// Sums of the largest numbers do not overflow.
#[test]
fn takes_the_largest_seed() {
    let output = run(&["--seed", "9223372036854775807", "--steps", "1"]);
    assert!(output.status.success(), "{output:?}");
}

#[test]
fn rejects_with_status_2() {
    for arguments in [
        ["--steps", "0"],
        ["--steps", "many"],
        ["--seed", "-1"],
        ["--episodes", "3"],
    ] {
        let output = run(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty());
        assert!(String::from_utf8_lossy(&output.stderr).starts_with("error: "));
    }
}
