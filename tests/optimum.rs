//! The best known sequences of actions reach the goal, and docs/optimum.md has their mean return.

use acrobot::arithmetic::{Arithmetic, Host, Reference};
use acrobot::{Acrobot, Action, TimeLimit};
use common::{assert_says, text_of};

/// Plays each sequence from the state after `reset(seed)`, where the seed is its line, counted from 0. Returns the
/// returns of those that reach the goal with their last action, and not before.
fn returns<A: Arithmetic>() -> Vec<f32> {
    let text = text_of("tests/data/optimum.txt");
    let sequences = text.lines().filter(|line| !line.starts_with('#'));
    let played = (0..).zip(sequences).filter_map(|(seed, sequence)| {
        let mut env = TimeLimit::v1(Acrobot::<A>::new(seed));
        let steps = sequence.chars().map(|sign| match sign {
            '-' => env.step(Action::Negative),
            '0' => env.step(Action::Zero),
            '+' => env.step(Action::Positive),
            _ => panic!("{sign} is not an action"),
        });
        let steps: Vec<_> = steps.collect();
        let end = steps.iter().position(|step| step.done())?;
        let reached = end + 1 == steps.len() && steps[end].terminated;
        reached.then(|| steps.iter().map(|step| step.reward).sum())
    });
    played.collect()
}

#[test]
fn the_best_sequences_reach_the_goal() {
    let returns = returns::<Reference>();
    assert_eq!(returns.len(), 1000);
    let mean = returns.iter().sum::<f32>() / 1000.0;
    assert_says(
        "docs/optimum.md",
        &format!("| best known | −{:.2} |", -mean),
    );
}

/// `Host` has Gymnasium's own bits where the C library is the recorded one.
#[test]
fn the_best_sequences_reach_the_goal_in_the_hosts_arithmetic() {
    let reached = returns::<Host>().len();
    println!("{reached} of 1,000");
    assert!(reached >= 990, "only {reached} of 1,000");
}
