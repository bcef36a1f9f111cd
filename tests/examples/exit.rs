//! How the examples end when they cannot print.

use std::fs::File;
use std::process::Stdio;

use super::Folder;

#[test]
fn the_reader_may_close_the_pipe() {
    for line in ["random_agent", "random_agent --help"] {
        let (_, closed) = std::io::pipe().unwrap();
        let output = Folder::new().command(line).stdout(closed).output().unwrap();
        assert!(
            output.status.success() && output.stderr.is_empty(),
            "{line}"
        );
    }
}

#[cfg(target_os = "linux")]
fn full() -> Stdio {
    let full = File::options().write(true).open("/dev/full");
    full.unwrap().into()
}

/// Examples write their files before they print, so a failed print leaves the files complete.
#[test]
#[cfg(target_os = "linux")]
fn a_failed_print_is_an_error() {
    for (line, files) in [
        ("balance", "balance.svg"),
        ("energy_control --episodes 1", ""),
        ("phase_portrait", "portrait.svg"),
        ("plan --learn 10 --episodes 1 --depth 2", ""),
        ("random_agent", ""),
        ("random_agent --help", ""),
        ("render_episode", "episode.gif episode.svg"),
        (
            "sutton1996 --runs 1 --episodes 2",
            "sutton1996.csv sutton1996.svg",
        ),
        (
            "sweep --episodes 1 --masses 1 --torques 1",
            "sweep.csv sweep.svg",
        ),
        (
            "swing_up --episodes 100 --save a",
            "a learning_curve.svg swing_up.gif values.svg",
        ),
        ("throughput", ""),
        ("trace --seed 42", ""),
    ] {
        let folder = Folder::new();
        let output = folder.command(line).stdout(full()).output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {errors}");
        assert!(errors.contains("error: cannot print: "), "{line}: {errors}");
        assert_eq!(folder.names().join(" "), files, "{line}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn an_error_that_cannot_be_printed_keeps_its_status() {
    for line in ["render_episode --state 1", "render_episode --out no.png"] {
        let status = Folder::new().command(line).stderr(full()).status();
        assert_eq!(status.unwrap().code(), Some(2), "{line}");
    }
}
