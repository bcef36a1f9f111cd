//! Loops to time: a random policy, with its actions drawn and its episodes reset within.

use core::hint::black_box;

use acrobot::{Acrobot, Action, Batch, Block, Fast, Observations, Output, Pcg64, TimeLimit};

/// A linear congruential generator that costs next to nothing beside a step.
struct Actions(u32);

impl Actions {
    fn draw(&mut self) -> u8 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (((self.0 >> 16) * 3) >> 16) as u8
    }
}

/// One acrobot for so many steps.
#[unsafe(no_mangle)]
pub extern "C" fn scalar_steps(steps: u32) {
    let mut actions = Actions(0);
    let mut env = TimeLimit::v1(Acrobot::<Fast>::new(0));
    for _ in 0..steps {
        let action = Action::try_from(actions.draw()).unwrap_or(Action::Zero);
        if black_box(env.step(action)).ended() {
            env.reset();
        }
    }
}

/// Acrobots of the batch.
const LEN: usize = 1024;
const LANES: usize = if cfg!(target_feature = "simd128") {
    16
} else {
    1
};

/// The batch for so many steps of each acrobot.
#[unsafe(no_mangle)]
pub extern "C" fn batch_steps(steps: u32) {
    let mut blocks = [Block::EMPTY; LEN / LANES];
    let mut generators = [Pcg64::UNSEEDED; LEN];
    let batch = Batch::<Fast, _, _, LANES>::new(0, &mut blocks[..], &mut generators[..]);
    let Ok(mut batch) = batch else {
        return;
    };
    let mut streams: [Actions; LEN] =
        core::array::from_fn(|i| Actions((i as u32).wrapping_mul(0x9e37_79b9)));
    let mut actions = [0; LEN];
    let (mut rewards, mut terminated, mut truncated) = ([0.0; LEN], [false; LEN], [false; LEN]);
    for _ in 0..steps {
        for (action, stream) in actions.iter_mut().zip(&mut streams) {
            *action = stream.draw();
        }
        let output = Output {
            rewards: &mut rewards,
            terminated: &mut terminated,
            truncated: &mut truncated,
            observations: Observations::None,
            final_observations: Observations::None,
        };
        if batch.step(&actions, output).is_err() {
            return;
        }
    }
}
