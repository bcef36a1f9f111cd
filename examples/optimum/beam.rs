//! A beam search for the fewest steps to the goal.

use std::collections::HashSet;

use acrobot::physics::Pendulum;
use acrobot::arithmetic::Reference;
use acrobot::{Action, State};

use crate::values::{Stepper, Values, coordinates};

/// No search goes deeper.
const DEPTH: usize = 150;

/// Searches from one initial state after another.
pub struct Beam {
    width: usize,
    /// Cells per rad and per rad/s. The beam keeps one state of each cell.
    fineness: f32,
    stepper: Stepper,
}

/// A reached state.
struct Node {
    state: State<f32>,
    /// The place of its parent in the beam, times the number of actions, plus the action.
    origin: u32,
}

impl Beam {
    pub fn new(width: usize, fineness: f32) -> Self {
        Self { width, fineness, stepper: Stepper::new() }
    }

    /// The shortest path found that reaches the goal in `Reference`, with its last action.
    pub fn search(&mut self, values: &Values, initial: State) -> Option<Vec<Action>> {
        let mut beam = vec![initial.cast::<f32>()];
        let mut origins: Vec<Vec<u32>> = Vec::new();
        let mut children = Vec::new();
        let mut order = Vec::new();
        let mut cells = HashSet::new();
        for _ in 0..DEPTH {
            children.clear();
            order.clear();
            let mut goals = Vec::new();
            for action in Action::ALL {
                self.stepper.step(&beam, action, |parent, state, reached| {
                    let origin = (parent * 3 + action as usize) as u32;
                    if reached {
                        goals.push(origin);
                    }
                    // The bits of positive numbers are in the order of the numbers.
                    let value = u64::from(values.at(&state).to_bits());
                    order.push(value << 32 | children.len() as u64);
                    children.push(Node { state, origin });
                });
            }
            let paths = goals.into_iter().map(|goal| path(&origins, goal));
            if let Some(path) = paths.into_iter().find(|path| reaches(initial, path)) {
                return Some(path);
            }
            order.sort_unstable();
            cells.clear();
            beam.clear();
            let mut kept = Vec::new();
            for &key in &order {
                let Node { state, origin } = children[key as u32 as usize];
                let cell = coordinates(&state).map(|x| (x * self.fineness).round() as i16);
                if cells.insert(cell) {
                    beam.push(state);
                    kept.push(origin);
                    if beam.len() == self.width {
                        break;
                    }
                }
            }
            origins.push(kept);
        }
        None
    }
}

/// The actions to a node.
fn path(origins: &[Vec<u32>], last: u32) -> Vec<Action> {
    let mut origin = last;
    let mut actions = vec![Action::ALL[origin as usize % 3]];
    for origins in origins.iter().rev() {
        origin = origins[origin as usize / 3];
        actions.push(Action::ALL[origin as usize % 3]);
    }
    actions.reverse();
    actions
}

/// Whether the last action reaches the goal, and none before, in `Reference`.
fn reaches(initial: State, actions: &[Action]) -> bool {
    let mut pendulum = Pendulum::<Reference>::at(initial).expect("a finite state");
    let steps = actions.iter().position(|&action| {
        let torque = pendulum.params().torque(action);
        pendulum.step(torque).expect("a finite torque")
    });
    steps == Some(actions.len() - 1)
}
