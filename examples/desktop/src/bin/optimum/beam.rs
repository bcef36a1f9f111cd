//! A beam search for the fewest steps to the goal.

use std::collections::HashSet;

use acrobot::{Action, State};

use crate::values::{Stepper, Values, coordinates};

/// A search with the exact model, from one state after another.
pub struct Beam<'a> {
    /// States that are followed at the same time.
    pub width: usize,
    /// Cells per rad and per rad/s. The beam follows only one state of each cell.
    pub fineness: f32,
    pub values: &'a Values,
    pub stepper: Stepper,
}

/// A reached state.
struct Node {
    state: State<f32>,
    /// The place of its parent in the beam, and the action.
    origin: (u32, Action),
}

impl Beam<'_> {
    /// The shortest accepted path to the goal, if the beam finds one of at most `depth` actions.
    pub fn search(
        &mut self,
        initial: State<f32>,
        depth: usize,
        accept: impl Fn(&[Action]) -> bool,
    ) -> Option<Vec<Action>> {
        let mut beam = vec![initial];
        let mut origins: Vec<Vec<_>> = Vec::new();
        let (mut children, mut order) = (Vec::new(), Vec::new());
        let mut cells = HashSet::new();
        for _ in 0..depth {
            children.clear();
            order.clear();
            let mut goals = Vec::new();
            for action in Action::ALL {
                self.stepper.step(&beam, action, |parent, state, reached| {
                    let origin = (parent as u32, action);
                    if reached {
                        goals.push(origin);
                    } else {
                        order.push((self.values.at(&state), children.len() as u32));
                        children.push(Node { state, origin });
                    }
                });
            }
            let mut paths = goals.into_iter().map(|goal| path(&origins, goal));
            if let Some(path) = paths.find(|path| accept(path)) {
                return Some(path);
            }
            order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            cells.clear();
            beam.clear();
            let mut kept = Vec::new();
            for (_, child) in &order {
                let Node { state, origin } = children[*child as usize];
                let cell = coordinates(&state).map(|x| (x * self.fineness).round() as i32);
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
fn path(origins: &[Vec<(u32, Action)>], last: (u32, Action)) -> Vec<Action> {
    let (mut parent, action) = last;
    let mut actions = vec![action];
    for origins in origins.iter().rev() {
        let action;
        (parent, action) = origins[parent as usize];
        actions.push(action);
    }
    actions.reverse();
    actions
}
