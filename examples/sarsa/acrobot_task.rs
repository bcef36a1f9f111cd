//! Acrobot as a task for the learner: included by each program that has both, as `mod acrobot_task`.

use core::f32::consts::PI;

use acrobot::{Acrobot, Action, Fast, Pcg64, SeedSequence, TimeLimit};
use sarsa::{
    Dimension, Error, Group, Sarsa, Schedule, Settings, Symmetry, Table, TileCoder, displacement,
};

/// A learner of Acrobot with `T` tilings and `S` slots, which take 8 bytes each.
pub type Learner<'w, const S: usize, const T: usize> = Sarsa<'w, TileCoder<4, T>, S, 2, 4, T>;

/// What the learner is to be good at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// Swinging up after few episodes.
    Fast,
    /// The best policy after 10,000 episodes and more.
    Quality,
}

/// What an angle shares with its velocity or with the other angle is learnt over pairs, within few episodes.
const PAIRS: [[usize; 2]; 4] = [[0, 1], [2, 3], [0, 2], [1, 3]];

impl Preset {
    /// A learner in this memory, with `T` tilings, of which some go to the pairs.
    pub fn learner<const S: usize, const T: usize>(
        self,
        weights: &mut [[f32; 2]; S],
    ) -> Result<Learner<'_, S, T>, Error> {
        let (tilings, alpha, epsilon) = match self {
            Self::Fast => (2, falling(0.5, 0.999, 0.02), falling(0.005, 0.9995, 0.0)),
            Self::Quality => (1, falling(0.5, 0.9997, 0.01), falling(0.01, 0.9998, 0.0)),
        };
        let angle = Dimension::cyclic(-PI, PI, if S < 8192 { 6 } else { 7 });
        let velocities = [PI, 2.5 * PI].map(|bound| Dimension::bounded(-bound, bound, 6));
        let dimensions = [angle, angle, velocities[0], velocities[1]];
        let all = Group::new(&[0, 1, 2, 3], T.saturating_sub(4 * tilings));
        let [a, b, c, d] = PAIRS.each_ref().map(|pair| Group::new(pair, tilings));
        let groups = [all, a, b, c, d];
        let coder = TileCoder::new(dimensions, &groups, Table::Hashed(S), displacement)?;
        let settings = Settings {
            gamma: 1.0,
            lambda: 0.95,
            alpha,
            epsilon,
            symmetry: Symmetry::Mirror(2),
        };
        Sarsa::new(coder, settings, weights)
    }
}

const fn falling(start: f32, factor: f32, floor: f32) -> Schedule {
    Schedule {
        start,
        factor,
        floor,
    }
}

/// The learner's actions 0 and 1: without torque nothing is gained.
pub fn torque(action: usize) -> Action {
    match action {
        0 => Action::Negative,
        _ => Action::Positive,
    }
}

/// An acrobot with 500 steps an episode.
pub type Env = TimeLimit<Acrobot<Fast>>;

/// What a training with this seed uses everywhere: the acrobot of that seed, and a generator for the
/// learner's own choices.
pub fn training(seed: SeedSequence) -> (Env, Pcg64) {
    let choices = Pcg64::new(seed.child(0));
    (TimeLimit::v1(Acrobot::new(seed)), choices)
}

/// An acrobot with starts that [`training`] with this seed does not have.
pub fn evaluation(seed: &SeedSequence) -> Env {
    TimeLimit::v1(Acrobot::new(seed.child(1)))
}

/// The state as the learner sees it, \[θ1, θ2, θ̇1, θ̇2\] in rad and rad/s.
pub fn state(env: &Env) -> [f32; 4] {
    env.inner().state().into()
}

/// Learns in one episode from a new start, and returns the sum of the rewards.
pub fn learn<const S: usize, const T: usize>(
    learner: &mut Learner<'_, S, T>,
    env: &mut Env,
    choices: &mut Pcg64,
) -> f32 {
    env.reset();
    let mut action = learner.start(&state(env), choices);
    let mut sum = 0.0;
    loop {
        let step = env.step(torque(action));
        sum += step.reward;
        if step.terminated {
            learner.end(step.reward);
            return sum;
        }
        action = learner.step(step.reward, &state(env), choices);
        if step.truncated {
            learner.cut();
            return sum;
        }
    }
}

/// Plays an episode from a new start: the sum of the rewards, and whether the goal was reached.
pub fn play(env: &mut Env, mut policy: impl FnMut(&[f32; 4]) -> Action) -> (f32, bool) {
    env.reset();
    let mut sum = 0.0;
    loop {
        let step = env.step(policy(&state(env)));
        sum += step.reward;
        if step.ended() {
            return (sum, step.terminated);
        }
    }
}
