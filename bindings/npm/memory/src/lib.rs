//! What the modules share: memory for what JavaScript keeps, and words to exchange values.

use std::alloc::{Layout, alloc, alloc_zeroed};
use std::cell::Cell;

use acrobot::numpy::SeedSequence;
use acrobot::physics::Dynamics;
use acrobot::{Error, Params};
use lol_alloc::{AssumeSingleThreaded, FreeListAllocator};

#[cfg(target_feature = "atomics")]
compile_error!("the allocator needs a module with one thread");

/// std's allocator would add 5 KB.
// SAFETY: a module without atomics has one thread.
#[global_allocator]
static ALLOCATOR: AssumeSingleThreaded<FreeListAllocator> =
    unsafe { AssumeSingleThreaded::new(FreeListAllocator::new()) };

/// Moves a value to the heap, or returns `None` if there is no memory. `Box::new` would panic.
pub fn keep<T>(value: T) -> Option<Box<T>> {
    // SAFETY: the size of what JavaScript keeps is not 0, and a box frees memory of this layout.
    unsafe {
        let memory = alloc(Layout::new::<T>()).cast::<T>();
        if memory.is_null() {
            return None;
        }
        memory.write(value);
        Some(Box::from_raw(memory))
    }
}

/// `count` zeros, or `None` if there is no memory for them.
///
/// # Safety
///
/// A `T` may consist of zero bytes.
pub unsafe fn zeros<T>(count: usize) -> Option<Vec<T>> {
    if count == 0 {
        return Some(Vec::new());
    }
    let layout = Layout::array::<T>(count).ok()?;
    // SAFETY: the size of what is kept here is not 0, and a vector frees memory of this layout.
    unsafe {
        let memory: *mut T = alloc_zeroed(layout).cast();
        (!memory.is_null()).then(|| Vec::from_raw_parts(memory, count, count))
    }
}

/// 21 draws have 5 words each. Seeds, with up to 64, and others are shorter.
const LEN: usize = 105;

thread_local! {
    static WORDS: Cell<[u32; LEN]> = const { Cell::new([0; LEN]) };
}

/// The address of the words that JavaScript reads and writes between calls.
#[unsafe(no_mangle)]
pub extern "C" fn words() -> *const u32 {
    WORDS.with(Cell::as_ptr).cast()
}

pub fn numbers() -> [f32; LEN] {
    WORDS.get().map(f32::from_bits)
}

pub fn set(values: &[u32]) {
    WORDS.with(|words| {
        let words: &Cell<[u32]> = words;
        for (word, value) in words.as_slice_of_cells().iter().zip(values) {
            word.set(*value);
        }
    });
}

pub fn set_numbers<const N: usize>(values: [f32; N]) {
    set(&values.map(f32::to_bits));
}

/// A text as its address and its length.
pub fn text(text: &str) -> [u32; 2] {
    [text.as_ptr().addr() as u32, text.len() as u32]
}

/// The seed in the first `words` words. The lowest word is first.
pub fn seed(words: usize) -> SeedSequence {
    SeedSequence::from_words(WORDS.get().get(..words).unwrap_or_default())
}

/// Writes the names of the parameters' numbers.
#[inline] // saves 360 bytes of the module with acrobots, which has the numbers anyway
pub fn set_param_names() {
    let names = Params::<f32>::DEFAULT.numbers().map(|(name, _)| text(name));
    set(names.as_flattened());
}

/// The parameters with some replaced by what JavaScript has written in the order of their names,
/// the dynamics last: those whose bit is in `mask`.
pub fn changed(mut params: Params<f32>, mask: u32) -> Params<f32> {
    let numbers = numbers();
    let is_given = |slot: usize| mask >> slot & 1 != 0;
    for (slot, (number, given)) in params.numbers_mut().into_iter().zip(numbers).enumerate() {
        if is_given(slot) {
            *number = given;
        }
    }
    const DYNAMICS: usize = 21; // comes after the numbers
    if is_given(DYNAMICS) {
        params.dynamics = if numbers[DYNAMICS] == 0.0 { Dynamics::Book } else { Dynamics::Nips };
    }
    params
}

/// 0, or the kind of error for which numbers are rejected. Then the value, the name, the rule and
/// the unit are in the words. JavaScript composes the message, because Rust's formatting of floats
/// would add 16 KB to the module.
pub fn reason(result: Result<(), Error>) -> u32 {
    let (kind, value, texts) = match result {
        Ok(()) => return 0,
        Err(Error::OutOfRange { name, value, unit, rule }) => (1, value, [name, rule, unit]),
        // Of own parameters, where all acrobots share them. JavaScript lets no other occur.
        Err(_) => (3, 0.0, [""; 3]),
    };
    let [[a, b], [c, d], [e, f]] = texts.map(text);
    set(&[(value as f32).to_bits(), a, b, c, d, e, f]);
    kind
}
