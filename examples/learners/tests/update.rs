//! The update equals the textbook's, and learns the right values.

use learners::{
    Budget, Dimension, Features, Group, Learn as _, Sarsa, Schedule, Settings, Symmetry, Table,
    TileCoder, displacement,
};
use rand_core::Rng;
use rand_pcg::Pcg32;

const SETTINGS: Settings = Settings {
    gamma: 1.0,
    lambda: 0.9,
    alpha: Schedule::constant(0.5),
    epsilon: Schedule::constant(0.0),
    symmetry: Symmetry::None,
};

/// A ring of places and a bounded speed; 5 tilings over both, 2 over each.
fn coder() -> TileCoder<2, 9> {
    let dimensions = [
        Dimension::cyclic(-1.0, 1.0, 4),
        Dimension::bounded(-1.0, 1.0, 3),
    ];
    let groups = [
        Group::new(&[0, 1], 5),
        Group::new(&[0], 2),
        Group::new(&[1], 2),
    ];
    TileCoder::new(dimensions, &groups, Table::Direct, displacement).unwrap()
}

/// A step of a walk that three actions push, and that ends above a speed: the reward and the next state.
fn walk([x, v]: [f32; 2], action: usize, rng: &mut Pcg32) -> (f32, [f32; 2]) {
    let noise = (rng.next_u32() >> 8) as f32 / 16_777_216.0 - 0.5;
    let v = v + 0.1 * (action as f32 - 1.0) + 0.1 * noise;
    let x = x + 0.3 * v;
    let x = if x > 1.0 {
        x - 2.0
    } else if x < -1.0 {
        x + 2.0
    } else {
        x
    };
    (-1.0 - x, [x, v])
}

/// Sarsa(λ) with binary features and replacing traces, line by line as in the box of Sutton & Barto 12.7, with a
/// trace for every weight. Traces below 0.05 are cut.
struct Textbook {
    w: Vec<[f32; 3]>,
    z: Vec<[f32; 3]>,
}

impl Textbook {
    fn update(
        &mut self,
        settings: &Settings,
        reward: f32,
        (slots, action): ([u16; 9], usize),
        next: Option<([u16; 9], usize)>,
    ) {
        let q = |slots: [u16; 9], action: usize| {
            slots
                .iter()
                .map(|&i| self.w[usize::from(i)][action])
                .sum::<f32>()
        };
        for i in slots {
            self.z[usize::from(i)][action] = 1.0;
        }
        let target = next.map_or(reward, |(slots, action)| {
            reward + settings.gamma * q(slots, action)
        });
        let delta = target - q(slots, action);
        let step = settings.alpha.start / 9.0 * delta;
        for (w, z) in self.w.iter_mut().flatten().zip(self.z.iter_mut().flatten()) {
            *w += step * *z;
            *z *= settings.gamma * settings.lambda;
            if *z < 0.05 {
                *z = 0.0;
            }
        }
    }
}

/// Bit-identical, because each weight has the same additions in the same order: one in each step.
#[test]
fn the_weights_equal_those_of_the_textbook() {
    for (lambda, gamma) in [
        (0.0, 1.0),
        (0.5, 0.9),
        (0.9, 1.0),
        (0.95, 1.0),
        (0.95, 0.99),
    ] {
        let settings = Settings {
            lambda,
            gamma,
            epsilon: Schedule::constant(0.2),
            ..SETTINGS
        };
        let coder = coder();
        let mut weights = [[0.0; 3]; 128];
        let mut agent = Sarsa::new(coder.clone(), settings, &mut weights).unwrap();
        let mut textbook = Textbook {
            w: vec![[0.0; 3]; 128],
            z: vec![[0.0; 3]; 128],
        };
        let (mut rng, mut world) = (Pcg32::new(5, 1), Pcg32::new(6, 1));
        for _episode in 0..30 {
            let mut state = [0.2, 0.0];
            let mut action = agent.start(&state, &mut rng);
            textbook.z.fill([0.0; 3]);
            for step in 0..300 {
                let (reward, next) = walk(state, action, &mut world);
                let now = (coder.active(&state), action);
                if next[1].abs() > 1.0 {
                    agent.end(reward);
                    textbook.update(&settings, reward, now, None);
                    break;
                }
                let chosen = agent.step(reward, &next, &mut rng);
                textbook.update(&settings, reward, now, Some((coder.active(&next), chosen)));
                assert!(
                    textbook
                        .w
                        .iter()
                        .flatten()
                        .eq(agent.weights().iter().flatten()),
                    "λ = {lambda}, γ = {gamma}, step {step}"
                );
                (state, action) = (next, chosen);
            }
        }
        assert!(
            agent
                .weights()
                .iter()
                .flatten()
                .filter(|&&w| w != 0.0)
                .count()
                > 60
        );
    }
}

