//! Plays one Rust implementation with a random policy for some seconds of processor time, and
//! prints `name version steps seconds`: `cargo run --release -- rlevo 1`.

#![forbid(unsafe_code)]

use std::env;
use std::hint::black_box;

use acrobot::{Acrobot, Action, Fast, TimeLimit};
use benches::{Play, draw};
use cpu_time::ProcessTime;
use rlevo_core::action::DiscreteAction as _;
use rlevo_core::environment::Environment as _;
use rlevo_environments::classic::acrobot::{Acrobot as RlevoAcrobot, AcrobotAction};

/// Plays a number of steps and returns how many episodes ended.
type Implementation = Box<dyn FnMut(usize) -> usize>;

/// The name of an implementation, its package, and how to make it.
type Row = (&'static str, &'static str, fn() -> Implementation);

const IMPLEMENTATIONS: [Row; 3] = [
    ("fast", "acrobot", fast),
    ("batch", "acrobot", batch),
    ("rlevo", "rlevo-environments", rlevo),
];

const ACROBOTS: usize = 1024;
/// Steps between two readings of the clock: a few milliseconds, and whole steps of a batch.
const STEPS: usize = 16 * ACROBOTS;

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [name, seconds] = &arguments[..] else {
        panic!("the arguments must be a name and seconds");
    };
    let seconds: f64 = seconds.parse().expect("seconds must be a number");
    let found = IMPLEMENTATIONS.iter().find(|(known, ..)| known == name);
    let (_, package, new) = found.expect("the name must be one of IMPLEMENTATIONS");
    let mut play = new();
    play(STEPS); // warms up
    let (mut steps, mut elapsed) = (0, 0.0);
    while elapsed < seconds {
        let start = ProcessTime::now();
        play(STEPS);
        elapsed += start.elapsed().as_secs_f64();
        steps += STEPS;
    }
    println!("{name} {} {steps} {elapsed}", version(package));
}

fn version(package: &str) -> &'static str {
    let lock = include_str!("../Cargo.lock");
    let (_, rest) =
        lock.split_once(&format!("name = \"{package}\"\nversion = \"")).expect("a dependency");
    rest.split_once('"').expect("a version in quotes").0
}

/// An implementation from a `step`, which resets after an episode's end and returns whether there
/// was one.
fn alone(mut step: impl FnMut(u8) -> bool + 'static) -> Implementation {
    let mut stream = 0;
    Box::new(move |steps| (0..steps).filter(|_| step(draw(&mut stream))).count())
}

fn fast() -> Implementation {
    let mut acrobot = TimeLimit::with_task_limit(Acrobot::<Fast>::new(0));
    alone(move |action| {
        let done = black_box(acrobot.step(Action::ALL[usize::from(action)])).is_done();
        if done {
            acrobot.reset();
        }
        done
    })
}

fn batch() -> Implementation {
    let mut play = Play::<Fast>::new(ACROBOTS);
    Box::new(move |steps| {
        let batch_steps = 0..steps / ACROBOTS;
        let ends = batch_steps.map(|_| {
            play.play(true);
            play.ends()
        });
        ends.sum()
    })
}

fn rlevo() -> Implementation {
    let acrobot = <RlevoAcrobot>::default();
    let mut acrobot = rlevo_environments::wrappers::TimeLimit::new(acrobot, 500);
    acrobot.reset().expect("it resets");
    alone(move |action| {
        let action = AcrobotAction::from_index(action.into());
        let step = black_box(acrobot.step(action)).expect("the episode goes on");
        let ended = step.status.is_done();
        if ended {
            acrobot.reset().expect("it resets");
        }
        ended
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Few random episodes reach the goal before the limit, and none is longer.
    #[test]
    fn every_implementation_plays_episodes_of_almost_500_steps() {
        for (name, _, new) in IMPLEMENTATIONS {
            let steps = 1200 * ACROBOTS; // a batch is in its third episodes then
            let ends = new()(steps);
            assert!((steps / 600..steps / 450).contains(&ends), "{name} {ends}");
        }
    }
}
