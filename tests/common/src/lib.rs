//! Code that several tests share.

pub mod canvas;
mod recording;
mod repeating;
pub mod twins;

use std::fs;
use std::path::{Path, PathBuf};

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::physics::{Dynamics, Joints};
use acrobot::task::{Draw, Draws};
use acrobot::{Params, State};

pub use bits::Digest;
pub use recording::*;
pub use repeating::Repeating;

/// The largest difference of the four numbers; angles that differ by a whole turn are equal.
pub fn distance(x: State, y: State) -> f64 {
    let angle = |x: f64, y: f64| {
        let difference = (x - y).abs();
        difference.min((difference - std::f64::consts::TAU).abs())
    };
    angle(x.theta1, y.theta1)
        .max(angle(x.theta2, y.theta2))
        .max((x.dtheta1 - y.dtheta1).abs())
        .max((x.dtheta2 - y.dtheta2).abs())
}

/// The bits of a state or of other numbers, which distinguish 0 from −0.
pub fn bits<S: Real, const N: usize>(numbers: impl Into<[S; N]>) -> [u64; N] {
    numbers.into().map(|x| x.to_f64().to_bits())
}

/// Calls `check::<A>()` for each arithmetic, and with friction.
#[macro_export]
macro_rules! in_every_arithmetic {
    ($check:ident) => {{
        $check::<acrobot::arithmetic::Reference>();
        $check::<acrobot::arithmetic::Portable>();
        $check::<acrobot::arithmetic::Host>();
        $check::<acrobot::arithmetic::Fast>();
        $check::<acrobot::arithmetic::Micro>();
        $check::<acrobot::arithmetic::Damped<acrobot::Fast>>();
    }};
}

/// Uniform draws of all parameters that differ.
pub fn between<S: Real>(low: Params<S>, high: Params<S>) -> Draws<S> {
    let mut draws = Draws::FIXED;
    let ends = low.numbers().into_iter().zip(high.numbers());
    for (draw, ((_, low), (_, high))) in draws.numbers_mut().into_iter().zip(ends) {
        if low != high {
            *draw = Draw::Uniform { low, high };
        }
    }
    Draws::new(draws).unwrap()
}

/// All parameters that an arithmetic has, each from a wide range.
pub fn draws<A: Arithmetic>() -> Draws<A::Scalar> {
    let friction = |most: f64| if A::HAS_FRICTION { most } else { 0.0 };
    let [low, high] = [0, 1].map(|i| Params {
        length1: [0.5, 2.0][i],
        length2: [0.5, 2.0][i],
        mass1: [0.5, 2.0][i],
        mass2: [0.5, 2.0][i],
        center_of_mass1: [0.0, 1.0][i],
        center_of_mass2: [0.0, 1.0][i],
        inertia1: [0.5, 2.0][i],
        inertia2: [0.5, 2.0][i],
        gravity: [1.6, 24.8][i],
        dt: [0.05, 0.3][i],
        max_velocity1: [5.0, 20.0][i],
        max_velocity2: [5.0, 40.0][i],
        torques: [[-2.0, -0.5, 0.5], [-0.5, 0.5, 2.0]][i],
        torque_noise: [0.0, 0.5][i],
        dynamics: Dynamics::Book,
        friction: Joints { joint1: [0.0, friction(0.5)][i], joint2: [0.0, friction(0.3)][i] },
        coulomb: Joints { joint1: [0.0, friction(0.2)][i], joint2: [0.0, friction(0.1)][i] },
        rotor: [0.0, friction(0.05)][i],
    });
    between(low.cast(), high.cast())
}

/// Fails with the text that a page of the docs should contain. Line breaks do not count.
pub fn assert_says(page: &str, text: &str) {
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let written = words(&text_of(page));
    assert!(written.contains(&words(text)), "measured, and not in {page}: {text}");
}

/// Compares with a file of `tests/data/`. With `UPDATE_SNAPSHOTS` in the environment it writes the
/// file again.
pub fn assert_snapshot(name: &str, found: &str) {
    let path = format!("tests/data/{name}");
    if std::env::var_os("UPDATE_SNAPSHOTS").is_some() {
        fs::write(absolute(&path), found).unwrap();
    } else {
        assert!(read(&path) == found.as_bytes(), "{name} differs from:\n{found}");
    }
}

pub fn absolute(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

pub fn text_of(path: &str) -> String {
    String::from_utf8(read(path)).unwrap()
}

fn read(path: &str) -> Vec<u8> {
    fs::read(absolute(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}
