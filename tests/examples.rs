//! The examples do what they say, as a user starts them.

mod common;
#[path = "examples/sutton1996.rs"]
mod sutton1996;

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use acrobot::env::Frame;
use acrobot::{
    Acrobot, Action, Arithmetic, Fast, Figure, Host, Micro, Params, Portable, Real, SeedSequence,
    State, TimeLimit,
};
use common::{RECORDING, is_recorded_library};

fn command(example: &str, arguments: &[&str]) -> Command {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["run", "--quiet", "--example", example]);
    if !cfg!(debug_assertions) {
        cargo.arg("--release");
    }
    cargo
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .arg("--")
        .args(arguments);
    cargo
}

fn run(example: &str, arguments: &[&str], input: &str) -> Output {
    let mut cargo = command(example, arguments);
    let pipes = cargo
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = pipes.spawn().unwrap();
    // One that refuses its arguments does not read.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    child.wait_with_output().unwrap()
}

fn printed(output: Output) -> String {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {errors}", output.status);
    String::from_utf8(output.stdout).unwrap()
}

fn refused(example: &str, arguments: &[&str], input: &str) -> String {
    let output = run(example, arguments, input);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    assert!(
        output.stdout.is_empty(),
        "nothing is printed before a refusal"
    );
    String::from_utf8(output.stderr).unwrap()
}

fn words<S: Real>(state: State<S>) -> String {
    <[S; 4]>::from(state)
        .map(|x| format!("{:016x}", x.to_f64().to_bits()))
        .join(" ")
}

#[test]
fn trace_prints_gymnasiums_episodes() {
    if !is_recorded_library() {
        return;
    }
    let text = include_str!("data/episodes.txt");
    let rows = text.lines().filter(|line| !line.starts_with(['#', 'l']));
    for (row, episode) in rows.zip(&RECORDING.episodes).step_by(7) {
        let [seed, low, high, dynamics, noise, dt] = row.split(' ').collect::<Vec<_>>()[..] else {
            panic!("{row}")
        };
        let arguments = [
            "--seed",
            seed,
            "--low",
            low,
            "--high",
            high,
            "--dynamics",
            dynamics,
            "--noise",
            noise,
            "--dt",
            dt,
        ];
        let actions: Vec<String> = episode
            .actions
            .iter()
            .map(|&action| u8::from(action).to_string())
            .collect();
        let mut expected = words(episode.states[0]) + "\n";
        for (i, &state) in episode.states[1..].iter().enumerate() {
            let terminated = u8::from(episode.terminated[i]);
            expected += &format!("{} {} {terminated}\n", words(state), episode.rewards[i]);
        }
        assert_eq!(
            printed(run("trace", &arguments, &actions.join(" \n"))),
            expected,
            "{row}"
        );
    }
}

#[test]
fn trace_takes_every_arithmetic() {
    fn expected<A: Arithmetic>() -> String {
        let mut acrobot = Acrobot::<A>::new(7);
        acrobot
            .set_params(
                Params {
                    dt: 0.1,
                    ..Params::DEFAULT
                }
                .cast(),
            )
            .unwrap();
        let mut lines = words(acrobot.state()) + "\n";
        for action in [0, 1, 2, 2] {
            let step = acrobot.step(action.try_into().unwrap());
            lines += &format!(
                "{} -1 {}\n",
                words(acrobot.state()),
                u8::from(step.terminated)
            );
        }
        lines
    }
    for (name, expected) in [
        ("host", expected::<Host>()),
        ("portable", expected::<Portable>()),
        ("fast", expected::<Fast>()),
        ("micro", expected::<Micro>()),
    ] {
        let arguments = ["--seed", "7", "--dt", "0.1", "--arithmetic", name];
        assert_eq!(printed(run("trace", &arguments, "01\t2\u{b}\n2")), expected);
    }
}

