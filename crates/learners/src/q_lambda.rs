//! Watkins's Q(λ) over whole episodes, from the last step to the first, with replay (Sutton & Barto
//! 12.10; Lin 1992).

use acrobot::physics::wrap;
use acrobot::{Action, State};

use crate::memory::{Memory, Next, Transition};
use crate::task::Env;
use crate::tiles::TileCoder;

/// The decay of a trace in a step. Rewards are not discounted: γ is 1.
const LAMBDA: f32 = 0.95;

/// α times the number of tilings, the share of an error that one update removes (Sutton & Barto
/// 9.6), in the first episode and after the budget. Together with the tilings it is tuned for the
/// best policy after 100,000 steps.
const ALPHA: [f32; 2] = [0.3, 0.005];

/// How long learning takes. The step size falls linearly over this time; after that the learner
/// hardly changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Budget {
    /// This many episodes.
    Episodes(u32),
    /// This many steps, and the rest of the episode in which they end.
    Steps(u32),
}

/// Learns after each episode from the latest steps in its memory, from the last one to the first,
/// so that a return is known before the step that led to it. The memory may hold several episodes,
/// or a part of one.
///
/// The learner has no action without torque. Weights start at 0, which is optimistic, because
/// rewards are negative. So it always takes the action with the highest value. A state and its
/// mirror image share their values.
#[derive(Debug)]
pub struct QLambda<'w, const S: usize, const T: usize> {
    pub(crate) tiles: TileCoder<S, T>,
    pub(crate) weights: &'w mut [[f32; 2]; S],
    /// A ring of the latest transitions.
    steps: &'w mut [Transition],
    /// The place after the latest transition.
    next: usize,
    budget: Budget,
    /// The part of the budget that has passed.
    passed: u32,
}

impl<'w, const S: usize, const T: usize> QLambda<'w, S, T> {
    /// An untrained learner. This empties the memory.
    pub fn new<const N: usize>(budget: Budget, memory: &'w mut Memory<S, T, N>) -> Self {
        const { assert!(N > 0, "the memory must hold a step") };
        memory.weights.fill([0.0; 2]);
        memory.steps.fill(Transition::EMPTY);
        Self {
            tiles: TileCoder::new(),
            weights: &mut memory.weights,
            steps: &mut memory.steps,
            next: 0,
            budget,
            passed: 0,
        }
    }

    /// The action with the highest value.
    #[must_use]
    pub fn greedy(&self, state: &State<f32>) -> Action {
        let (state, is_mirrored) = view(state);
        torque(self.best(&state).0, is_mirrored)
    }

    /// The value of the best action: the sum of the rewards to come.
    #[must_use]
    pub fn value(&self, state: &State<f32>) -> f32 {
        self.best(&view(state).0).1
    }

    /// The weights: in each slot one for negative torque and one for positive, in units of the
    /// reward.
    #[must_use]
    pub fn weights(&self) -> &[[f32; 2]; S] {
        self.weights
    }

    /// Learns for one episode from a new initial state. Returns the sum of the rewards.
    pub fn learn(&mut self, env: &mut Env) -> f32 {
        env.reset();
        let mut sum = 0.0;
        loop {
            let (state, is_mirrored) = view(&env.state());
            let (positive, _) = self.best(&state);
            let step = env.step(torque(positive, is_mirrored));
            sum += step.reward;
            self.store(Transition {
                state,
                reward: step.reward,
                positive,
                next: if step.terminated { Next::Goal } else { Next::Step },
            });
            if step.truncated && !step.terminated {
                let (state, _) = view(&env.state());
                self.store(Transition { state, ..Transition::EMPTY });
            }
            if step.is_done() {
                break;
            }
        }
        self.replay();
        let passed = match self.budget {
            Budget::Episodes(_) => 1,
            Budget::Steps(_) => env.elapsed_steps(),
        };
        self.passed = self.passed.saturating_add(passed);
        sum
    }

    /// Stores the latest step in place of the oldest.
    fn store(&mut self, transition: Transition) {
        if self.next >= self.steps.len() {
            self.next = 0;
        }
        if let Some(oldest) = self.steps.get_mut(self.next) {
            *oldest = transition;
        }
        self.next += 1;
    }

    /// w ← w + α (G − q(S, A)) ∇q(S, A), from the last step to the first, where G is the λ-return:
    /// R + max q where the greedy policy would not take the next action, and R + (1 − λ) max q + λ
    /// G′ elsewhere.
    fn replay(&mut self) {
        let step_size = self.step_size();
        // The return from the state after a step, as the replay of that state left it.
        let mut following = 0.0;
        let (later, earlier) = self.steps.split_at(self.next.min(self.steps.len()));
        for step in later.iter().rev().chain(earlier.iter().rev()) {
            let slots = self.tiles.active(&step.state);
            let values = values(self.weights, &slots);
            let (greedy, value) = best(values);
            let target = match step.next {
                Next::Step => step.reward + following,
                Next::Goal => step.reward,
                Next::Unknown => {
                    following = value;
                    continue;
                }
            };
            let action = usize::from(step.positive);
            let change = step_size * (target - values[action]);
            for &slot in &slots {
                if let Some(weights) = self.weights.get_mut(usize::from(slot)) {
                    weights[action] += change;
                }
            }
            let (_, value) = best(self::values(self.weights, &slots));
            following =
                if step.positive == greedy { value + LAMBDA * (target - value) } else { value };
        }
    }

    /// α.
    fn step_size(&self) -> f32 {
        let (Budget::Episodes(all) | Budget::Steps(all)) = self.budget;
        let [start, end] = ALPHA;
        let alpha = if self.passed < all {
            start + (end - start) * (self.passed as f32 / all as f32)
        } else {
            end
        };
        alpha / T as f32
    }

    /// Whether the best action's torque is positive, and its value.
    fn best(&self, state: &[f32; 4]) -> (bool, f32) {
        best(values(self.weights, &self.tiles.active(state)))
    }
}

/// q̂(s, a, w) = Σ w of the active features.
#[inline]
fn values<const S: usize, const T: usize>(weights: &[[f32; 2]; S], slots: &[u16; T]) -> [f32; 2] {
    let mut values = [0.0; 2];
    for &slot in slots {
        if let Some(weights) = weights.get(usize::from(slot)) {
            values[0] += weights[0];
            values[1] += weights[1];
        }
    }
    values
}

/// Whether the action with the higher value has positive torque, and that value. Equal values
/// choose negative torque.
#[inline]
fn best([negative, positive]: [f32; 2]) -> (bool, f32) {
    if positive > negative { (true, positive) } else { (false, negative) }
}

/// A state as the learner sees it, \[θ1, θ2, θ̇1, θ̇1 + θ̇2\] in rad and rad/s, and whether it is
/// the mirror image, in which θ̇1 is not negative. Link 2's velocity in space tells more about it
/// than the velocity of its joint.
fn view(state: &State<f32>) -> ([f32; 4], bool) {
    let [theta1, theta2, dtheta1, dtheta2] = (*state).into();
    let [theta1, theta2] = [theta1, theta2].map(wrap);
    let seen = [theta1, theta2, dtheta1, dtheta1 + dtheta2];
    if dtheta1 < 0.0 { (seen.map(|x| -x), true) } else { (seen, false) }
}

/// The torque of an action that the learner chose in a state or in its mirror image.
fn torque(positive: bool, is_mirrored: bool) -> Action {
    if positive == is_mirrored { Action::Negative } else { Action::Positive }
}
