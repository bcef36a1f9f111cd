//! Pictures are those of the README, and bad input and failed writes are errors.

use std::fs;

use super::{Folder, command, gif_frames, png, printed, rejected, run, svg};
use acrobot::render::{Figure, Frame};
use acrobot::{Acrobot, Portable, State};

#[test]
fn a_state_is_rendered_as_its_frame() {
    let folder = Folder::new("state");
    let out = folder.file("frame.png");
    printed(run(
        "render_episode",
        &["--state", "-0.6,1.5", "--out", &out],
        "",
    ));
    let mut acrobot = Acrobot::<Portable>::new(0);
    acrobot
        .set_state(State {
            theta1: -0.6,
            theta2: 1.5,
            ..State::default()
        })
        .unwrap();
    let expected = Frame::of(&Figure::new(&acrobot));
    assert_eq!(png(&out), (500, 500, expected.bytes().to_vec()));
}

/// The example draws the README's first picture.
#[test]
fn the_episode_is_the_readmes_picture() {
    let folder = Folder::new("episode");
    let (gif, strip) = (folder.file("episode.gif"), folder.file("episode.png"));
    printed(run("render_episode", &["--out", &gif], ""));
    assert!(
        fs::read(&gif).unwrap() == include_bytes!("../../examples/episode.gif"),
        "examples/episode.gif differs"
    );
    let (width, height, pixels) = png(&strip);
    assert_eq!((width, height), (8 * 150, 150));
    assert!(pixels.chunks(3).any(|pixel| pixel == [0, 204, 204]));

    assert_eq!(gif_frames(&gif), 95);
}

#[test]
fn the_portrait_is_of_its_seed() {
    let folder = Folder::new("portrait");
    let out = folder.file("portrait.svg");
    let [one, other] = [("42", "94 steps"), ("43", "steps")].map(|(seed, steps)| {
        let arguments = ["--seed", seed, "--out", &out];
        assert!(printed(run("phase_portrait", &arguments, "")).contains(steps));
        svg(&out)
    });
    assert!(one != other, "the seed must change the picture");
}

#[test]
fn drawing_examples_reject_with_a_reason() {
    for (example, arguments, reason) in [
        ("render_episode", "--state 1", "must be two numbers in rad"),
        (
            "render_episode",
            "--state nan,1",
            "theta1 must be a finite number of rad, got NaN",
        ),
        (
            "render_episode",
            "--out picture.png",
            "--out must end in .gif, got picture.png",
        ),
        (
            "render_episode",
            "--out no/such/folder.gif",
            "cannot write no/such/folder.gif",
        ),
        (
            "phase_portrait",
            "--out no/such/folder.svg",
            "must be a name that ends in .svg, in an existing folder",
        ),
        (
            "render_episode",
            "--state 1,1 --out frame.gif",
            "--out must end in .png, got frame.gif",
        ),
        (
            "phase_portrait",
            "--out portrait.png",
            "must be a name that ends in .svg, in an existing folder",
        ),
        (
            "energy_control",
            "--limit 0",
            "must be finite and above 0 N m",
        ),
        ("energy_control", "--episodes 0", "0 is not in 1.."),
    ] {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let errors = rejected(example, &arguments, "");
        assert!(errors.contains(reason), "{errors}");
    }
}

/// A failed write is an error, also if the bytes fit into a buffer.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_an_error() {
    let folder = Folder::new("full");
    for name in ["full.csv", "full.gif", "full.png", "full.svg"] {
        std::os::unix::fs::symlink("/dev/full", folder.file(name)).unwrap();
    }
    for (example, arguments, name) in [
        ("render_episode", "--state 1,2 --out", "full.png"),
        ("render_episode", "--seed 42 --out", "full.gif"),
        ("phase_portrait", "--out", "full.svg"),
        (
            "sutton1996",
            "--runs 1 --episodes 9 --csv FOLDER/a.csv --picture",
            "full.svg",
        ),
        ("sutton1996", "--runs 1 --episodes 9 --csv", "full.csv"),
        (
            "sweep",
            "--episodes 4 --masses 1,2 --torques 1,2 --csv FOLDER/a.csv --picture",
            "full.svg",
        ),
        ("sweep", "--episodes 400 --csv", "full.csv"),
    ] {
        let path = folder.file(name);
        let arguments = arguments.replace("FOLDER", folder.0.to_str().unwrap());
        let mut arguments: Vec<&str> = arguments.split(' ').collect();
        arguments.push(&path);
        let errors = rejected(example, &arguments, "");
        let reason = format!("cannot write {path}: No space left");
        assert!(errors.contains(&reason), "{example}: {errors}");
    }
    for name in [
        "learning_curve.svg",
        "values.svg",
        "swing_up.gif",
        "weights",
    ] {
        let folder = Folder::new(&format!("full-{name}"));
        let path = folder.file(name);
        std::os::unix::fs::symlink("/dev/full", &path).unwrap();
        let mut swing_up = command("swing_up", &["--episodes", "20"]);
        swing_up.args(["--pictures", folder.0.to_str().unwrap()]);
        if name == "weights" {
            swing_up.args(["--save", &path]);
        }
        let output = swing_up.output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{name}: {errors}");
        let reason = format!("cannot write {path}: No space left");
        assert!(errors.contains(&reason), "{errors}");
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(name == "weights" || text.contains("\nlearnt "), "{text}");
    }
}
