//! Examples write a file whole or not at all, and read no more than can be valid.

use std::fs::{self, File};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::{sleep, spawn};
use std::time::{Duration, Instant};

use super::{Folder, command, gif_frames, limited, printed, rejected, run};

/// A signal or a crash can end an example at any time. A file that has its final name is complete then.
#[test]
fn a_killed_example_leaves_no_truncated_file() {
    let folder = Folder::new("killed");
    let episode = folder.file("episode.gif");
    let pictures = folder.0.to_str().unwrap();
    for (example, arguments, name) in [
        (
            "render_episode",
            ["--out", &episode].as_slice(),
            "episode.gif",
        ),
        (
            "swing_up",
            &["--episodes", "10", "--pictures", pictures],
            "swing_up.gif",
        ),
    ] {
        let mut example = command(example, arguments);
        let mut child = example.stdout(Stdio::null()).spawn().unwrap();
        let path = folder.file(name);
        let start = Instant::now();
        while fs::metadata(&path).is_err() && start.elapsed() < Duration::from_secs(100) {
            sleep(Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(gif_frames(&path) > 50, "{name}");
    }
}

/// Nothing is left of a file that does not fit, and an older file keeps its bytes.
#[test]
fn a_failed_write_changes_nothing() {
    for (example, arguments, name) in [
        ("render_episode", "--out FOLDER/a.gif", "a.gif"),
        ("render_episode", "--state 1,2 --out FOLDER/a.png", "a.png"),
        ("phase_portrait", "--out FOLDER/a.svg", "a.svg"),
        (
            "sutton1996",
            "--runs 1 --episodes 9 --csv FOLDER/a.csv --picture FOLDER/a.svg",
            "a.svg",
        ),
        (
            "sweep",
            "--episodes 400 --csv FOLDER/null.csv --picture FOLDER/a.svg",
            "a.svg",
        ),
        ("swing_up", "--episodes 9 --save FOLDER/a.bin", "a.bin"),
    ] {
        let folder = Folder::new(&format!("too-large-{example}-{name}"));
        symlink("/dev/null", folder.file("null.csv")).unwrap();
        let arguments = arguments.replace("FOLDER", folder.0.to_str().unwrap());
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let (path, before) = (folder.file(name), names(&folder.0));
        // 512 bytes a file: the CSV of nine episodes fits, pictures and weights do not.
        let limits = "trap '' XFSZ; ulimit -f 1";
        for old in [None, Some("old")] {
            if let Some(old) = old {
                fs::write(&path, old).unwrap();
            }
            let output = limited(limits, example, &arguments).output().unwrap();
            let errors = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(2), "{example}: {errors}");
            let reason = format!("cannot write {path}: File too large");
            assert!(errors.contains(&reason), "{errors}");
            assert_eq!(fs::read_to_string(&path).ok().as_deref(), old, "{example}");
            let _ = fs::remove_file(&path);
            let _ = fs::remove_file(folder.file("a.csv"));
            assert_eq!(names(&folder.0), before, "{example}");
        }
    }
}

fn names(folder: &Path) -> Vec<std::ffi::OsString> {
    let files = fs::read_dir(folder).unwrap();
    files.map(|file| file.unwrap().file_name()).collect()
}

/// Only a regular file is replaced.
#[test]
fn a_link_a_pipe_and_permissions_are_kept() {
    let folder = Folder::new("special");
    let save = |path: &str| {
        run(
            "swing_up",
            &["--quiet", "--episodes", "3", "--save", path],
            "",
        )
    };

    let [link, file] = ["link", "file"].map(|name| folder.file(name));
    symlink("file", &link).unwrap();
    for _ in ["a new file", "an old one"] {
        printed(save(&link));
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert!(fs::read(&file).unwrap().starts_with(b"TILE"));
    }

    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
    printed(save(&file));
    let mode = fs::metadata(&file).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o640);

    let pipe = folder.file("pipe");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let reader = {
        let pipe = pipe.clone();
        spawn(move || fs::read(pipe).unwrap())
    };
    printed(save(&pipe));
    let weights = fs::read(&file).unwrap();
    assert!(reader.join().unwrap() == weights);

    let output = save("/dev/stdout");
    assert!(output.status.success());
    assert!(output.stdout.starts_with(&weights));
    assert_eq!(names(&folder.0).len(), 3);
}

#[test]
fn a_path_may_be_a_folder_empty_or_not_unicode() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    let folder = Folder::new("paths");
    fs::create_dir(folder.file("a.svg")).unwrap();
    fs::create_dir(folder.file("a.gif")).unwrap();
    for (example, option, name) in [
        ("phase_portrait", "--out", "a.svg"),
        ("render_episode", "--out", "a.gif"),
    ] {
        let path = folder.file(name);
        let errors = rejected(example, &[option, &path], "");
        let reason = format!("cannot write {path}: Is a directory");
        assert!(errors.contains(&reason), "{errors}");
        let errors = rejected(example, &[option, ""], "");
        assert!(
            errors.contains("a value is required for '--out"),
            "{errors}"
        );
    }
    for (example, option, name) in [
        ("phase_portrait", "--out", &b"\xff.svg"[..]),
        ("render_episode", "--out", b"\xff.gif"),
        ("swing_up", "--save", b"\xff"),
    ] {
        let path = folder.0.join(OsStr::from_bytes(name));
        let mut example = command(example, &[]);
        if option == "--save" {
            example.args(["--quiet", "--episodes", "3"]);
        }
        printed(example.arg(option).arg(&path).output().unwrap());
        assert!(path.is_file());
    }
    let name = format!("{}.svg", "n".repeat(300));
    let errors = rejected("phase_portrait", &["--out", &folder.file(&name)], "");
    assert!(errors.contains("File name too long"), "{errors}");
}

/// In a gigabyte of memory.
#[test]
fn endless_input_is_rejected() {
    let limits = "ulimit -v 1000000";
    for example in ["swing_up", "plan"] {
        let arguments = ["--load", "/dev/zero"];
        let output = limited(limits, example, &arguments).output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        let reason = "/dev/zero: weights must have at most 131072 bytes, got more";
        assert_eq!(output.status.code(), Some(2), "{errors}");
        assert!(errors.contains(reason), "{errors}");
    }
    let mut trace = limited(limits, "trace", &["--seed", "1"]);
    let trace = trace.stdin(File::open("/dev/zero").unwrap());
    let output = trace.output().unwrap();
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{errors}");
    let reason = "the input must have at most 67108864 bytes, got more";
    assert!(errors.contains(reason), "{errors}");
}
