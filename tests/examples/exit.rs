//! How the examples end when they cannot print.

use std::fs::{self, File};
use std::process::Stdio;

use super::{Folder, command};

/// Each example with little work, and the files that it writes.
const EXAMPLES: [(&str, &str, &[&str]); 11] = [
    ("energy_control", "--episodes 1", &[]),
    ("phase_portrait", "--out FOLDER/a.svg", &["a.svg"]),
    ("plan", "--learn 10 --episodes 1 --depth 2", &[]),
    ("random_agent", "", &[]),
    ("random_agent", "--help", &[]),
    ("render_episode", "--out FOLDER/a.gif", &["a.gif", "a.png"]),
    (
        "sutton1996",
        "--runs 1 --episodes 20 --csv FOLDER/a.csv --picture FOLDER/a.svg",
        &["a.csv", "a.svg"],
    ),
    (
        "sweep",
        "--episodes 400 --csv FOLDER/a.csv --picture FOLDER/a.svg",
        &["a.csv", "a.svg"],
    ),
    (
        "swing_up",
        "--episodes 10 --save FOLDER/a.bin --pictures FOLDER",
        &["a.bin", "learning_curve.svg", "values.svg", "swing_up.gif"],
    ),
    ("throughput", "", &[]),
    ("trace", "--seed 42", &[]),
];

/// Runs each example with `stdout` as its output, and checks its files. Returns names, statuses and error messages.
fn end(name: &str, stdout: impl Fn() -> Stdio) -> Vec<(&'static str, Option<i32>, String)> {
    let ends = EXAMPLES.map(|(example, arguments, files)| {
        let folder = Folder::new(&format!("{name}-{example}"));
        let arguments = arguments.replace("FOLDER", folder.0.to_str().unwrap());
        let arguments: Vec<&str> = arguments.split_whitespace().collect();
        let output = command(example, &arguments)
            .stdin(Stdio::null())
            .stdout(stdout())
            .output()
            .unwrap();
        for file in files {
            assert!(fs::metadata(folder.file(file)).is_ok(), "{example}: {file}");
        }
        let errors = String::from_utf8(output.stderr).unwrap();
        (example, output.status.code(), errors)
    });
    ends.into()
}

#[test]
fn the_reader_may_close_the_pipe() {
    let closed = || {
        let (_, writer) = std::io::pipe().unwrap();
        writer.into()
    };
    for (example, status, errors) in end("closed", closed) {
        assert_eq!(status, Some(0), "{example}: {errors}");
        assert!(!errors.contains("error"), "{example}: {errors}");
    }
}

#[cfg(target_os = "linux")]
fn full() -> Stdio {
    let full = File::options().write(true).open("/dev/full");
    full.unwrap().into()
}

#[test]
#[cfg(target_os = "linux")]
fn an_error_that_cannot_be_printed_keeps_its_status() {
    for arguments in ["--state 1,2 --out no.gif", "--state 1", "--out no/such.gif"] {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let status = command("render_episode", &arguments)
            .stderr(full())
            .status();
        assert_eq!(status.unwrap().code(), Some(2), "{arguments:?}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_failed_print_is_an_error() {
    for (example, status, errors) in end("unprinted", full) {
        assert_eq!(status, Some(2), "{example}: {errors}");
        assert!(
            errors.contains("error: cannot print: "),
            "{example}: {errors}"
        );
    }
}