/// A corridor of five cells with a reward of −1 a step and the goal behind the last cell: q(cell, onward) = −Σ γᵏ
/// over the remaining steps, for every λ.
#[test]
fn values_count_the_remaining_steps_of_a_corridor() {
    /// Counts cells as integers, so that no comparison of floats decides the end.
    fn learn(gamma: f32, lambda: f32) -> [f32; 5] {
        let cells = [Dimension::cyclic(0.0, 5.0, 5)];
        let coder =
            TileCoder::<1, 1>::new(cells, &[Group::new(&[0], 1)], Table::Direct, displacement)
                .unwrap();
        let settings = Settings {
            gamma,
            lambda,
            ..SETTINGS
        };
        let mut weights = [[0.0; 2]; 5];
        let mut agent = Sarsa::new(coder, settings, &mut weights).unwrap();
        let mut rng = Pcg32::new(1, 1);
        for _episode in 0..200 {
            let mut cell = 0;
            let mut action = agent.start(&[0.5], &mut rng);
            loop {
                cell = if action == 1 {
                    cell + 1
                } else {
                    cell.max(1) - 1
                };
                if cell == 5 {
                    agent.end(-1.0);
                    break;
                }
                action = agent.step(-1.0, &[cell as f32 + 0.5], &mut rng);
            }
        }
        std::array::from_fn(|cell| agent.values(&[cell as f32 + 0.5])[1])
    }
    // Each visit halves the error, so only rounding remains.
    const TOLERANCE: f32 = 1e-5;
    for (gamma, expected) in [
        (1.0, [-5.0, -4.0, -3.0, -2.0, -1.0]),
        (0.5, [-1.9375, -1.875, -1.75, -1.5, -1.0]),
    ] {
        for lambda in [0.0, 0.5, 0.9] {
            for (value, expected) in learn(gamma, lambda).into_iter().zip(expected) {
                assert!(
                    (value - expected).abs() < TOLERANCE,
                    "γ = {gamma}, λ = {lambda}: {value}"
                );
            }
        }
    }
}

/// The same walk and its mirror image give opposite actions and equal weights.
#[test]
fn a_mirrored_walk_learns_equal_weights() {
    let play = |sign: f32| {
        let settings = Settings {
            symmetry: Symmetry::Mirror(1),
            epsilon: Schedule::constant(0.1),
            ..SETTINGS
        };
        let mut weights = [[0.0; 3]; 128];
        let mut agent = Sarsa::new(coder(), settings, &mut weights).unwrap();
        let (mut rng, mut world) = (Pcg32::new(7, 1), Pcg32::new(8, 1));
        let mut actions = Vec::new();
        let mut state = [0.3, 0.05];
        let mut action = agent.start(&state.map(|x| sign * x), &mut rng);
        for _ in 0..1000 {
            let seen = if sign > 0.0 { action } else { 2 - action };
            actions.push(seen);
            let (reward, next) = walk(state, seen, &mut world);
            state = [next[0], next[1].clamp(-1.0, 1.0)];
            action = agent.step(reward, &state.map(|x| sign * x), &mut rng);
            let mirrored = agent.values(&state.map(|x| -sign * x));
            let mut values = agent.values(&state.map(|x| sign * x));
            values.reverse();
            assert!(state[1] == 0.0 || values == mirrored);
        }
        (actions, weights)
    };
    assert_eq!(play(1.0), play(-1.0));
}

#[test]
fn schedules_change_linearly_and_stay_at_their_end() {
    let settings = Settings {
        alpha: Schedule {
            start: 0.5,
            end: 0.1,
            over: Budget::Episodes(4),
        },
        ..SETTINGS
    };
    let mut weights = [[0.0; 1]; 128];
    let mut agent = Sarsa::new(coder(), settings, &mut weights).unwrap();
    let mut rng = Pcg32::new(1, 1);
    let mut value = 0.0_f32;
    // One state with a reward of −1: an update keeps 1 − α of the error.
    for alpha in [0.5, 0.4, 0.3, 0.2, 0.1, 0.1] {
        agent.start(&[0.0, 0.0], &mut rng);
        agent.end(-1.0);
        value += alpha * (-1.0 - value);
        assert!(
            (agent.values(&[0.0, 0.0])[0] - value).abs() < 1e-6,
            "{alpha}"
        );
    }
}

/// A share ε of the actions is random, and a third of those is the greedy one of three.
#[test]
fn epsilon_is_the_share_of_random_actions() {
    const N: u32 = 100_000;
    for epsilon in [0.0, 0.3, 1.0] {
        let settings = Settings {
            epsilon: Schedule::constant(epsilon),
            ..SETTINGS
        };
        let mut weights = [[0.0; 3]; 128];
        let mut agent = Sarsa::new(coder(), settings, &mut weights).unwrap();
        let mut rng = Pcg32::new(4, 1);
        let mut counts = [0_u32; 3];
        for _ in 0..N {
            counts[agent.start(&[0.0, 0.0], &mut rng)] += 1;
        }
        let random = N as f32 * epsilon / 3.0;
        let expected = [N as f32 - 2.0 * random, random, random];
        for (count, expected) in counts.into_iter().zip(expected) {
            // Five standard deviations of this many draws; 0 where nothing is drawn.
            let tolerance = 5.0 * (N as f32 * epsilon * 0.25).sqrt();
            assert!(
                (count as f32 - expected).abs() <= tolerance,
                "ε = {epsilon}: {counts:?}"
            );
        }
    }
}
