//! The WebAssembly module of `acrobot-rs/policies`: the learner of `swing_up` in 64 KiB, and
//! perceptrons that were trained in Python. Each `Learner` or `Perceptron` of JavaScript has its
//! own instance.
//!
//! Longer data than numbers passes through a buffer: JavaScript writes seeds and policies, Rust
//! writes error texts, both write weights.

use std::cell::{Cell, RefCell};

use acrobot::State;
use acrobot::numpy::SeedSequence;
use acrobot::physics::Dynamics;
use learners::{Budget, Env, Memory64, QLambda, training};
use policy::Policy;

pub struct Training {
    learner: QLambda<'static, 6144, 52>,
    env: Env,
}

/// The longest data are perceptrons, of which one with 256 and 256 units has 273 KB.
const BUFFER_LEN: usize = 1 << 19;

thread_local! {
    static BUFFER: RefCell<[u8; BUFFER_LEN]> = const { RefCell::new([0; BUFFER_LEN]) };
    static PERCEPTRON: Cell<Option<Policy<'static, 256>>> = const { Cell::new(None) };
}

/// The address of the buffer, which JavaScript reads and writes between calls.
#[unsafe(no_mangle)]
pub extern "C" fn buffer() -> *const u8 {
    BUFFER.with(RefCell::as_ptr).cast()
}

/// Writes bytes into the buffer and returns their count.
fn write(bytes: impl IntoIterator<Item = u8>) -> usize {
    BUFFER.with_borrow_mut(|buffer| {
        let pairs = buffer.iter_mut().zip(bytes);
        pairs.map(|(to, byte)| *to = byte).count()
    })
}

/// Begins a training like that of `swing_up`. The seed is in the first `words` 32-bit words of the
/// buffer, the lowest word first, and after it `numbers` of the parameters, the dynamics last.
/// Returns `None` if an acrobot rejects these. An instance calls this once, because a learner keeps
/// its memory.
#[unsafe(no_mangle)]
pub extern "C" fn begin(episodes: u32, words: usize, numbers: usize) -> Option<Box<Training>> {
    let given: Vec<_> = BUFFER.with_borrow(|buffer| {
        let words = buffer.as_chunks().0.iter().take(words + numbers);
        words.copied().map(u32::from_le_bytes).collect()
    });
    let (seed, numbers) = given.split_at_checked(words)?;
    let mut env = training(SeedSequence::from_words(seed));
    let mut params = *env.params();
    for (number, word) in params.numbers_mut().into_iter().zip(numbers) {
        *number = f32::from_bits(*word);
    }
    if numbers.last().is_some_and(|dynamics| *dynamics != 0) {
        params.dynamics = Dynamics::Nips;
    }
    env.inner_mut().set_params(params).ok()?;
    let memory = Box::leak(Box::new(Memory64::EMPTY));
    let learner = QLambda::new(Budget::Episodes(episodes), memory);
    Some(Box::new(Training { learner, env }))
}

/// Trains for one episode. Returns its return.
#[unsafe(no_mangle)]
pub extern "C" fn train(training: &mut Training) -> f32 {
    training.learner.learn(&mut training.env)
}

/// Writes the weights into the buffer, as `swing_up --save` does, and returns their length.
#[unsafe(no_mangle)]
pub extern "C" fn save(training: &Training) -> usize {
    write(training.learner.save())
}

/// Loads weights from the first `len` bytes of the buffer. Returns 0, or, if they are rejected, the
/// length of the reason in the buffer. Then the weights do not change.
#[unsafe(no_mangle)]
pub extern "C" fn load(training: &mut Training, len: usize) -> usize {
    let loaded = BUFFER.with_borrow(|buffer| training.learner.load(buffer.get(..len)?).err());
    loaded.map_or(0, |error| write(error.message().bytes()))
}

/// The length of the weights.
#[unsafe(no_mangle)]
pub extern "C" fn weights_len() -> usize {
    QLambda::<6144, 52>::BYTES
}

/// The learnt policy's action in a state.
#[unsafe(no_mangle)]
pub extern "C" fn act(
    training: &Training,
    theta1: f32,
    theta2: f32,
    dtheta1: f32,
    dtheta2: f32,
) -> u8 {
    training.learner.greedy(&State::from([theta1, theta2, dtheta1, dtheta2])).into()
}

/// Takes the policy in the first `len` bytes of the buffer. Returns as `load`. An instance calls
/// this once, because it keeps the memory.
#[unsafe(no_mangle)]
pub extern "C" fn load_perceptron(len: usize) -> usize {
    let file = BUFFER.with_borrow(|buffer| buffer.get(..len).map(<[u8]>::to_vec));
    match Policy::new(file.unwrap_or_default().leak()) {
        Ok(policy) => {
            PERCEPTRON.set(Some(policy));
            0
        }
        Err(error) => write(error.message().bytes()),
    }
}

/// The policy's action for the six numbers of an observation.
#[unsafe(no_mangle)]
pub extern "C" fn act_perceptron(a: f32, b: f32, c: f32, d: f32, e: f32, f: f32) -> u8 {
    PERCEPTRON.get().map_or(1, |policy| policy.action(&[a, b, c, d, e, f]).into())
}
