//! The policy of the programs that play one episode, and the episode as a plain loop plays it.
//!
//! `#[inline]` compiles them in these programs alone. Otherwise the flash of `minimal` changes by 8 bytes.

use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, Observation, Step, TimeLimit};

/// Torque against the first link's velocity.
#[inline]
pub fn decide(observation: &Observation) -> Action {
    if observation.dtheta1() > 0.0 {
        Action::Negative
    } else {
        Action::Positive
    }
}

/// Plays an episode in a plain loop. Returns the acrobot and its last step.
#[inline]
pub fn play() -> (TimeLimit<Acrobot<Fast>>, Step) {
    let mut acrobot = TimeLimit::v1(Acrobot::hanging(Pcg64::new(42)));
    let mut step = acrobot.step(Action::Positive);
    while !step.done() {
        step = acrobot.step(decide(&step.observation));
    }
    (acrobot, step)
}
