//! The two learners, and a run of each in Sutton's simulator: the steps of each episode.

use std::f32::consts::PI;

use acrobot::{Pcg64, SeedSequence, State, uniform};
use sarsa::{
    Dimension, Error, Features, Group, Sarsa, Schedule, Settings, Symmetry, Table, TileCoder,
    displacement,
};

use super::simulator::{decide, is_goal};

/// Tiles of Sutton's learner: 12 tilings of 6×6×7×7, and all the smaller ones.
const TILES: usize = 25_028;

/// Sutton's, as published: 12 tilings over all four numbers, 3 over each three of them, 2 over each two and 3
/// over each one, without hashing and each offset at random. Velocities beyond half their bounds count
/// as half their bounds; a seventh interval of theirs gives the offset room.
pub fn sutton(seed: SeedSequence, episodes: usize) -> Result<Vec<u32>, Error> {
    const SUBSETS: [(&[usize], usize); 15] = [
        (&[0, 1, 2, 3], 12),
        (&[0, 1, 2], 3),
        (&[0, 1, 3], 3),
        (&[0, 2, 3], 3),
        (&[1, 2, 3], 3),
        (&[0, 1], 2),
        (&[0, 2], 2),
        (&[0, 3], 2),
        (&[1, 2], 2),
        (&[1, 3], 2),
        (&[2, 3], 2),
        (&[0], 3),
        (&[1], 3),
        (&[2], 3),
        (&[3], 3),
    ];
    let groups = SUBSETS.map(|(dimensions, tilings)| Group::new(dimensions, tilings));
    let angle = Dimension::cyclic(-PI, PI, 6);
    let [velocity1, velocity2] =
        [2.0 * PI, 4.5 * PI].map(|bound| Dimension::bounded(-bound, bound, 6));
    let mut random = Pcg64::new(seed);
    let coder = TileCoder::<4, 48>::new(
        [angle, angle, velocity1, velocity2],
        &groups,
        Table::Direct,
        |_| fraction(&mut random),
    )?;
    let settings = Settings {
        gamma: 1.0,
        lambda: 0.9,
        alpha: Schedule::constant(0.2),
        epsilon: Schedule::constant(0.0),
        symmetry: Symmetry::None,
    };
    let mut weights = zeros::<3, TILES>();
    let learner = Sarsa::new(coder, settings, &mut weights)?;
    Ok(learn(learner, [-1.0, 0.0, 1.0], &mut random, episodes))
}

/// This crate's: fewer tilings, offset evenly against each other, of slower velocities; one side of the mirror;
/// no action without torque; some exploration at first.
///
/// With λ = 0.9, as Sutton has it, the median run settles for some 80 steps in place of 65. The rest
/// changes the speed of learning, and the steps in the end by some two.
pub fn ours(seed: SeedSequence, episodes: usize) -> Result<Vec<u32>, Error> {
    let groups = [
        Group::new(&[0, 1, 2, 3], 12),
        Group::new(&[0, 1], 2),
        Group::new(&[2, 3], 2),
        Group::new(&[0, 2], 2),
        Group::new(&[1, 3], 2),
    ];
    let angle = Dimension::cyclic(-PI, PI, 7);
    let [velocity1, velocity2] =
        [1.25 * PI, 2.5 * PI].map(|bound| Dimension::bounded(-bound, bound, 6));
    let coder = TileCoder::<4, 20>::new(
        [angle, angle, velocity1, velocity2],
        &groups,
        Table::Direct,
        displacement,
    )?;
    let settings = Settings {
        gamma: 1.0,
        lambda: 0.8,
        alpha: Schedule::constant(0.3),
        epsilon: Schedule {
            start: 0.01,
            end: 0.0,
            episodes: 100,
        },
        symmetry: Symmetry::Mirror(2),
    };
    /// 12 tilings of 7⁴, and of the pairs twice 7² four times.
    const TILES: usize = 29_204;
    let mut weights = zeros::<2, TILES>();
    let learner = Sarsa::new(coder, settings, &mut weights)?;
    Ok(learn(learner, [-1.0, 1.0], &mut Pcg64::new(seed), episodes))
}

/// A random offset, in intervals from 0 to below 1.
fn fraction(random: &mut Pcg64) -> f32 {
    f32::from(uniform(random, 0.0, 65536.0) as u16) / 65536.0
}

fn zeros<const A: usize, const S: usize>() -> Box<[[f32; A]; S]> {
    let weights = vec![[0.0; A]; S].into_boxed_slice();
    weights.try_into().expect("as many as were made")
}

/// Learns from rest to the goal, in every episode anew.
fn learn<F: Features<4, T>, const S: usize, const A: usize, const T: usize>(
    mut learner: Sarsa<F, S, A, 4, T>,
    torques: [f64; A],
    random: &mut Pcg64,
    episodes: usize,
) -> Vec<u32> {
    let episode = |_| {
        let mut state = State::default();
        let mut action = learner.start(&state.cast().into(), random);
        let mut steps = 0;
        loop {
            steps += 1;
            state = decide(state, torques[action]);
            if is_goal(&state) {
                learner.end(-1.0);
                return steps;
            }
            action = learner.step(-1.0, &state.cast().into(), random);
        }
    };
    (0..episodes).map(episode).collect()
}
