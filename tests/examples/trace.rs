//! `trace` prints every bit of an episode.

use std::fs::{self, File};
use std::process::Command;

use super::{Folder, printed, rejected};
use acrobot::arithmetic::{Arithmetic, Host, Micro, Real, Reference};
use acrobot::{Acrobot, Fast, Params, Portable, State};
use common::{RECORDING, is_recorded_library};

fn trace(folder: &Folder, arguments: &str, actions: &str) -> Command {
    fs::write(folder.path("actions"), actions).unwrap();
    let mut trace = folder.command(&format!("trace {arguments}"));
    trace.stdin(File::open(folder.path("actions")).unwrap());
    trace
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
    let text = include_str!("../data/episodes.txt");
    let rows = text.lines().filter(|line| !line.starts_with(['#', 'l']));
    let folder = Folder::new();
    for (row, episode) in rows.zip(&RECORDING.episodes).step_by(7) {
        let options = ["--seed", "--low", "--high", "--dynamics", "--noise", "--dt"];
        let pairs = options.into_iter().zip(row.split(' '));
        let arguments: Vec<_> = pairs.flat_map(|(option, value)| [option, value]).collect();
        let mut actions = String::new();
        for &action in &episode.actions {
            actions += &format!("{} \n", u8::from(action));
        }
        let mut expected = words(episode.states[0]) + "\n";
        for (i, &state) in episode.states[1..].iter().enumerate() {
            let terminated = u8::from(episode.terminated[i]);
            expected += &format!("{} {} {terminated}\n", words(state), episode.rewards[i]);
        }
        let found = printed(&mut trace(&folder, &arguments.join(" "), &actions));
        assert_eq!(found, expected, "{row}");
    }
}

#[test]
fn trace_takes_every_arithmetic() {
    fn check<A: Arithmetic>() {
        let mut acrobot = Acrobot::<A>::new(7);
        let params = Params {
            dt: 0.1,
            ..Params::DEFAULT
        };
        acrobot.set_params(params.cast()).unwrap();
        let mut expected = words(acrobot.state()) + "\n";
        for action in [0, 1, 2, 2] {
            let step = acrobot.step(action.try_into().unwrap());
            let terminated = u8::from(step.terminated);
            expected += &format!("{} -1 {terminated}\n", words(acrobot.state()));
        }
        let arguments = format!("--seed 7 --dt 0.1 --arithmetic {}", A::NAME);
        assert_eq!(
            printed(&mut trace(&Folder::new(), &arguments, "01\t2\u{b}\n2")),
            expected
        );
    }
    check::<Host>();
    check::<Reference>();
    check::<Portable>();
    check::<Fast>();
    check::<Micro>();
}

#[test]
fn trace_rejects_other_characters() {
    let errors = rejected(&mut trace(&Folder::new(), "--seed 1", "0 1\n3 2"));
    let reason = "the input must be actions (0, 1 and 2) and white space, got '3' as byte 5";
    assert!(errors.contains(reason), "{errors}");
}
