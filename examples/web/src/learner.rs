//! The learner of `swing_up` with its 64 KiB of weights. A worker's instance of the module trains, and the page's
//! instance plays the learnt policy.

use core::fmt::{self, Write};

use acrobot::numpy::Pcg64;
use acrobot::{Action, State};
use sarsa::{Budget, LoadError};
use sarsa::task::{self, Env, Preset, greedy, learn, training};

use crate::memory::{BUFFER, Shared};
use crate::once::Once;
use crate::simulation;

const SLOTS: usize = 8192;
type Memory = Once<[[f32; 2]; SLOTS]>;
type Learner = task::Learner<'static, SLOTS, 28>;

const fn memory() -> Memory {
    Once::new([[0.0; 2]; SLOTS])
}

/// An untrained learner, or `None` if its memory is already in use.
fn learner(preset: Preset, episodes: u32, memory: &'static Memory) -> Option<Learner> {
    preset.learner(Budget::Episodes(episodes), memory.take()?).ok()
}

static TRAINING: Shared<Option<(Learner, Env, Pcg64)>> = Shared::new(None);

/// Begins a training like that of `swing_up`, with the seed in the buffer and the preset `fast`, or `quality` if that is not
/// 0. Returns false if this instance has begun a training before, because it has memory for only one.
#[unsafe(no_mangle)]
pub extern "C" fn begin_training(quality: u32, episodes: u32, words: usize) -> bool {
    static WEIGHTS: Memory = memory();
    let preset = if quality != 0 {
        Preset::Quality
    } else {
        Preset::Fast
    };
    let Some(learner) = learner(preset, episodes, &WEIGHTS) else {
        return false;
    };
    let (env, choices) = training(simulation::seed_in_buffer(words));
    *TRAINING.borrow() = Some((learner, env, choices));
    true
}

/// Trains for one episode. Returns its return, or NaN if no training has begun.
#[unsafe(no_mangle)]
pub extern "C" fn train() -> f32 {
    match &mut *TRAINING.borrow() {
        Some((learner, env, choices)) => learn(learner, env, choices),
        None => f32::NAN,
    }
}

/// Writes the training's weights into the buffer, in the format of `swing_up --save`. Returns the number of bytes, which is
/// 0 if no training has begun.
#[unsafe(no_mangle)]
pub extern "C" fn save() -> usize {
    let Some((learner, ..)) = &*TRAINING.borrow() else {
        return 0;
    };
    for (to, byte) in BUFFER.borrow().iter_mut().zip(learner.save()) {
        *to = byte;
    }
    Learner::BYTES
}

/// A learner for each preset, because presets have different weights. One of them plays.
struct Policy {
    presets: [Learner; 2],
    /// The learner that loaded weights last. It plays.
    last: usize,
}

static POLICY: Shared<Option<Policy>> = Shared::new(None);

impl Policy {
    /// Untrained learners, or `None` if their memory is already in use.
    fn new() -> Option<Self> {
        static FAST: Memory = memory();
        static QUALITY: Memory = memory();
        Some(Self {
            presets: [
                learner(Preset::Fast, 0, &FAST)?,
                learner(Preset::Quality, 0, &QUALITY)?,
            ],
            last: 0,
        })
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), LoadError> {
        let mut rejected = LoadError::Magic;
        for (number, learner) in self.presets.iter_mut().enumerate() {
            match learner.load(bytes) {
                Ok(()) => {
                    self.last = number;
                    return Ok(());
                }
                Err(error) => rejected = error,
            }
        }
        Err(rejected)
    }

    fn action(&self, state: &State<f32>) -> Action {
        let learner = self.presets.get(self.last);
        learner.map_or(Action::Zero, |learner| greedy(learner, state))
    }
}

/// Loads weights of either preset from the first `len` bytes of the buffer. Returns 0, or, if they are rejected, the length of
/// the reason in the buffer. Then the policy does not change.
#[unsafe(no_mangle)]
pub extern "C" fn load(len: usize) -> usize {
    let mut policy = POLICY.borrow();
    if policy.is_none() {
        *policy = Policy::new();
    }
    let mut buffer = BUFFER.borrow();
    let bytes = buffer.get(..len).unwrap_or_default();
    let loaded = policy.as_mut().map(|policy| policy.load(bytes));
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
    let action = policy.as_ref().map_or(Action::Zero, |policy| {
        simulation::with(|simulation| policy.action(&simulation.env.inner().state()))
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
