//! Examples write a whole file or nothing, and read at most the longest valid input.

use std::ffi::OsStr;
use std::fs::{self, File, Permissions};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::process::{Command, Stdio};
use std::thread::{sleep, spawn};
use std::time::{Duration, Instant};

use super::{Folder, printed, rejected};
use examples_common::files::write;

/// `command` in a shell with these limits.
fn limited(limits: &str, command: &Command) -> Command {
    let mut shell = Command::new("sh");
    shell.arg("-c").arg(format!(r#"{limits}; exec "$0" "$@""#));
    shell.arg(command.get_program()).args(command.get_args());
    shell.current_dir(command.get_current_dir().unwrap());
    shell
}

/// A signal or a crash can end an example at any time. A file with its final name is then complete.
#[test]
fn a_killed_example_leaves_no_truncated_file() {
    let folder = Folder::new();
    let mut swing_up = folder.command("swing_up --episodes 100");
    let mut child = swing_up.stdout(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    while !folder.path("swing_up.gif").exists() && start.elapsed() < Duration::from_secs(100) {
        sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(folder.gif_frames("swing_up.gif") > 50);
}

/// A failed write leaves no file, and an older file keeps its bytes.
#[test]
fn a_failed_write_changes_nothing() {
    let folder = Folder::new();
    // At most 512 bytes per file.
    let limits = "trap '' XFSZ; ulimit -f 1";
    let mut portrait = limited(limits, &folder.command("phase_portrait --out a.svg"));
    let mut reject = || {
        let errors = rejected(&mut portrait);
        let reason = "cannot write a.svg: File too large";
        assert!(errors.contains(reason), "{errors}");
    };
    reject();
    assert!(folder.names().is_empty());
    fs::write(folder.path("a.svg"), "old").unwrap();
    reject();
    assert_eq!(folder.names(), ["a.svg"]);
    assert_eq!(folder.read("a.svg"), b"old");
}

/// A failed write of any file is an error, even if the bytes fit into a buffer.
#[test]
fn a_full_disk_is_an_error() {
    for (line, file) in [
        ("balance", "balance.svg"),
        ("render_episode --state 1,2", "frame.png"),
        ("render_episode", "episode.gif"),
        ("render_episode", "episode.svg"),
        ("phase_portrait", "portrait.svg"),
        ("sutton1996 --runs 1 --episodes 2", "sutton1996.csv"),
        ("sutton1996 --runs 1 --episodes 2", "sutton1996.svg"),
        ("sweep --episodes 1 --masses 1 --torques 1", "sweep.csv"),
        ("sweep --episodes 1 --masses 1 --torques 1", "sweep.svg"),
        ("swing_up --episodes 100 --save weights", "weights"),
        ("swing_up --episodes 100", "learning_curve.svg"),
        ("swing_up --episodes 100", "values.svg"),
        ("swing_up --episodes 100", "swing_up.gif"),
    ] {
        let folder = Folder::new();
        symlink("/dev/full", folder.path(file)).unwrap();
        let output = folder.command(line).output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{file}: {errors}");
        assert!(errors.starts_with("error: cannot write "), "{errors}");
        let reason = format!("{file}: No space left");
        assert!(errors.contains(&reason), "{errors}");
        let text = String::from_utf8(output.stdout).unwrap();
        // The results of learning are printed even if a picture cannot be written.
        let is_printed = line == "swing_up --episodes 100";
        assert_eq!(text.contains("\nlearnt "), is_printed, "{file}: {text}");
        assert_eq!(text.is_empty(), !is_printed, "{file}: {text}");
    }
}

/// Only a regular file is replaced. Links, pipes and permissions stay.
#[test]
fn a_link_a_pipe_and_permissions_are_kept() {
    let folder = Folder::new();
    let [link, file, pipe] = ["link", "file", "pipe"].map(|name| folder.path(name));
    symlink("file", &link).unwrap();
    for bytes in ["a new file", "an old one"] {
        write(&link, bytes).unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), bytes);
    }

    fs::set_permissions(&file, Permissions::from_mode(0o640)).unwrap();
    write(&file, "protected").unwrap();
    let mode = fs::metadata(&file).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o640);

    let mkfifo = Command::new("mkfifo").arg(&pipe).status();
    assert!(mkfifo.unwrap().success());
    let reader = {
        let pipe = pipe.clone();
        spawn(move || fs::read(pipe).unwrap())
    };
    write(&pipe, "piped").unwrap();
    assert_eq!(reader.join().unwrap(), b"piped");
    assert_eq!(folder.names(), ["file", "link", "pipe"]);
}

#[test]
fn a_path_may_be_a_folder_too_long_or_not_unicode() {
    let folder = Folder::new();
    for (path, reason) in [
        (folder.path("."), "Is a directory"),
        (folder.path(&"n".repeat(300)), "File name too long"),
    ] {
        let error = write(&path, "").unwrap_err();
        let expected = format!("cannot write {}: {reason}", path.display());
        assert!(error.starts_with(&expected), "{error}");
    }
    for (line, name) in [
        ("phase_portrait --out", &b"\xff.svg"[..]),
        ("render_episode --out", b"\xff.gif"),
        ("swing_up --quiet --episodes 3 --save", b"\xff"),
    ] {
        let name = OsStr::from_bytes(name);
        printed(folder.command(line).arg(name));
        assert!(folder.0.join(name).is_file());
    }
}

/// The examples have one gigabyte of memory.
#[test]
fn endless_input_is_rejected() {
    let folder = Folder::new();
    let weights = "/dev/zero: weights must have at most 131072 bytes, got more";
    for (line, reason) in [
        ("swing_up --load /dev/zero", weights),
        ("plan --load /dev/zero", weights),
        (
            "trace --seed 1",
            "the input must have at most 67108864 bytes, got more",
        ),
    ] {
        let mut command = limited("ulimit -v 1000000", &folder.command(line));
        let errors = rejected(command.stdin(File::open("/dev/zero").unwrap()));
        assert!(errors.contains(reason), "{errors}");
    }
}