#[test]
fn trace_refuses_with_a_reason() {
    for (arguments, reason) in [
        (
            "--seed -5",
            "seed has '-' as character 1; allowed is a decimal integer",
        ),
        ("--seed 12_000", "seed has '_' as character 3"),
        ("--seed=", "seed is empty"),
        ("--seed 1 --low nan", "low is NaN"),
        ("--seed 1 --low -inf", "low is -inf"),
        (
            "--seed 1 --dt 1e-60 --arithmetic fast",
            "rounded to the arithmetic's f32, dt is 0 s",
        ),
        ("--seed 1 --high inf", "high is inf"),
        ("--seed 1 --low 0.2", "low is 0.2 and high is 0.1"),
        (
            "--seed 1 --dt 0",
            "dt is 0 s; allowed is a finite number above 0",
        ),
        ("--seed 1 --noise nan", "torque_noise is NaN N m"),
        ("--seed 1 --dynamics film", "possible values: book, nips"),
        (
            "--seed 1 --arithmetic slow",
            "possible values: host, portable, fast, micro",
        ),
    ] {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let errors = refused("trace", &arguments, "012");
        assert!(errors.contains(reason), "{errors}");
    }
    let errors = refused("trace", &["--seed", "1"], "0 1\n3 2");
    assert!(
        errors.contains("'3' at byte 5 of the input; allowed are the actions 0, 1 and 2"),
        "{errors}"
    );
}

#[test]
fn the_random_agent_takes_gymnasiums_episodes() {
    if !is_recorded_library() {
        return;
    }
    let rows = include_str!("data/seeds.txt")
        .lines()
        .filter_map(|line| line.strip_prefix("agent "));
    let mut goals = 0;
    for row in rows.step_by(4) {
        let row: Vec<&str> = row.split(' ').collect();
        let output = printed(run(
            "random_agent",
            &["--seed", row[0], "--steps", "3000"],
            "",
        ));
        let mut lines = output.lines();
        let mut sum = 0;
        for (episode, number) in row[1..].chunks(2).zip(1..) {
            let length: i32 = episode[0].parse().unwrap();
            let (goal, end) = if episode[1] == "1" {
                (1, "terminated")
            } else {
                (0, "truncated")
            };
            goals += goal;
            sum += goal - length;
            let expected = format!(
                "episode {number}: {length} steps, return {}, {end}",
                goal - length
            );
            assert_eq!(lines.next(), Some(&*expected), "seed {}", row[0]);
        }
        let summary = lines.next().unwrap();
        let mean = f64::from(sum) / (row.len() / 2) as f64;
        assert!(
            summary.starts_with("3000 steps, ")
                && summary.contains(&format!("mean return {mean:.1}")),
            "{summary}"
        );
    }
    assert!(goals > 0, "one of the episodes should reach the goal");
}

#[test]
fn the_random_agent_helps_and_refuses() {
    let help = printed(run("random_agent", &["--help"], ""));
    assert!(
        help.contains("--seed") && help.contains("--steps"),
        "{help}"
    );
    assert!(printed(run("random_agent", &["--steps", "0"], "")).starts_with("0 steps, 0 episodes"));
    let errors = refused("random_agent", &["--seed", "4x2"], "");
    assert!(errors.contains("seed has 'x' as character 2"), "{errors}");
    refused("random_agent", &["--steps", "-1"], "");
}

/// An empty folder of one test, gone when it ends.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("acrobot-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn file(&self, name: &str) -> String {
        self.0.join(name).to_str().unwrap().to_owned()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn gif_frames(path: &str) -> usize {
    let mut frames = gif::DecodeOptions::new()
        .read_info(fs::File::open(path).unwrap())
        .unwrap();
    let mut count = 0;
    while frames.read_next_frame().unwrap().is_some() {
        count += 1;
    }
    count
}

