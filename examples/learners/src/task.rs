//! Acrobot as a task: its tuned learners, and the loop over an episode. The other modules do not depend on it.

use core::f32::consts::PI;

use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::{Acrobot, Action, Fast, State, TimeLimit};

use crate::{
    Budget, Dimension, Error, Group, Learn, Schedule, Settings, Symmetry, Table, TileCoder,
    Transition, displacement,
};

/// The values of Acrobot's actions, with `T` tilings and `S` slots, which take 8 bytes each.
pub type Values<'w, const S: usize, const T: usize> =
    crate::Values<'w, TileCoder<4, T>, S, 2, 4, T>;

/// Sarsa(λ) of Acrobot.
pub type Sarsa<'w, const S: usize, const T: usize> = crate::Sarsa<'w, TileCoder<4, T>, S, 2, 4, T>;

/// Q(λ) with replay of Acrobot.
pub type QLambda<'w, const S: usize, const T: usize> =
    crate::QLambda<'w, TileCoder<4, T>, S, 2, 4, T>;

/// Groups of `tilings` in all: some over pairs, which learn within few episodes, some over triples,
/// and the others over all dimensions.
const fn groups(tilings: usize, pair: usize, triple: usize) -> [Group<'static>; 9] {
    [
        Group::new(&[0, 1, 2, 3], tilings.saturating_sub(4 * (pair + triple))),
        Group::new(&[0, 1], pair),
        Group::new(&[2, 3], pair),
        Group::new(&[0, 2], pair),
        Group::new(&[1, 3], pair),
        Group::new(&[0, 1, 2], triple),
        Group::new(&[0, 1, 3], triple),
        Group::new(&[0, 2, 3], triple),
        Group::new(&[1, 2, 3], triple),
    ]
}

/// Tilings with `intervals` of the angles and of the velocities, which they tell apart up to `reach` times π and 2π rad/s.
fn features<const S: usize, const T: usize>(
    intervals: [u16; 4],
    reach: f32,
    groups: &[Group],
) -> Result<TileCoder<4, T>, Error> {
    let velocity = |bound: f32, intervals| Dimension::bounded(-bound, bound, intervals);
    let dimensions = [
        Dimension::cyclic(-PI, PI, intervals[0]),
        Dimension::cyclic(-PI, PI, intervals[1]),
        velocity(reach * PI, intervals[2]),
        velocity(reach * 2.0 * PI, intervals[3]),
    ];
    TileCoder::new(dimensions, groups, Table::Hashed(S), displacement)
}

/// A number that falls to `end` over the `budget`.
const fn falling(start: f32, end: f32, over: Budget) -> Schedule {
    Schedule { start, end, over }
}

/// Sarsa(λ) with `T` tilings, tuned for few episodes. Over the `budget` its step size and its exploration fall; after that
/// it hardly changes.
pub fn sarsa<const S: usize, const T: usize>(
    budget: Budget,
    weights: &mut [[f32; 2]; S],
) -> Result<Sarsa<'_, S, T>, Error> {
    let angles = if S < 4096 { 6 } else { 7 };
    let settings = Settings {
        gamma: 1.0,
        lambda: 0.93,
        alpha: falling(0.5, 0.01, budget),
        epsilon: falling(0.005, 0.0, budget),
        symmetry: Symmetry::Mirror(2),
    };
    let features = features::<S, T>([angles, angles, 6, 6], 1.25, &groups(T, 2, 0))?;
    Sarsa::new(features, settings, weights)
}

/// Q(λ) with `T` tilings that replays the steps in its `memory`, tuned for the best policy after 100,000 steps. Over the
/// `budget` its step size falls; after that it hardly changes. The memory should hold more than the steps of an episode.
pub fn q_lambda<'w, const S: usize, const T: usize>(
    budget: Budget,
    weights: &'w mut [[f32; 2]; S],
    memory: &'w mut [Transition<4>],
) -> Result<QLambda<'w, S, T>, Error> {
    // Triples need more slots.
    let (intervals, groups) = if S < 2048 {
        ([6, 6, 5, 6], groups(T, 2, 0))
    } else {
        ([8, 10, 4, 8], groups(T, 3, 6))
    };
    let settings = Settings {
        gamma: 1.0,
        lambda: 0.95,
        alpha: falling(0.3, 0.005, budget),
        epsilon: Schedule::constant(0.0),
        symmetry: Symmetry::Mirror(2),
    };
    let features = features::<S, T>(intervals, 1.125, &groups)?;
    QLambda::new(features, settings, weights, memory)
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
    let mut action = learner.start(&view(&env.state()), choices);
    let mut sum = 0.0;
    loop {
        let step = env.step(torque(action));
        sum += step.reward;
        if step.terminated {
            learner.end(step.reward);
            return sum;
        }
        action = learner.step(step.reward, &view(&env.state()), choices);
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
        let step = env.step(policy(&env.state()));
        sum += step.reward;
        if step.done() {
            return (sum, step.terminated);
        }
    }
}
