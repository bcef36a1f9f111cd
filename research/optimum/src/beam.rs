//! A beam search for the fewest steps to the goal.

use std::collections::HashSet;

use acrobot::arithmetic::Reference;
use acrobot::{Action, State};

use crate::sequences::reaches;
use crate::values::{Stepper, Values, coordinates};

/// Cells per rad and per rad/s. The beam follows only one state of each cell.
const FINENESS: f32 = 10.0;

/// The shortest path to the goal with the exact model, if a beam of at most `width` states finds
/// one of at most `depth` actions. An origin of a state is the place of its parent in the beam, and
/// the action.
pub fn search(values: &Values, width: usize, initial: State, depth: usize) -> Option<Vec<Action>> {
    let mut stepper = Stepper::default();
    let mut beam = vec![initial.cast()];
    let mut origins: Vec<Vec<_>> = Vec::new();
    for _ in 0..depth {
        let (mut children, mut goals) = (Vec::new(), Vec::new());
        for action in Action::ALL {
            stepper.step(&beam, action, |parent, state, reached| {
                let origin = (parent as u32, action);
                if reached {
                    goals.push(origin);
                } else {
                    children.push((values.at(&state), state, origin));
                }
            });
        }
        let mut paths = goals.into_iter().map(|goal| path(&origins, goal));
        if let Some(path) = paths.find(|path| reaches::<Reference>(initial, path)) {
            return Some(path);
        }
        // Stable, so that equal values keep their order.
        children.sort_by(|(a, ..), (b, ..)| a.total_cmp(b));
        let mut cells = HashSet::new();
        let cell = |state: &_| coordinates(state).map(|x| (x * FINENESS).round() as i32);
        let kept = children.into_iter().map(|(_, state, origin)| (state, origin));
        let kept = kept.filter(|(state, _)| cells.insert(cell(state)));
        let origins_of_beam;
        (beam, origins_of_beam) = kept.take(width).unzip();
        origins.push(origins_of_beam);
    }
    None
}

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