fn png(path: &str) -> (u32, u32, Vec<u8>) {
    let file = std::io::Cursor::new(fs::read(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    (info.width, info.height, bytes)
}

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

/// The README's first picture is what the example draws.
#[test]
fn the_episode_is_the_readmes_picture() {
    let folder = Folder::new("episode");
    let (gif, strip) = (folder.file("episode.gif"), folder.file("episode.png"));
    printed(run("render_episode", &["--out", &gif], ""));
    assert!(
        fs::read(&gif).unwrap() == include_bytes!("../examples/episode.gif"),
        "examples/episode.gif is another"
    );
    let (width, height, pixels) = png(&strip);
    assert_eq!((width, height), (8 * 150, 150));
    assert!(pixels.chunks(3).any(|pixel| pixel == [0, 204, 204]));

    assert_eq!(gif_frames(&gif), 95);
}

#[test]
fn the_portrait_has_its_four_panels() {
    let folder = Folder::new("portrait");
    let out = folder.file("portrait.svg");
    assert!(printed(run("phase_portrait", &["--out", &out], "")).contains("94 steps"));
    let svg = fs::read_to_string(&out).unwrap();
    for title in [
        "angles",
        "velocities",
        "energy",
        "phase portrait",
        "rad/s",
        "time (s)",
    ] {
        assert!(svg.contains(title), "{title}");
    }
    assert!(svg.matches("<polyline").count() >= 6);
}

#[test]
fn the_energy_controller_catches_the_upright() {
    let output = printed(run("energy_control", &["--episodes", "20"], ""));
    let row = |policy: &str, limit: &str| {
        let row = output
            .lines()
            .find(|line| line.starts_with(policy) && line.contains(limit));
        row.unwrap_or_else(|| panic!("{output}")).to_owned()
    };
    assert!(
        row("energy", "10 N m").matches("20 of 20 at").count() == 2,
        "{output}"
    );
    assert!(
        row("bang-bang", "1 N m").contains("20 of 20 at"),
        "{output}"
    );
    assert!(row("random", "1 N m").ends_with("0 of 20"), "{output}");
}

/// The row of a cell, from episodes that acrobots play alone.
fn sweep_row(seed: u64, episodes: u64, mass: f32, torque: f32) -> String {
    let (mut reached, mut steps) = (0_u64, 0_u64);
    for seed in SeedSequence::from(seed).spawn(episodes) {
        let mut acrobot = TimeLimit::v1(Acrobot::<Fast>::new(seed));
        let params = Params {
            mass1: mass,
            mass2: mass,
            torques: [-torque, 0.0, torque],
            ..Params::default()
        };
        acrobot.inner_mut().set_params(params).unwrap();
        let end = loop {
            let against = acrobot.inner().state().dtheta1 > 0.0;
            let step = acrobot.step(if against {
                Action::Negative
            } else {
                Action::Positive
            });
            if step.ended() {
                break step;
            }
        };
        if end.terminated {
            reached += 1;
            steps += u64::from(acrobot.elapsed());
        }
    }
    let share = reached as f64 / episodes as f64;
    let mean = match reached {
        0 => String::new(),
        _ => format!("{:.3}", steps as f64 / reached as f64),
    };
    format!("{mass},{torque},{episodes},{reached},{share:.4},{steps},{mean}")
}

#[test]
fn the_sweep_counts_every_episode_once() {
    let folder = Folder::new("sweep");
    let (csv, picture) = (folder.file("sweep.csv"), folder.file("sweep.svg"));
    let [one, two] = ["1", "2"].map(|threads| {
        // One of these episodes reaches the goal by its very last step.
        let arguments = "--episodes 1800 --seed 7 --masses 0.1,1.5 --torques 0.001,0.1,0.3";
        let mut arguments: Vec<&str> = arguments.split(' ').collect();
        arguments.extend(["--csv", &csv, "--picture", &picture]);
        let mut sweep = command("sweep", &arguments);
        let output = sweep.env("RAYON_NUM_THREADS", threads).output().unwrap();
        assert!(printed(output).contains("1800 episodes"));
        (
            fs::read_to_string(&csv).unwrap(),
            fs::read(&picture).unwrap(),
        )
    });
    assert!(one == two, "the number of threads changes a byte");

    let mut rows = one.0.lines();
    assert_eq!(
        rows.next().unwrap(),
        "mass_kg,torque_n_m,episodes,reached,share,steps_of_reached,mean_steps_of_reached"
    );
    let mut shares = Vec::new();
    for mass in [0.1, 1.5] {
        for torque in [0.001, 0.1, 0.3] {
            let row = rows.next().unwrap();
            assert_eq!(row, sweep_row(7, 300, mass, torque));
            shares.push(row.split(',').nth(4).unwrap().parse::<f64>().unwrap());
        }
    }
    assert_eq!(rows.next(), None);
    assert!(
        [0.0, 1.0].iter().all(|share| shares.contains(share))
            && shares.iter().any(|&share| 0.0 < share && share < 1.0),
        "cells of which none, some and all reach the goal: {shares:?}"
    );

    // Each cell, sixty shades of the colour bar and the paper.
    let svg = String::from_utf8(one.1).unwrap();
    assert_eq!(svg.matches("<rect").count(), 6 + 60 + 1);
    let grey = shares.iter().filter(|&&share| share < 0.5).count();
    assert_eq!(svg.matches("#BEBEBE").count(), grey);
    for text in [
        "300 episodes a cell",
        "mass of each link (kg)",
        "torque (N m)",
        "0.001",
        "512",
    ] {
        assert!(svg.contains(text), "{text}");
    }
}

/// The README's heat map is what the command beside it draws.
#[test]
#[cfg_attr(
    debug_assertions,
    ignore = "a million episodes, which want optimization"
)]
fn the_sweep_is_the_readmes_picture() {
    let folder = Folder::new("heat-map");
    let (csv, picture) = (folder.file("sweep.csv"), folder.file("sweep.svg"));
    printed(run("sweep", &["--csv", &csv, "--picture", &picture], ""));
    assert!(
        fs::read(&picture).unwrap() == include_bytes!("../examples/sweep.svg"),
        "examples/sweep.svg is another"
    );
}

