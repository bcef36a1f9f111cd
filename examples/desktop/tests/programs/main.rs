//! The programs do what their documentation says.

mod rig;
mod swing_up;

use std::env::consts::EXE_EXTENSION;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An empty folder in which the programs of a test run.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir(&folder).unwrap();
        Self(folder)
    }

    /// Runs `rig`, whose arguments may have spaces.
    fn rig(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rig"));
        command.args(arguments).current_dir(&self.0).output().unwrap()
    }

    /// Runs a program with arguments, separated by spaces.
    fn run(&self, line: &str) -> Output {
        let mut words = line.split(' ');
        // All programs are in one folder.
        let program = Path::new(env!("CARGO_BIN_EXE_swing_up"))
            .with_file_name(words.next().unwrap())
            .with_extension(EXE_EXTENSION);
        let mut command = Command::new(program);
        command.args(words).current_dir(&self.0).output().unwrap()
    }

    fn printed(&self, line: &str) -> String {
        let output = self.run(line);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{line}: {errors}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs a program that must fail with this reason, and print nothing else.
    #[track_caller]
    fn assert_rejects(&self, line: &str, reason: &str) {
        let output = self.run(line);
        assert!(!output.status.success() && output.stdout.is_empty());
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(errors.contains(reason), "{line}: {errors}");
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.0.join(name)).unwrap()
    }
}

/// The picture of the README.
#[test]
fn the_picture_is_that_of_the_page() {
    let folder = Folder::new("picture");
    folder.printed("episode");
    let drawn = String::from_utf8(folder.read("episode.svg")).unwrap();
    assert!(drawn == common::text_of("docs/episode.svg"), "docs/episode.svg differs");
}

/// The firmware `follow` has this plan, from Python.
#[test]
fn a_plan_is_written_as_rust_and_c() {
    let folder = Folder::new("plan");
    folder.printed("plan");
    let written = String::from_utf8(folder.read("plan.rs")).unwrap();
    let (_, constant) = written.split_once('\n').unwrap();
    assert!(common::text_of("examples/cortex-m/src/plan.rs").contains(constant), "plan.rs differs");
    folder.printed("plan --out plan.h");
    let c = String::from_utf8(folder.read("plan.h")).unwrap();
    let numbers = |code: &str| -> Vec<f32> {
        let words = code.split(|c: char| !(c.is_ascii_digit() || "+-.e".contains(c)));
        words.filter(|word| word.contains('.')).filter_map(|word| word.parse().ok()).collect()
    };
    assert_eq!(numbers(&c), numbers(&written));
}

/// Each model's row says that the acrobot is upright at the end of each part.
#[test]
fn a_real_acrobot_is_held() {
    let table = Folder::new("real").printed("real --count 1");
    let rows: Vec<&str> = table.lines().skip(2).collect();
    assert_eq!(rows.len(), 3, "docs/real.md has three models, the program printed:\n{table}");
    assert!(rows.iter().all(|row| row.matches("| 1, in").count() == 3), "{table}");
}

#[test]
fn bad_arguments_are_rejected_with_a_reason() {
    let folder = Folder::new("rejected");
    for (line, reason) in [
        ("swing_up --load none.bin", "Error: none.bin"),
        ("trace --seed 4x2 1", "got 'x' as character 2"),
        ("episode --out no/a.svg", "Error: cannot write no/a.svg"),
        ("stay_up --episodes 0", "0 is not in 1.."),
        ("realaigym --tries 0", "0 is not in 1.."),
        ("real --count 0", "0 is not in 1.."),
        ("trace 013", "an action must be 0, 1 or 2"),
        ("swing_up --load /dev/zero", "weights must"),
        ("swing_up --steps 1 --episodes 1", "cannot be used with"),
    ] {
        folder.assert_rejects(line, reason);
    }
}
