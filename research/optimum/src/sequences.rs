//! The file of the best known sequences: a line for each initial state, with a sign for each
//! action.

use acrobot::arithmetic::{Arithmetic, Reference};
use acrobot::{Acrobot, Action, State};
use anyhow::{Context, ensure};

use crate::{SEEDS, initial};

/// The sequences, one for each initial state, each checked.
pub fn load() -> anyhow::Result<Vec<Vec<Action>>> {
    let lines = include_str!("../sequences.txt").lines().filter(|line| !line.starts_with('#'));
    let sequences = lines.map(|line| {
        let action = |sign| Some(Action::ALL["-0+".find(sign)?]);
        let actions = line.chars().map(action).collect::<Option<Vec<_>>>();
        actions.with_context(|| format!("a line must have only - 0 +, got {line}"))
    });
    let sequences = sequences.collect::<anyhow::Result<Vec<_>>>()?;
    let found = sequences.len();
    ensure!(found == SEEDS as usize, "must have {SEEDS} sequences, got {found}");
    for (seed, sequence) in (0..).zip(&sequences) {
        ensure!(
            reaches::<Reference>(initial(seed), sequence),
            "the sequence for seed {seed} must reach the goal with its last action"
        );
    }
    Ok(sequences)
}

/// Whether the last action reaches the goal, and none before.
pub fn reaches<A: Arithmetic<Scalar = f64>>(initial: State, actions: &[Action]) -> bool {
    let mut acrobot = Acrobot::<A>::new(0);
    acrobot.set_state(initial).expect("a finite state");
    let last = actions.iter().position(|&action| acrobot.step(action).terminated);
    last.is_some_and(|last| last + 1 == actions.len())
}

#[cfg(test)]
mod tests {
    use acrobot::arithmetic::Host;
    use common::assert_says;

    use super::*;
    use crate::mean_return;

    /// `Host` has Gymnasium's own bits where the C library is the recorded one.
    #[test]
    fn the_best_sequences_reach_the_goal_in_both_arithmetics() {
        let sequences = load().unwrap();
        let mean = mean_return(sequences.iter().flatten().count() as f64);
        assert_says("docs/optimum.md", &format!("| best known | −{:.2} |", -mean));
        let all = (0..).zip(&sequences);
        let in_host = all.filter(|(seed, sequence)| reaches::<Host>(initial(*seed), sequence));
        assert!(in_host.count() >= 990);
    }
}
