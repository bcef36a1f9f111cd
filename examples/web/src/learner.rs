//! The learner of `swing_up` in 64 KiB. A worker's instance of the module trains, and the page's instance plays the learnt
//! policy.

use core::fmt::{self, Write};

use acrobot::Action;
use learners::{Budget, Env, Memory64, QLambda, training};

use crate::memory::{BUFFER, Shared};
use crate::once::Once;
use crate::simulation;

type Learner = QLambda<'static, 6144, 52>;
type Memory = Once<Memory64>;

/// An untrained learner, or `None` if its memory is already in use.
fn untrained(episodes: u32, memory: &'static Memory) -> Option<Learner> {
    let memory = memory.take()?;
    Some(QLambda::new(Budget::Episodes(episodes), memory))
}

static TRAINING: Shared<Option<(Learner, Env)>> = Shared::new(None);

/// Begins a training like that of `swing_up`, with the seed in the buffer. Returns false if this instance has begun one
/// before, because it has memory for only one.
#[unsafe(no_mangle)]
pub extern "C" fn begin_training(episodes: u32, words: usize) -> bool {
    static MEMORY: Memory = Once::new(Memory64::EMPTY);
    let Some(learner) = untrained(episodes, &MEMORY) else {
        return false;
    };
    let env = training(simulation::seed_in_buffer(words));
    *TRAINING.borrow() = Some((learner, env));
    true
}

/// Trains for one episode. Returns its return, or NaN if no training has begun.
#[unsafe(no_mangle)]
pub extern "C" fn train() -> f32 {
    match &mut *TRAINING.borrow() {
        Some((learner, env)) => learner.learn(env),
        None => f32::NAN,
    }
}

/// Writes the training's weights into the buffer, in the format of `swing_up --save`. Returns the number of bytes, which is
/// 0 if no training has begun.
#[unsafe(no_mangle)]
pub extern "C" fn save() -> usize {
    let Some((learner, _)) = &*TRAINING.borrow() else {
        return 0;
    };
    for (to, byte) in BUFFER.borrow().iter_mut().zip(learner.save()) {
        *to = byte;
    }
    Learner::BYTES
}

static POLICY: Shared<Option<Learner>> = Shared::new(None);

/// Loads weights from the first `len` bytes of the buffer. Returns 0, or, if they are rejected, the length of the reason in
/// the buffer. Then the policy does not change.
#[unsafe(no_mangle)]
pub extern "C" fn load(len: usize) -> usize {
    static MEMORY: Memory = Once::new(Memory64::EMPTY);
    let mut policy = POLICY.borrow();
    if policy.is_none() {
        *policy = untrained(0, &MEMORY);
    }
    let mut buffer = BUFFER.borrow();
    let bytes = buffer.get(..len).unwrap_or_default();
    let loaded = policy.as_mut().map(|learner| learner.load(bytes));
    let Some(Err(error)) = loaded else {
        return 0;
    };
    let mut text = Text {
        bytes: &mut *buffer,
        len: 0,
    };
    // This cannot fail, because the buffer is a hundred times as long as the text.
    let _ = write!(text, "{error}");
    text.len
}

/// The action of the learnt policy. It applies no torque until weights are loaded.
#[unsafe(no_mangle)]
pub extern "C" fn learnt() -> u8 {
    let policy = POLICY.borrow();
    let action = policy.as_ref().map_or(Action::Zero, |learner| {
        simulation::with(|simulation| learner.greedy(&simulation.env.state()))
    });
    action.into()
}

/// Writes text into bytes. Fails if they are full.
struct Text<'a> {
    bytes: &'a mut [u8],
    len: usize,
}

impl Write for Text<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let end = self.len + text.len();
        let room = self.bytes.get_mut(self.len..end).ok_or(fmt::Error)?;
        room.copy_from_slice(text.as_bytes());
        self.len = end;
        Ok(())
    }
}
