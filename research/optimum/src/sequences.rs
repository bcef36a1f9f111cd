//! The best known sequences: a line for each initial state, with a sign for each action.

use acrobot::Action;

/// A sequence for each initial state.
pub fn load() -> Vec<Vec<Action>> {
    let lines = include_str!("../sequences.txt").lines().filter(|line| !line.starts_with('#'));
    let action = |sign| match sign {
        '-' => Action::Negative,
        '0' => Action::Zero,
        '+' => Action::Positive,
        other => panic!("a line must have only - 0 +, got {other}"),
    };
    lines.map(|line| line.chars().map(action).collect()).collect()
}

#[cfg(test)]
mod tests {
    use acrobot::arithmetic::{Arithmetic, Host, Reference};
    use acrobot::{Acrobot, State};
    use common::assert_says;

    use super::*;
    use crate::{SEEDS, initial, mean_return};

    /// Whether the last action reaches the goal, and none before.
    fn reaches<A: Arithmetic<Scalar = f64>>(initial: State, actions: &[Action]) -> bool {
        let mut acrobot = Acrobot::<A>::new(0);
        acrobot.set_state(initial).unwrap();
        let last = actions.iter().position(|&action| acrobot.step(action).terminated);
        last.is_some_and(|last| last + 1 == actions.len())
    }

    /// `Host` has Gymnasium's own bits where the C library is the recorded one.
    #[test]
    fn the_best_sequences_reach_the_goal_in_both_arithmetics() {
        let sequences = load();
        let mean = mean_return(sequences.iter().flatten().count() as f64);
        assert_says("docs/optimum.md", &format!("| best known | −{:.2} |", -mean));
        assert_eq!(sequences.len(), SEEDS as usize);
        for (seed, sequence) in (0..).zip(&sequences) {
            assert!(reaches::<Reference>(initial(seed), sequence), "seed {seed}");
        }
        let all = (0..).zip(&sequences);
        let in_host = all.filter(|(seed, sequence)| reaches::<Host>(initial(*seed), sequence));
        let count = in_host.count();
        assert!(count >= 990, "{count} of 1,000 sequences reach the goal in `Host`");
    }
}