#[test]
fn the_sweep_refuses_before_it_writes() {
    let folder = Folder::new("refused-sweep");
    let (csv, picture) = (folder.file("sweep.csv"), folder.file("sweep.svg"));
    let missing = folder.file("none/sweep.csv");
    for (option, value, reason) in [
        (
            "--episodes",
            "1001",
            "--episodes is 1001 episodes; allowed is a multiple of 400, the cells of the grid, up to 400000000",
        ),
        (
            "--episodes",
            "0",
            "--episodes is 0 episodes; allowed is a multiple of 400",
        ),
        ("--episodes", "400000400", "up to 400000000"),
        ("--episodes", "-400", "invalid value '-400' for '--episodes"),
        (
            "--seed",
            "-1",
            "seed has '-' as character 1; allowed is a decimal integer",
        ),
        (
            "--masses",
            "1,0",
            "invalid value '0' for '--masses <KG>': allowed is a number of kg above 0 that f32 holds",
        ),
        ("--masses", "", "allowed is a number of kg above 0"),
        ("--masses", "nan", "allowed is a number of kg above 0"),
        ("--masses", "1e-60", "allowed is a number of kg above 0"),
        (
            "--torques",
            "inf,1",
            "invalid value 'inf' for '--torques <N_M>': allowed is a number of N m above 0 that f32 holds",
        ),
        ("--torques", "-1", "allowed is a number of N m above 0"),
        (
            "--csv",
            &missing,
            "allowed is a name that ends in .csv, in a folder that is there",
        ),
        ("--csv", &picture, "allowed is a name that ends in .csv"),
        (
            "--picture",
            &csv,
            "allowed is a name that ends in .svg, in a folder that is there",
        ),
    ] {
        let mut arguments = vec![option, value];
        for (other, valid) in [
            ("--episodes", "400"),
            ("--csv", &csv),
            ("--picture", &picture),
        ] {
            if other != option {
                arguments.extend([other, valid]);
            }
        }
        let errors = refused("sweep", &arguments, "");
        assert!(errors.contains(reason), "{errors}");
        assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0, "{arguments:?}");
    }
}

/// The figures of the line that `--quiet` prints: whether and when it was solved, the greedy policy's mean
/// and standard deviation, and its misses. The line has no other form than theirs.
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
        "the seed changes nothing"
    );

    // What was learnt is in the file, and nothing is added to it.
    let (one, again) = (folder.file("one"), folder.file("again"));
    let files = ["--load", &one, "--save", &again];
    let line = swing_up("--quiet --episodes 0 --seed 1", &files);
    assert_eq!(figures(&line), (None, mean, sd, misses));
    assert!(fs::read(one).unwrap() == fs::read(again).unwrap());
}

