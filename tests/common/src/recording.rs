//! Episodes and steps that `tests/data/record.py` recorded from Gymnasium.

use std::hint::black_box;
use std::io::Write;
use std::sync::LazyLock;

use acrobot::arithmetic::{Arithmetic, Host};
use acrobot::numpy::{Pcg64, SeedSequence, uniform};
use acrobot::physics::Dynamics;
use acrobot::task::ResetBounds;
use acrobot::{Acrobot, Action, Params, ResetOptions, State};
use bits::Digest;

use crate::read;

pub const STEPS: usize = 500;

pub struct Episode {
    pub seed: SeedSequence,
    pub bounds: ResetBounds,
    pub params: Params,
    pub actions: Vec<Action>,
    /// The initial state, and the state after each action.
    pub states: Vec<State>,
    pub rewards: Vec<f32>,
    pub terminated: Vec<bool>,
    pub start_observation: [f32; 6],
    pub observations: Digest,
}

impl Episode {
    /// An acrobot in the episode's initial state.
    pub fn start<A: Arithmetic>(&self) -> Acrobot<A> {
        let mut acrobot = Acrobot::<A>::new(0);
        let params = self.params.cast();
        acrobot.set_params(params).unwrap();
        acrobot
            .reset_with(ResetOptions { seed: Some(self.seed.clone()), bounds: Some(self.bounds) });
        acrobot
    }
}

/// Versions, a digest of the C library's functions, and the episodes.
pub struct Recording {
    pub versions: String,
    pub library: Digest,
    pub episodes: Vec<Episode>,
}

pub static RECORDING: LazyLock<Recording> = LazyLock::new(|| {
    let text = read("tests/data/episodes.txt");
    let text = str::from_utf8(&text).unwrap();
    let bytes = read("tests/data/episodes.bin");
    let mut bytes = &bytes[..];
    let mut lines = text.lines();
    let versions = lines.next().unwrap().trim_start_matches("# ").to_owned();
    let mut lines = lines.filter(|line| !line.starts_with('#'));
    let library = lines.next().unwrap().strip_prefix("library ").unwrap();
    let library = Digest(u64::from_str_radix(library, 16).unwrap());
    let episodes = lines.map(|line| read_episode(line, &mut bytes)).collect();
    assert!(bytes.is_empty(), "episodes.bin and episodes.txt do not belong together");
    Recording { versions, library, episodes }
});

/// Whether this platform's sin, cos and pow are those that the episodes were recorded with.
/// `Host`'s bits depend on them. If they differ, this writes to stderr directly, because the test
/// harness captures `eprintln!`.
pub fn is_recorded_library() -> bool {
    let mut rng = Pcg64::new(0);
    let mut digest = Digest::default();
    for _ in 0..100_000 {
        let x = black_box(uniform(&mut rng, -30.0, 30.0));
        let (sin, cos) = Host::sin_cos(x);
        for y in [sin, cos, Host::square(x)] {
            digest.add(y.to_bits());
        }
    }
    if digest == RECORDING.library {
        return true;
    }
    let message = format!(
        "BIT PARITY IS NOT TESTED: sin, cos or pow differ here from those of {}",
        RECORDING.versions
    );
    assert!(std::env::var_os("REQUIRE_PARITY").is_none(), "{message}");
    let _ = writeln!(std::io::stderr(), "{message}");
    false
}

