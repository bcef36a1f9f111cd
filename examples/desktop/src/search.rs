//! A beam search on the exact model, small enough for a microcontroller.
//!
//! Every step ahead tries both actions in each of the beam's eight states, and keeps the eight new
//! states that the learner values most. The search ends at the first path to the goal, because no
//! later one is shorter. The acrobot follows the path until the search finds a shorter one.
//!
//! Looking a few steps ahead is worse than not planning: a search finds states off the policy's own
//! paths, along which values are learnt, whose values are too high. From about ten steps on, true
//! rewards outweigh that. Thirty steps give nearly all of the gain, and sixty 0.2 steps more.

use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, State};

/// The width of the beam: states that are followed at the same time.
const BEAM: usize = 8;

#[derive(Debug)]
pub struct Search {
    model: Acrobot<Fast>,
    /// The followed states, and the new states that each action leads to.
    beam: [Node; 2 * BEAM],
    /// The shortest known path to the goal from the state of the next choice.
    plan: Option<Path>,
}

/// The actions that the search tries, as bits.
const ACTIONS: [Action; 2] = [Action::Negative, Action::Positive];

/// Actions, the first in the lowest bit.
#[derive(Clone, Copy, Debug, Default)]
struct Path {
    actions: u128,
    len: u32,
}

impl Path {
    fn then(self, action: usize) -> Self {
        Self { actions: self.actions | (action as u128) << self.len, len: self.len + 1 }
    }

    fn first(self) -> Action {
        ACTIONS[(self.actions & 1) as usize]
    }

    /// The actions after the first.
    fn rest(self) -> Option<Self> {
        (self.len > 1).then(|| Self { actions: self.actions >> 1, len: self.len - 1 })
    }
}

/// A reachable state, the path there, and the estimated value of the remaining steps.
#[derive(Clone, Copy, Debug, Default)]
struct Node {
    state: State<f32>,
    path: Path,
    value: f32,
}

impl Default for Search {
    fn default() -> Self {
        Self {
            model: Acrobot::hanging(Pcg64::UNSEEDED),
            beam: [Node::default(); 2 * BEAM],
            plan: None,
        }
    }
}

impl Search {
    /// The first action of the best path found now or before, of up to `depth` actions. `value`
    /// estimates the negative number of steps from a state to the goal.
    pub fn choose(
        &mut self,
        state: State<f32>,
        depth: u32,
        value: impl Fn(&State<f32>) -> f32,
    ) -> Action {
        let (found, is_goal) = self.best(state, depth, value);
        if is_goal && self.plan.is_none_or(|plan| found.len < plan.len) {
            self.plan = Some(found);
        }
        let path = self.plan.unwrap_or(found);
        self.plan = self.plan.and_then(Path::rest);
        path.first()
    }

    /// The best path of up to `depth` actions, and whether it ends in the goal.
    fn best(
        &mut self,
        state: State<f32>,
        depth: u32,
        value: impl Fn(&State<f32>) -> f32,
    ) -> (Path, bool) {
        self.beam[0] = Node { state, ..Node::default() };
        let mut followed = 1;
        for _ in 0..depth {
            let from = self.beam;
            let children = 2 * followed;
            for (child, node) in self.beam.iter_mut().enumerate().take(children) {
                let (parent, action) = (from[child / 2], child % 2);
                self.model.set_state(parent.state).expect("a finite state");
                let step = self.model.step(ACTIONS[action]);
                node.path = parent.path.then(action);
                if step.terminated {
                    return (node.path, true);
                }
                node.state = self.model.state();
                node.value = value(&node.state);
            }
            self.beam[..children].sort_unstable_by(|a, b| b.value.total_cmp(&a.value));
            followed = children.min(BEAM);
        }
        (self.beam[0].path, false)
    }
}

#[cfg(test)]
mod tests {
    use acrobot::numpy::SeedSequence;
    use learners::{Budget, Memory64, QLambda, training};

    use super::*;
    use crate::evaluate;

    #[test]
    fn planning_beats_the_learnt_policy_within_fixed_memory() {
        let seed = SeedSequence::new(42);
        let mut memory = Memory64::EMPTY;
        let mut learner = QLambda::new(Budget::Episodes(300), &mut memory);
        let mut env = training(seed.clone());
        for _ in 0..300 {
            learner.learn(&mut env);
        }
        let greedy = evaluate(&seed, 0..20, |state| learner.greedy(state)).mean;
        let mut search = Search::default();
        let choose = |state: &_| search.choose(*state, 30, |state| learner.value(state));
        let planned = evaluate(&seed, 0..20, choose).mean;
        // After 300 episodes the values are coarse.
        assert!(planned > -72.0 && planned > greedy + 5.0, "{planned}");
        assert!(size_of::<Search>() <= 4096);
    }
}