/// Zeros already are torque against θ̇1: of equal actions the learner takes the first, mirrored with the
/// state. So what is learnt has to be better than that by more than chance.
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
    // Three standard errors of the difference, of 1,000 episodes each.
    let chance = 3.0 * ((learnt[1] * learnt[1] + against[1] * against[1]) / 1000.0).sqrt();
    assert!(learnt[0] - against[0] > chance, "{output}");
    assert_eq!([learnt[2], against[2]], [0.0, 0.0], "{output}");
    assert!(random[0] < -490.0 && random[2] > 900.0, "{output}");

    // The curve from the first to the last episode, and the line at which it is solved.
    let curve = fs::read_to_string(folder.file("learning_curve.svg")).unwrap();
    for text in ["Learning to swing up", "episode", "solved: -100", "1000"] {
        assert!(curve.contains(text), "{text}");
    }
    let points = |line: &str| line.split('"').map(|part| part.matches(',').count()).max();
    let lines = curve.match_indices("<polyline");
    let long =
        lines.filter(|&(at, _)| points(curve[at..].split("/>").next().unwrap()) >= Some(2000));
    assert_eq!(long.count(), 2, "returns, and their running mean");

    // Each cell, sixty shades of the colour bar and the paper; the goal is grey on both sides alike.
    let values = fs::read_to_string(folder.file("values.svg")).unwrap();
    assert_eq!(values.matches("<rect").count(), 72 * 72 + 60 + 1);
    let grey = values.matches("#BEBEBE").count();
    assert!(
        grey.is_multiple_of(2) && (500..1500).contains(&grey),
        "{grey}"
    );

    // The start and every step; the goal is reached, or there were 501 frames.
    let steps = output.split("last greedy episode, ").nth(1).unwrap();
    let steps: usize = steps.split(' ').next().unwrap().parse().unwrap();
    assert_eq!(gif_frames(&folder.file("swing_up.gif")), steps + 1);
    assert!((50..200).contains(&steps), "{output}");

    let untrained = figures(&swing_up("--quiet --episodes 0", &[]));
    assert_eq!(untrained, (None, against[0], against[1], 0));
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
fn swing_up_refuses_weights_that_are_not_its_own() {
    let folder = Folder::new("refused-weights");
    let weights = folder.file("weights");
    swing_up("--quiet --episodes 3", &["--save", &weights]);
    let bytes = fs::read(&weights).unwrap();
    let changed = |at: usize| {
        let mut bytes = bytes.clone();
        bytes[at] ^= 2;
        bytes
    };
    for (bytes, arguments, reason) in [
        (bytes[1..].to_vec(), "", "these are no weights"),
        (vec![], "", "these are no weights"),
        (changed(4), "", "weights of version 3; allowed is 1"),
        (
            bytes[..65_555].to_vec(),
            "",
            "weights of 65555 bytes; allowed is 65556",
        ),
        (
            [&bytes[..], &[0]].concat(),
            "",
            "weights of 65557 bytes; allowed is 65556",
        ),
        (
            bytes.clone(),
            "--memory 16k",
            "weights of 65556 bytes; allowed is 16404",
        ),
        (changed(30_000), "", "damaged weights: checksum "),
        (changed(65_555), "", "damaged weights: checksum "),
        (bytes.clone(), "--preset quality", "weights of features "),
    ] {
        fs::write(&weights, bytes).unwrap();
        let out = folder.file("out");
        let mut all: Vec<&str> = arguments.split_whitespace().collect();
        let pictures = folder.0.to_str().unwrap();
        all.extend(["--load", &weights, "--save", &out, "--pictures", pictures]);
        let errors = refused("swing_up", &all, "");
        assert!(
            errors.contains(&weights) && errors.contains(reason),
            "{errors}"
        );
        assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 1, "{errors}");
    }
}

