//! The policy of the programs that play one episode, and how they end. Without `#[inline]` the
//! flash of `minimal` would change.

use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, Step, TimeLimit};
use semihosting::{println, process};

/// Torque against the first link's velocity.
#[inline]
pub fn decide([.., dtheta1, _]: [f32; 6]) -> Action {
    if dtheta1 > 0.0 { Action::Negative } else { Action::Positive }
}

/// Ends the program, with status 0 if the episode ended as in a plain loop.
#[inline]
pub fn finish(acrobot: &TimeLimit<Acrobot<Fast>>, step: Step) -> ! {
    let mut expected = TimeLimit::of(Acrobot::hanging(Pcg64::new(42)));
    let mut last = expected.step(Action::Positive);
    while !last.done() {
        last = expected.step(decide(last.observation));
    }
    let equal = (acrobot, step) == (&expected, last);
    println!("{} steps; as in a plain loop: {equal}", acrobot.elapsed_steps());
    process::exit(if equal && step.terminated { 0 } else { 1 })
}
