//! Loops that JavaScript times. They draw random actions and reset ended episodes.

use core::hint::black_box;

use acrobot::batch::{Batch, Block, StepBuffers};
use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, TimeLimit};

/// A linear congruential generator, because it takes little time compared with a step.
struct Actions(u32);

impl Actions {
    fn draw(&mut self) -> u8 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (((self.0 >> 16) * 3) >> 16) as u8
    }
}

/// Steps one acrobot.
#[unsafe(no_mangle)]
pub extern "C" fn scalar_steps(steps: u32) {
    let mut actions = Actions(0);
    let mut env = TimeLimit::v1(Acrobot::<Fast>::new(0));
    for _ in 0..steps {
        let action = Action::try_from(actions.draw()).unwrap_or(Action::Zero);
        if black_box(env.step(action)).done() {
            env.reset();
        }
    }
}

/// The number of acrobots in the batch.
const LEN: usize = 1024;
const LANES: usize = if cfg!(target_feature = "simd128") {
    16
} else {
    1
};

/// Steps the batch.
#[unsafe(no_mangle)]
pub extern "C" fn batch_steps(steps: u32) {
    let mut blocks = [Block::EMPTY; LEN / LANES];
    let mut generators = [Pcg64::UNSEEDED; LEN];
    let batch = Batch::<Fast, _, LANES>::new(0, (&mut blocks[..], &mut generators[..]));
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
        let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated);
        if batch.step(&actions, buffers).is_err() {
            return;
        }
    }
}