#[test]
fn swing_up_refuses_before_it_learns() {
    let folder = Folder::new("refused-swing-up");
    for (arguments, reason) in [
        ("--preset slow", "possible values: fast, quality"),
        ("--memory 12k", "possible values: 8k, 16k, 32k, 64k"),
        ("--episodes -1", "-1 is not in 0..=4294967295"),
        (
            "--episodes 4294967296",
            "4294967296 is not in 0..=4294967295",
        ),
        ("--seed -1", "seed has '-' as character 1"),
        ("--load none/weights", "none/weights: "),
        (
            "--save none/weights",
            "allowed is a file in a folder that is there",
        ),
        ("--pictures none", "allowed is a folder that is there"),
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

#[test]
fn drawing_examples_refuse_with_a_reason() {
    for (example, arguments, reason) in [
        (
            "render_episode",
            "--state 1",
            "allowed are two numbers in rad",
        ),
        ("render_episode", "--state nan,1", "theta1 is NaN rad"),
        (
            "render_episode",
            "--out picture.png",
            "--out is picture.png; allowed is a name that ends in .gif",
        ),
        (
            "render_episode",
            "--out no/such/folder.gif",
            "cannot write no/such/folder.gif",
        ),
        (
            "phase_portrait",
            "--out no/such/folder.svg",
            "cannot write no/such/folder.svg",
        ),
        (
            "render_episode",
            "--state 1,1 --out frame.gif",
            "allowed is a name that ends in .png",
        ),
        (
            "phase_portrait",
            "--out portrait.png",
            "allowed is a name that ends in .svg",
        ),
        (
            "energy_control",
            "--limit 0",
            "allowed is a finite number of N m above 0",
        ),
        ("energy_control", "--episodes 0", "0 is not in 1.."),
    ] {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let errors = refused(example, &arguments, "");
        assert!(errors.contains(reason), "{errors}");
    }
}

/// What cannot be written is no success, also where it is little enough to wait in a buffer.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_an_error() {
    let folder = Folder::new("full");
    for name in ["frame.png", "episode.gif"] {
        std::os::unix::fs::symlink("/dev/full", folder.file(name)).unwrap();
    }
    let (frame, episode) = (folder.file("frame.png"), folder.file("episode.gif"));
    for arguments in [
        ["--state", "1,2", "--out", &frame],
        ["--seed", "42", "--out", &episode],
    ] {
        let errors = refused("render_episode", &arguments, "");
        assert!(
            errors.contains("cannot write") && errors.contains("No space left"),
            "{errors}"
        );
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
    }
}

#[test]
fn planning_beats_what_was_learnt_within_fixed_memory() {
    let short = ["--learn", "300", "--episodes", "20", "--depth", "30"];
    let text = printed(run("plan", &short, ""));
    assert_eq!(text, printed(run("plan", &short, "")));
    let mean = |name: &str| -> f64 {
        let (_, rest) = text.split_once(name).unwrap();
        rest.split_whitespace().next().unwrap().parse().unwrap()
    };
    // Values of 300 episodes are coarse.
    assert!(mean("30 steps ahead") > -80.0, "{text}");
    assert!(mean("30 steps ahead") > mean("greedy") + 10.0, "{text}");
    let (_, search) = text.split_once("the search takes ").unwrap();
    let bytes: usize = search.split_once(" bytes").unwrap().0.parse().unwrap();
    assert!(bytes <= 4096, "{text}");
}

#[test]
fn planning_refuses_bad_input() {
    let folder = Folder::new("refused-plan");
    let weights = folder.file("weights.bin");
    fs::write(&weights, b"TILE").unwrap();
    for (option, value, reason) in [
        ("--depth", "0", "0 is not in 1..=128"),
        ("--depth", "129", "129 is not in 1..=128"),
        ("--episodes", "0", "0 is not in 1.."),
        ("--load", &weights, "allowed is"),
        ("--load", &folder.file("none.bin"), "none.bin: "),
    ] {
        let output = run("plan", &[option, value], "");
        assert_eq!(output.status.code(), Some(2), "{option} {value}");
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains(reason), "{message}");
    }
}
