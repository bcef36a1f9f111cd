//! Acrobot as a task: its tuned learner, and the loop over an episode. The other modules do not depend on it.

use core::f32::consts::PI;

use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::{Acrobot, Action, Fast, State, TimeLimit};

use crate::{
    Budget, Dimension, Error, Group, Learn, QLambda, Sarsa, Schedule, Settings, Symmetry, Table,
    TileCoder, Transition, displacement,
};

/// The values of Acrobot's actions, with `T` tilings and `S` slots, which take 8 bytes each.
pub type Values<'w, const S: usize, const T: usize> =
    crate::Values<'w, TileCoder<4, T>, S, 2, 4, T>;

/// Sarsa(λ) of Acrobot.
pub type Learner<'w, const S: usize, const T: usize> = Sarsa<'w, TileCoder<4, T>, S, 2, 4, T>;

/// Q(λ) with replay of Acrobot.
pub type Replayer<'w, const S: usize, const T: usize> = QLambda<'w, TileCoder<4, T>, S, 2, 4, T>;

/// The aim for which the learner is tuned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// Swinging up after few episodes.
    Fast,
    /// The best policy after 10,000 episodes and more.
    Quality,
}

/// The tilings over pairs learn within few episodes: both angles, both velocities, and each angle with a velocity.
const PAIRS: [[usize; 2]; 4] = [[0, 1], [2, 3], [0, 2], [1, 3]];

impl Preset {
    /// A learner in this memory with `T` tilings, some of them over the pairs. Over the `budget` its step size and
    /// its exploration fall; after that it hardly changes.
    pub fn learner<const S: usize, const T: usize>(
        self,
        budget: Budget,
        weights: &mut [[f32; 2]; S],
    ) -> Result<Learner<'_, S, T>, Error> {
        let (tilings, lambda, alpha, epsilon) = match self {
            Self::Fast => (2, 0.93, 0.5, 0.005),
            Self::Quality => (1, 0.95, 0.7, 0.01),
        };
        let angle = Dimension::cyclic(-PI, PI, if S < 4096 { 6 } else { 7 });
        let velocities = [1.25 * PI, 2.5 * PI].map(|bound| Dimension::bounded(-bound, bound, 6));
        let dimensions = [angle, angle, velocities[0], velocities[1]];
        let all = Group::new(&[0, 1, 2, 3], T.saturating_sub(4 * tilings));
        let [a, b, c, d] = PAIRS.each_ref().map(|pair| Group::new(pair, tilings));
        let groups = [all, a, b, c, d];
        let coder = TileCoder::new(dimensions, &groups, Table::Hashed(S), displacement)?;
        let falling = |start, end| Schedule {
            start,
            end,
            over: budget,
        };
        let settings = Settings {
            gamma: 1.0,
            lambda,
            alpha: falling(alpha, 0.01),
            epsilon: falling(epsilon, 0.0),
            symmetry: Symmetry::Mirror(2),
        };
        Sarsa::new(coder, settings, weights)
    }
}

/// All triples, which the replaying learner adds to the pairs.
const TRIPLES: [[usize; 3]; 4] = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];

/// Q(λ) in this memory, for the best policy after few steps: replay takes more time, and each step teaches more.
/// A third of the `T` tilings is over all dimensions, a third over triples and the rest over pairs. Over the `budget`
/// its step size and its exploration fall; after that it hardly changes.
pub fn replayer<'w, const S: usize, const T: usize>(
    budget: Budget,
    weights: &'w mut [[f32; 2]; S],
    memory: &'w mut [Transition<4>],
) -> Result<Replayer<'w, S, T>, Error> {
    let dimensions = [
        Dimension::cyclic(-PI, PI, 8),
        Dimension::cyclic(-PI, PI, 10),
        Dimension::bounded(-PI, PI, 4),
        Dimension::bounded(-2.0 * PI, 2.0 * PI, 8),
    ];
    let (pair, triple) = (T / 14, T / 11);
    let all = Group::new(
        &[0, 1, 2, 3],
        T.saturating_sub(PAIRS.len() * pair + TRIPLES.len() * triple),
    );
    let [a, b, c, d] = PAIRS
        .each_ref()
        .map(|dimensions| Group::new(dimensions, pair));
    let [e, f, g, h] = TRIPLES
        .each_ref()
        .map(|dimensions| Group::new(dimensions, triple));
    let groups = [all, a, b, c, d, e, f, g, h];
    let coder = TileCoder::new(dimensions, &groups, Table::Hashed(S), displacement)?;
    let falling = |start, end| Schedule {
        start,
        end,
        over: budget,
    };
    let settings = Settings {
        gamma: 1.0,
        lambda: 0.95,
        alpha: falling(0.3, 0.005),
        epsilon: Schedule::constant(0.0),
        symmetry: Symmetry::Mirror(2),
    };
    QLambda::new(coder, settings, weights, memory)
}

/// The torque of the learner's actions 0 and 1. It has no action without torque, which would gain nothing.
pub fn torque(action: usize) -> Action {
    match action {
        0 => Action::Negative,
        _ => Action::Positive,
    }
}

/// An acrobot with at most 500 steps per episode.
pub type Env = TimeLimit<Acrobot<Fast>>;

/// The acrobot that every program trains with this seed, and the generator of the learner's choices.
pub fn training(seed: SeedSequence) -> (Env, Pcg64) {
    let choices = seed.child(0).into();
    (TimeLimit::v1(Acrobot::with_rng(seed.into())), choices)
}

/// An acrobot with other initial states than [`training`] with this seed.
pub fn evaluation(seed: &SeedSequence) -> Env {
    TimeLimit::v1(Acrobot::with_rng(seed.child(1).into()))
}

/// A state as the learner sees it: \[θ1, θ2, θ̇1, θ̇1 + θ̇2\] in rad and rad/s. Link 2's velocity in space tells more
/// about it than the velocity of its joint.
pub fn view(state: &State<f32>) -> [f32; 4] {
    let [theta1, theta2, dtheta1, dtheta2] = (*state).into();
    [theta1, theta2, dtheta1, dtheta1 + dtheta2]
}

/// The action that the learner values most.
pub fn greedy<const S: usize, const T: usize>(
    values: &Values<'_, S, T>,
    state: &State<f32>,
) -> Action {
    torque(values.greedy(&view(state)))
}

/// Learns for one episode from a new initial state. Returns the sum of the rewards.
pub fn learn(learner: &mut impl Learn<4>, env: &mut Env, choices: &mut Pcg64) -> f32 {
    env.reset();
    let mut action = learner.start(&view(&env.inner().state()), choices);
    let mut sum = 0.0;
    loop {
        let step = env.step(torque(action));
        sum += step.reward;
        if step.terminated {
            learner.end(step.reward);
            return sum;
        }
        action = learner.step(step.reward, &view(&env.inner().state()), choices);
        if step.truncated {
            learner.cut();
            return sum;
        }
    }
}

/// Plays an episode from a new initial state. Returns the sum of the rewards and whether the goal was reached.
pub fn play(env: &mut Env, mut policy: impl FnMut(&State<f32>) -> Action) -> (f32, bool) {
    env.reset();
    let mut sum = 0.0;
    loop {
        let step = env.step(policy(&env.inner().state()));
        sum += step.reward;
        if step.done() {
            return (sum, step.terminated);
        }
    }
}
