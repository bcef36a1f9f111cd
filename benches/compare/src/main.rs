//! Plays one Rust implementation with a random policy for some seconds of processor time, and prints
//! `name version steps seconds`. For two implementations it prints how many times as long the first takes.
//!
//! ```text
//! cargo run --release -- gmgn 1
//! cargo run --release -- rlevo/fast 1
//! ```

#![forbid(unsafe_code)]

use std::env;
use std::hint::black_box;
use std::io::{self, Write};
use std::process::ExitCode;

use acrobot::arithmetic::{Arithmetic, Host, Reference};
use acrobot::batch::{Batch, Block, StepBuffers};
use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, Portable, TimeLimit};
use cpu_time::ProcessTime;
use gmgn::env::Env as _;
use gmgn::envs::classic_control::AcrobotEnv;
use ogym::env::control::acrobot::{Acrobot as OgymAcrobot, AcrobotConfig};
use ogym::env::environment::Environment as _;
use ogym::spaces::MixedItem;
use rlevo_core::action::DiscreteAction as _;
use rlevo_core::environment::Environment as _;
use rlevo_environments::classic::acrobot::{Acrobot as RlevoAcrobot, AcrobotAction};

/// Plays a number of steps and returns how many episodes ended.
type Implementation = Box<dyn FnMut(usize) -> usize>;

type New = fn() -> Implementation;

/// The name of each implementation, its package, and how to make it.
const IMPLEMENTATIONS: [(&str, &str, New); 9] = [
    ("host", "acrobot", ours::<Host>),
    ("reference", "acrobot", ours::<Reference>),
    ("portable", "acrobot", ours::<Portable>),
    ("fast", "acrobot", ours::<Fast>),
    ("batch", "acrobot", || batch(false)),
    ("observations", "acrobot", || batch(true)),
    ("gmgn", "gmgn", gmgn),
    ("ogym", "ogym", ogym),
    ("rlevo", "rlevo-environments", rlevo),
];

/// The acrobots of a batch.
const ACROBOTS: usize = 1024;
/// Steps between two readings of the clock: a few milliseconds, and whole steps of a batch.
const STEPS: usize = 16 * ACROBOTS;
const LIMIT: u16 = 500;

fn main() -> ExitCode {
    // All names are Unicode, so a lossy argument matches none and is rejected.
    let arguments = env::args_os().map(|argument| argument.to_string_lossy().into_owned());
    let message = match report(&arguments.skip(1).collect::<Vec<_>>()) {
        Some(line) => match writeln!(io::stdout(), "{line}") {
            Ok(()) => return ExitCode::SUCCESS,
            Err(error) => format!("error: cannot print: {error}"),
        },
        None => format!(
            "usage: acrobot-compare NAME[/NAME] SECONDS, where a name is one of {}, and seconds are finite and above 0",
            IMPLEMENTATIONS.map(|(name, ..)| name).join(", ")
        ),
    };
    // The status must be right even if the message cannot be printed.
    let _ = writeln!(io::stderr(), "{message}");
    ExitCode::from(2)
}

fn report(arguments: &[String]) -> Option<String> {
    let [names, seconds] = arguments else {
        return None;
    };
    let seconds = seconds.parse().ok()?;
    if !(seconds > 0.0 && f64::is_finite(seconds)) {
        return None;
    }
    if let Some((slow, quick)) = names.split_once('/') {
        let [(slow, _), (quick, _)] = [find(slow)?, find(quick)?];
        let [slow, quick] = time([slow, quick], seconds).1;
        return Some(format!("{names} {:.2}", slow / quick));
    }
    let (implementation, version) = find(names)?;
    let (steps, [seconds]) = time([implementation], seconds);
    Some(format!("{names} {version} {steps} {seconds}"))
}

