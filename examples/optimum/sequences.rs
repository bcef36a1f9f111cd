//! The file of the best known sequences: a line for each initial state, with a sign for each action.

use std::fs;
use std::path::Path;

use acrobot::arithmetic::Reference;
use acrobot::physics::Pendulum;
use acrobot::{Action, State};

const SIGNS: [char; 3] = ['-', '0', '+'];
const HEAD: &str = "\
# The fewest known steps to the goal: line s has the actions after Gymnasium's reset(seed=s), counted from 0.
# - 0 + are torques of -1, 0 and 1 N m. Made by: cargo run --release --example optimum -- search
";

/// The sequences of a file, or none if there is no file.
pub fn load(path: &Path) -> Result<Vec<Vec<Action>>, String> {
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(_) if !path.exists() => return Ok(Vec::new()),
        Err(error) => return Err(format!("{}: {error}", path.display())),
    };
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let sequences = lines.map(|line| {
        let action = |sign| {
            SIGNS
                .iter()
                .position(|&s| s == sign)
                .map(|i| Action::ALL[i])
        };
        let unknown = || {
            format!(
                "{}: a line must have only - 0 +, got {line}",
                path.display()
            )
        };
        line.chars()
            .map(action)
            .collect::<Option<_>>()
            .ok_or_else(unknown)
    });
    sequences.collect()
}

/// The text of the file.
pub fn text(sequences: &[Vec<Action>]) -> String {
    let lines = sequences.iter().map(|sequence| {
        let signs = sequence.iter().map(|&action| SIGNS[action as usize]);
        signs.chain(['\n']).collect::<String>()
    });
    HEAD.chars()
        .chain(lines.collect::<String>().chars())
        .collect()
}

/// Whether the last action reaches the goal, and none before, in `Reference`.
pub fn reaches(initial: State, actions: &[Action]) -> bool {
    let mut pendulum = Pendulum::<Reference>::at(initial).expect("a finite state");
    let last = actions.iter().position(|&action| {
        let torque = pendulum.params().torque(action);
        pendulum.step(torque).expect("a finite torque")
    });
    last.is_some_and(|last| last + 1 == actions.len())
}
