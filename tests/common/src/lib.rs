//! Code that several tests share.

pub mod canvas;
mod recording;
mod repeating;
pub mod smooth;
pub mod twins;

use std::fs;
use std::path::{Path, PathBuf};

use acrobot::State;
use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::task::{Draw, Draws};

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

/// Uniform draws of all parameters that an arithmetic has, each from a wide range.
pub fn draws<A: Arithmetic>() -> Draws<A::Scalar> {
    let friction = [0.5, 0.3, 0.2, 0.1, 0.05].map(|most| [0.0, most]);
    let ranges = [
        &[[0.5, 2.0]; 4][..],                     // lengths and masses
        &[[0.0, 1.0]; 2],                         // centres of mass
        &[[0.5, 2.0]; 2],                         // inertias
        &[[1.6, 24.8], [0.05, 0.3]],              // gravity and dt
        &[[5.0, 20.0], [5.0, 40.0]],              // bounds of velocities
        &[[-2.0, -0.5], [-0.5, 0.5], [0.5, 2.0]], // torques
        &[[0.0, 0.5]],                            // noise
        if A::HAS_FRICTION { &friction } else { &[] },
    ];
    let mut draws = Draws::FIXED;
    for (draw, range) in draws.numbers_mut().into_iter().zip(ranges.concat()) {
        let [low, high] = range.map(Real::from_f64);
        *draw = Draw::Uniform { low, high };
    }
    Draws::new(draws).unwrap()
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