/// The implementation with this name, and its version.
fn find(name: &str) -> Option<(Implementation, String)> {
    let (_, package, new) = IMPLEMENTATIONS
        .iter()
        .find(|implementation| implementation.0 == name)?;
    let lock = lock();
    let (_, rest) = lock.split_once(&format!("name = \"{package}\"\nversion = \""))?;
    Some((new(), rest.split_once('"')?.0.to_owned()))
}

/// The lock file, which has the versions.
fn lock() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.lock");
    std::fs::read_to_string(path).unwrap_or_default()
}

/// Plays all implementations interleaved until one has used `seconds`. Returns the steps of each, and the time of each.
fn time<const N: usize>(
    mut implementations: [Implementation; N],
    seconds: f64,
) -> (usize, [f64; N]) {
    for play in &mut implementations {
        play(STEPS); // warms up
    }
    let (mut steps, mut times) = (0, [0.0; N]);
    while times.iter().all(|&time| time < seconds) {
        for (play, time) in implementations.iter_mut().zip(&mut times) {
            let start = ProcessTime::now();
            play(STEPS);
            *time += start.elapsed().as_secs_f64();
        }
        steps += STEPS;
    }
    (steps, times)
}

/// The policy. It costs little compared with a step, and SIMD can compute it.
fn draw(stream: &mut u32) -> u8 {
    *stream = stream.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    (((*stream >> 16) * 3) >> 16) as u8
}

/// An implementation from a `step`, which resets after an episode's end and returns whether there was one.
fn alone(mut step: impl FnMut(u8) -> bool + 'static) -> Implementation {
    let mut stream = 0;
    Box::new(move |steps| (0..steps).filter(|_| step(draw(&mut stream))).count())
}

fn ours<A: Arithmetic + 'static>() -> Implementation {
    let mut acrobot = TimeLimit::v1(Acrobot::<A>::new(0));
    alone(move |action| {
        let done = black_box(acrobot.step(Action::ALL[usize::from(action)])).done();
        if done {
            acrobot.reset();
        }
        done
    })
}

fn batch(observe: bool) -> Implementation {
    const N: usize = ACROBOTS;
    let blocks = vec![Block::EMPTY; N.div_ceil(Block::<Fast>::LANES)];
    let generators = vec![Pcg64::UNSEEDED; N];
    let mut batch =
        Batch::<Fast, _>::new(0, (blocks, generators)).expect("blocks for all acrobots");
    let mut streams: Vec<u32> = (0..N as u32).map(|i| i.wrapping_mul(0x9e37_79b9)).collect();
    let (mut actions, mut rewards, mut rows) = (vec![0; N], vec![0.0; N], vec![[0.0; 6]; N]);
    let (mut terminated, mut truncated) = (vec![false; N], vec![false; N]);
    Box::new(move |steps| {
        let mut ends = 0;
        for _ in 0..steps / N {
            for (action, stream) in actions.iter_mut().zip(&mut streams) {
                *action = draw(stream);
            }
            let mut buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated);
            buffers.observations = observe.then_some(&mut rows);
            batch
                .step(&actions, buffers)
                .expect("slices of the batch's length");
            let ended = terminated.iter().zip(&truncated).map(|(a, b)| a | b);
            ends += usize::from(ended.map(u16::from).sum::<u16>());
        }
        ends
    })
}

fn gmgn() -> Implementation {
    let acrobot = AcrobotEnv::new(Default::default()).expect("its default is valid");
    let mut acrobot = gmgn::wrappers::TimeLimit::new(acrobot, LIMIT.into());
    acrobot.reset(Some(0)).expect("it resets");
    alone(move |action| {
        let step = black_box(acrobot.step(&action.into())).expect("a valid action");
        let ended = step.terminated || step.truncated;
        if ended {
            acrobot.reset(None).expect("it resets");
        }
        ended
    })
}

