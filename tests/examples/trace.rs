//! `trace` prints every bit of an episode.

use super::{printed, rejected, run};
use acrobot::arithmetic::{Arithmetic, Host, Micro, Real, Reference};
use acrobot::{Acrobot, Fast, Params, Portable, State};
use common::{RECORDING, is_recorded_library};

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
    let text = include_str!("../data/episodes.txt");
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
        ("reference", expected::<Reference>()),
        ("portable", expected::<Portable>()),
        ("fast", expected::<Fast>()),
        ("micro", expected::<Micro>()),
    ] {
        let arguments = ["--seed", "7", "--dt", "0.1", "--arithmetic", name];
        assert_eq!(printed(run("trace", &arguments, "01\t2\u{b}\n2")), expected);
    }
}

#[test]
fn trace_rejects_with_a_reason() {
    for (arguments, reason) in [
        (
            "--seed -5",
            "seed must be a decimal integer of at least 0, got '-' as character 1",
        ),
        ("--seed 12_000", "got '_' as character 3"),
        ("--seed=", "got an empty text"),
        ("--seed 1 --low nan", "3.4e38 rad and rad/s, got NaN"),
        ("--seed 1 --low -inf", "low must be within -3.4e38 and"),
        (
            "--seed 1 --dt 1e-60 --arithmetic fast",
            "rounded to the arithmetic's f32, dt must be finite and above 0 s, got 0",
        ),
        ("--seed 1 --high inf", "rad/s, got inf"),
        (
            "--seed 1 --low 0.2",
            "low must not be above high, got 0.2 and 0.1",
        ),
        ("--seed 1 --dt 0", "dt must be finite and above 0 s, got 0"),
        (
            "--seed 1 --noise nan",
            "torque_noise must be finite and at least 0 N m, got NaN",
        ),
        ("--seed 1 --dynamics film", "possible values: book, nips"),
        (
            "--seed 1 --arithmetic slow",
            "possible values: host, reference, portable, fast, micro",
        ),
    ] {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let errors = rejected("trace", &arguments, "012");
        assert!(errors.contains(reason), "{errors}");
    }
    let errors = rejected("trace", &["--seed", "1"], "0 1\n3 2");
    assert!(
        errors
            .contains("the input must be actions (0, 1 and 2) and white space, got '3' as byte 5"),
        "{errors}"
    );
}
