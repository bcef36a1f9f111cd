//! Q(λ) with replay equals its definition, and treats mirror images and whole turns alike.

use std::f32::consts::TAU;

use acrobot::{Acrobot, Action, State, TimeLimit};
use learners::{Budget, Memory, QLambda, TileCoder};

/// A step of an episode: the state, and the action, its reward and whether the next state is the
/// goal. Without an action it is the state in which the episode was truncated.
type Step = ([f32; 4], Option<(usize, f64, bool)>);

type Weights = [[f64; 2]; 1408];

/// The λ-returns of Watkins's Q(λ) (Sutton & Barto 12.10), from the last of these steps to the
/// first. The weight of each return is written out: where the next action is greedy, 1 − λ for its
/// value and λ for its return. Returns how many of the actions were not greedy.
fn replay(w: &mut Weights, steps: &[Step], alpha: f64) -> usize {
    const LAMBDA: f64 = 0.95;
    let tiles = TileCoder::<1408, 16>::new();
    let q = |w: &Weights, state: &[f32; 4], action: usize| -> f64 {
        let slots = tiles.active(state);
        slots.iter().map(|&slot| w[usize::from(slot)][action]).sum()
    };
    // The state after a step, the return from there, and whether its action was greedy before it
    // was learnt from.
    let mut next: Option<([f32; 4], f64, bool)> = None;
    let mut others = 0;
    for &(state, taken) in steps.iter().rev() {
        let Some((action, reward, is_goal)) = taken else {
            next = Some((state, 0.0, false));
            continue;
        };
        let following = match next {
            Some((state, following, is_greedy)) if !is_goal => {
                let highest = q(w, &state, 0).max(q(w, &state, 1));
                if is_greedy { (1.0 - LAMBDA) * highest + LAMBDA * following } else { highest }
            }
            _ => 0.0,
        };
        let (value, other) = (q(w, &state, action), q(w, &state, 1 - action));
        // Of equal values the first is greedy.
        let is_greedy = value > other || value == other && action == 0;
        others += usize::from(!is_greedy);
        let target = reward + following;
        for slot in tiles.active(&state) {
            w[usize::from(slot)][action] += alpha / 16.0 * (target - value);
        }
        next = Some((state, target, is_greedy));
    }
    others
}

/// What the learner sees: link 2's velocity in space, and the mirror image if θ̇1 is negative.
fn seen(state: State<f32>) -> [f32; 4] {
    let [theta1, theta2, dtheta1, dtheta2] = state.into();
    let sign = if dtheta1 < 0.0 { -1.0 } else { 1.0 };
    [theta1, theta2, dtheta1, dtheta1 + dtheta2].map(|x| sign * x)
}

/// The mirror image of a state, and in each angle one turn more or less. It has the same value, and
/// the opposite torque.
fn turned_mirror_image(state: State<f32>) -> State<f32> {
    let [theta1, theta2, dtheta1, dtheta2] = <[f32; 4]>::from(state).map(|x| -x);
    State::from([theta1 + TAU, theta2 - TAU, dtheta1, dtheta2])
}

/// Some episodes are truncated. The memory holds several episodes or a part of one, and each budget
/// ends within the training. The second learner gets the memory as the first one left it.
#[test]
fn the_weights_equal_those_of_the_definition() {
    const STEPS: usize = 150;
    let mut memory = Memory::<1408, 16, STEPS>::EMPTY;
    for budget in [Budget::Episodes(60), Budget::Steps(10_000)] {
        let mut learner = QLambda::new(budget, &mut memory);
        let mut env = TimeLimit::with_task_limit(Acrobot::new(5));
        let mut steps: Vec<Step> = Vec::new();
        let (mut goals, mut others, mut passed) = (0, 0, 0);
        for episode in 0..80 {
            let mut twin = env.clone();
            twin.reset();
            loop {
                let state = twin.state();
                let action = learner.greedy(&state);
                let step = twin.step(action);
                let is_positive = action == Action::Positive;
                let chosen = usize::from(is_positive == (state.dtheta1 >= 0.0));
                let taken = (chosen, step.reward.into(), step.terminated);
                steps.push((seen(state), Some(taken)));
                if step.terminated {
                    goals += 1;
                    break;
                }
                if step.truncated {
                    steps.push((seen(twin.state()), None));
                    break;
                }
            }
            let mut expected = learner.weights().map(|each| each.map(f64::from));
            let latest = steps.len().saturating_sub(STEPS);
            let (all, more) = match budget {
                Budget::Episodes(all) => (all, 1),
                Budget::Steps(all) => (all, twin.elapsed_steps()),
            };
            let share = f64::from(passed) / f64::from(all);
            let alpha = 0.3 + (0.005 - 0.3) * share.min(1.0);
            passed += more;
            others += replay(&mut expected, &steps[latest..], alpha);

            learner.learn(&mut env);
            assert_eq!(env.state(), twin.state());
            let [state, image] = [env.state(), turned_mirror_image(env.state())];
            assert_eq!(learner.value(&state), learner.value(&image));
            assert_ne!(learner.greedy(&state), learner.greedy(&image));
            let found = learner.weights().as_flattened();
            for (found, expected) in found.iter().zip(expected.as_flattened()) {
                let error = (f64::from(*found) - expected).abs();
                assert!(error < 1e-4, "episode {episode}: {found} for {expected}");
            }
        }
        assert!((20..60).contains(&goals) && others > 500, "{goals} {others}");
    }
}