fn ogym() -> Implementation {
    let config = AcrobotConfig::default().with_max_steps(LIMIT.into());
    let mut acrobot = OgymAcrobot::new(config).expect("its default is valid");
    acrobot.reset(Some(0)).expect("it resets");
    alone(move |action| {
        let action = MixedItem::Discrete(action.into());
        let step = black_box(acrobot.step(action)).expect("the episode goes on");
        let ended = step.terminal.is_done();
        if ended {
            acrobot.reset(None).expect("it resets");
        }
        ended
    })
}

fn rlevo() -> Implementation {
    let acrobot = <RlevoAcrobot>::default();
    let mut acrobot = rlevo_environments::wrappers::TimeLimit::new(acrobot, LIMIT.into());
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
    use acrobot::physics::{Pendulum, State};

    #[test]
    fn every_implementation_steps_and_reports_its_version() {
        for (name, package, _) in IMPLEMENTATIONS {
            let line = report(&[name.into(), "0.01".into()]).unwrap();
            let [reported, version, steps, seconds] = line.split(' ').collect::<Vec<_>>()[..]
            else {
                panic!("{line}");
            };
            assert_eq!(reported, name);
            let locked = format!("[[package]]\nname = \"{package}\"\nversion = \"{version}\"\n");
            assert!(lock().contains(&locked), "{line}");
            assert!(steps.parse::<usize>().unwrap() >= STEPS, "{line}");
            assert!(seconds.parse::<f64>().unwrap() >= 0.01, "{line}");
        }
    }

    /// Few random episodes reach the goal before the limit, and none is longer.
    #[test]
    fn every_implementation_plays_episodes_of_almost_500_steps() {
        for (name, _, new) in IMPLEMENTATIONS {
            let steps = 1200 * ACROBOTS; // a batch is in its third episodes then
            let ends = new()(steps);
            assert!((steps / 600..steps / 450).contains(&ends), "{name} {ends}");
        }
    }

    /// Ogym shows only observations, so each step of ours begins at the state that its last observation tells.
    #[test]
    fn ogym_steps_as_we_do() {
        let mut theirs = OgymAcrobot::new(AcrobotConfig::default()).unwrap();
        theirs.reset(Some(0)).unwrap();
        let mut ours = Pendulum::<Portable>::hanging();
        let mut stream = 0;
        for _ in 0..LIMIT {
            let action = draw(&mut stream);
            let step = theirs.step(MixedItem::Discrete(action.into())).unwrap();
            let [cos1, sin1, cos2, sin2, dtheta1, dtheta2]: [f64; 6] = step.curr_state.into();
            let state = State {
                theta1: sin1.atan2(cos1),
                theta2: sin2.atan2(cos2),
                dtheta1,
                dtheta2,
            };
            ours.set_state(state).unwrap();
            let goal = ours.step(f64::from(action) - 1.0).unwrap();
            let [(sin1, cos1), (sin2, cos2)] = ours.sin_cos();
            let after = ours.state();
            let expected = [cos1, sin1, cos2, sin2, after.dtheta1, after.dtheta2];
            for (theirs, ours) in step.next_state.iter().zip(expected) {
                assert!((theirs - ours).abs() < 1e-12, "{theirs} {ours}");
            }
            assert_eq!(step.terminal.is_terminated(), goal);
        }
    }

    #[test]
    fn two_implementations_are_compared() {
        let line = report(&["gmgn/gmgn".into(), "0.1".into()]).unwrap();
        let ratio: f64 = line.strip_prefix("gmgn/gmgn ").unwrap().parse().unwrap();
        assert!((0.5..2.0).contains(&ratio), "{line}");
    }

    #[test]
    fn unknown_arguments_are_rejected() {
        for arguments in [
            "",
            "fast",
            "slow 1",
            "fast/slow 1",
            "fast soon",
            "fast 1 1",
            "fast nan",
            "fast -1",
            "fast 0",
            "fast inf",
        ] {
            let arguments: Vec<String> = arguments.split(' ').map(str::to_owned).collect();
            assert_eq!(report(&arguments), None);
        }
    }
}
