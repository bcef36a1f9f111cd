//! Q(λ) with replay equals its definition, and learns the right values.

use learners::{
    Dimension, Features, Group, Learn as _, QLambda, Schedule, Settings, Symmetry, Table,
    TileCoder, Transition, displacement,
};
use rand_core::Rng;
use rand_pcg::Pcg32;

const SETTINGS: Settings = Settings {
    gamma: 0.95,
    lambda: 0.9,
    alpha: Schedule::constant(0.5),
    epsilon: Schedule::constant(0.3),
    symmetry: Symmetry::None,
};

fn coder() -> TileCoder<1, 4> {
    let line = [Dimension::bounded(0.0, 1.0, 6)];
    TileCoder::new(line, &[Group::new(&[0], 4)], Table::Direct, displacement).unwrap()
}

/// A step of an episode: the state, the action, its reward and whether the next state is the goal. Without an action
/// it is the state in which the episode was truncated.
type Step = (f32, Option<(usize, f32, bool)>);

/// The λ-returns of Watkins's Q(λ) (Sutton & Barto 12.10), from the last of these steps to the first. The weight of
/// each return is written out: where the next action is greedy, 1 − λ for its value and λ for its return.
fn learn(w: &mut [[f64; 2]], steps: &[Step], settings: &Settings) {
    let [gamma, lambda, alpha] =
        [settings.gamma, settings.lambda, settings.alpha.start].map(f64::from);
    let coder = coder();
    let q = |w: &[[f64; 2]], state: f32, action: usize| -> f64 {
        let slots = coder.active(&[state]);
        slots.iter().map(|&slot| w[usize::from(slot)][action]).sum()
    };
    let highest = |w: &[[f64; 2]], state: f32| q(w, state, 0).max(q(w, state, 1));
    // The return of the next step, and whether its action was greedy before it was learnt from.
    let mut next: Option<(f64, bool)> = None;
    for (place, &(state, taken)) in steps.iter().enumerate().rev() {
        let Some((action, reward, is_goal)) = taken else {
            next = None;
            continue;
        };
        let target = match (is_goal, next) {
            (true, _) => f64::from(reward),
            (false, Some((following, true))) => {
                let value = highest(w, steps[place + 1].0);
                f64::from(reward) + gamma * ((1.0 - lambda) * value + lambda * following)
            }
            (false, _) => f64::from(reward) + gamma * highest(w, steps[place + 1].0),
        };
        let other = q(w, state, 1 - action);
        let value = q(w, state, action);
        // Of equal values the first is greedy.
        let is_greedy = value > other || value == other && action == 0;
        for slot in coder.active(&[state]) {
            w[usize::from(slot)][action] += alpha / 4.0 * (target - value);
        }
        next = Some((target, is_greedy));
    }
}

/// A walk on a line to 1, which one action prefers. Some episodes are truncated.
#[test]
fn the_weights_equal_those_of_the_definition() {
    const MEMORY: usize = 60;
    for lambda in [0.0, 0.7, 1.0] {
        let settings = Settings { lambda, ..SETTINGS };
        let mut weights = [[0.0; 2]; 28];
        let mut memory = [Transition::EMPTY; MEMORY];
        let mut agent = QLambda::new(coder(), settings, &mut weights, &mut memory).unwrap();
        let mut expected = [[0.0; 2]; 28];
        let mut steps: Vec<Step> = Vec::new();
        let (mut rng, mut world) = (Pcg32::new(5, 1), Pcg32::new(6, 1));
        let mut ends = [0; 2];
        for episode in 0..60 {
            let mut x = 0.5_f32;
            let mut action = agent.start(&[x], &mut rng);
            for step in 0.. {
                let noise = (world.next_u32() >> 8) as f32 / 16_777_216.0 - 0.5;
                let moved = (x + 0.2 * noise + [-0.02, 0.06][action]).max(0.0);
                let reward = -1.0 - moved;
                let is_goal = moved > 1.0;
                steps.push((x, Some((action, reward, is_goal))));
                if is_goal {
                    agent.end(reward);
                    ends[0] += 1;
                    break;
                }
                x = moved;
                action = agent.step(reward, &[x], &mut rng);
                if step == 25 {
                    agent.cut();
                    steps.push((x, None));
                    ends[1] += 1;
                    break;
                }
            }
            let latest = steps.len().saturating_sub(MEMORY);
            learn(&mut expected, &steps[latest..], &settings);
            for (w, expected) in agent
                .weights()
                .iter()
                .flatten()
                .zip(expected.iter().flatten())
            {
                let error = (f64::from(*w) - expected).abs();
                assert!(
                    error < 1e-3,
                    "λ = {lambda}, episode {episode}: {w} for {expected}"
                );
            }
        }
        assert!(ends[0] > 10 && ends[1] > 5, "{ends:?}");
    }
}

/// One episode of a corridor teaches every cell its distance to the goal, because returns are learnt backwards.
#[test]
fn an_episode_teaches_a_whole_corridor() {
    let cells = [Dimension::cyclic(0.0, 5.0, 5)];
    let coder =
        TileCoder::<1, 1>::new(cells, &[Group::new(&[0], 1)], Table::Direct, displacement).unwrap();
    let settings = Settings {
        gamma: 1.0,
        alpha: Schedule::constant(1.0),
        epsilon: Schedule::constant(0.0),
        ..SETTINGS
    };
    let mut weights = [[0.0; 1]; 5];
    let mut memory = [Transition::EMPTY; 5];
    let mut agent = QLambda::new(coder, settings, &mut weights, &mut memory).unwrap();
    let mut rng = Pcg32::new(1, 1);
    agent.start(&[0.5], &mut rng);
    for cell in 1..5 {
        agent.step(-1.0, &[cell as f32 + 0.5], &mut rng);
    }
    agent.end(-1.0);
    assert_eq!(*agent.weights(), [[-5.0], [-4.0], [-3.0], [-2.0], [-1.0]]);
}

#[test]
fn an_empty_memory_is_rejected() {
    let mut weights = [[7.0; 2]; 28];
    let error = QLambda::new(coder(), SETTINGS, &mut weights, &mut []).unwrap_err();
    assert_eq!(error.to_string(), "memory must be at least 1, got 0");
    assert_eq!(weights, [[7.0; 2]; 28]);
}
