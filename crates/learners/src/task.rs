//! The episodes that every program trains on and plays.

use acrobot::numpy::SeedSequence;
use acrobot::{Acrobot, Action, Fast, State, TimeLimit};

/// An acrobot with at most 500 steps per episode.
pub type Env = TimeLimit<Acrobot<Fast>>;

/// The acrobot that every program trains with this seed.
pub fn training(seed: SeedSequence) -> Env {
    TimeLimit::with_task_limit(Acrobot::new(seed))
}

/// An acrobot with other initial states than [`training`] with this seed.
pub fn evaluation(seed: &SeedSequence) -> Env {
    TimeLimit::with_task_limit(Acrobot::new(seed.child(1)))
}

/// Plays an episode from a new initial state. Returns the sum of the rewards and whether the goal
/// was reached.
pub fn play(env: &mut Env, mut policy: impl FnMut(&State<f32>) -> Action) -> (f32, bool) {
    env.reset();
    let mut sum = 0.0;
    loop {
        let step = env.step(policy(&env.state()));
        sum += step.reward;
        if step.is_done() {
            return (sum, step.terminated);
        }
    }
}