fn read_episode(line: &str, bytes: &mut &[u8]) -> Episode {
    let [decimal, low, high, dynamics, noise, dt] =
        line.split(' ').collect::<Vec<_>>().try_into().unwrap();
    let number = |text: &str| text.parse::<f64>().unwrap();
    let mut take = |n| {
        let (head, tail) = bytes.split_at(n);
        *bytes = tail;
        head
    };
    let f32s = |bytes: &[u8]| {
        let words = bytes.as_chunks().0.iter();
        words.map(|x| f32::from_le_bytes(*x)).collect::<Vec<_>>()
    };
    Episode {
        seed: decimal.parse().unwrap(),
        bounds: ResetBounds::new(number(low), number(high)).unwrap(),
        params: Params {
            dynamics: dynamics_of(dynamics),
            torque_noise: number(noise),
            dt: number(dt),
            ..Params::DEFAULT
        },
        actions: take(STEPS).iter().map(|&n| Action::try_from(n).unwrap()).collect(),
        states: f64s(take((STEPS + 1) * 32))
            .as_chunks()
            .0
            .iter()
            .map(|y| State::from(*y))
            .collect(),
        rewards: take(STEPS).iter().map(|&x| f32::from(x as i8)).collect(),
        terminated: take(STEPS).iter().map(|&x| x == 1).collect(),
        start_observation: f32s(take(24)).try_into().unwrap(),
        observations: Digest(u64::from_le_bytes(take(8).try_into().unwrap())),
    }
}

pub fn dynamics_of(name: &str) -> Dynamics {
    match name {
        "book" => Dynamics::Book,
        "nips" => Dynamics::Nips,
        _ => panic!("unknown dynamics {name}"),
    }
}

/// The rest of each line of a recording that starts with this word.
pub fn lines<'a>(text: &'a str, word: &'a str) -> impl Iterator<Item = &'a str> {
    text.lines().filter_map(move |line| line.strip_prefix(word)?.strip_prefix(' '))
}

pub fn numbers(line: &str) -> Vec<f64> {
    line.split(' ').map(|x| x.parse().unwrap()).collect()
}

fn f64s(bytes: &[u8]) -> Vec<f64> {
    let words = bytes.as_chunks().0.iter();
    words.map(|x| f64::from_le_bytes(*x)).collect()
}

/// Takes each step of the episodes from its recorded state, and then each of the single steps with
/// other parameters. Calls `check` with a name of the step, the state before it, the state that it
/// reached, and the recorded one.
pub fn take_recorded_steps<A: Arithmetic>(
    mut check: impl FnMut(String, State, State<A::Scalar>, State),
) {
    let mut take = |name, acrobot: &mut Acrobot<A>, state: State, action, next| {
        acrobot.set_state(state.cast()).unwrap();
        acrobot.step(action);
        check(name, state, acrobot.state(), next);
    };
    for (number, episode) in RECORDING.episodes.iter().enumerate() {
        let mut acrobot = episode.start();
        for (i, &action) in episode.actions.iter().enumerate() {
            let name = format!("step {} of episode {number}", i + 1);
            take(name, &mut acrobot, episode.states[i], action, episode.states[i + 1]);
        }
    }
    let singles = f64s(&read("tests/data/steps.bin"));
    let (singles, rest) = singles.as_chunks::<23>();
    assert!(rest.is_empty());
    assert_eq!(singles.len(), 2600, "steps in tests/data/steps.bin: edit this count");
    for (number, single) in singles.iter().enumerate() {
        let [given @ .., dynamics, x1, x2, x3, x4, action, y1, y2, y3, y4] = *single;
        let dynamics = [Dynamics::Book, Dynamics::Nips][dynamics as usize];
        let mut params = Params { dynamics, ..Params::DEFAULT };
        let [links @ .., _, _, dt, v1, v2, t1, t2, t3, _, _, _, _, _, _] = params.numbers_mut();
        let places = links.into_iter().chain([dt, v1, v2, t1, t2, t3]);
        places.zip(given).for_each(|(place, x)| *place = x);
        params.inertia2 = params.inertia1;
        let mut acrobot = Acrobot::with_params(0, params.cast()).unwrap();
        let [state, next] = [[x1, x2, x3, x4], [y1, y2, y3, y4]].map(State::from);
        let action = Action::try_from(action as u8).unwrap();
        take(format!("single step {number}"), &mut acrobot, state, action, next);
    }
}
