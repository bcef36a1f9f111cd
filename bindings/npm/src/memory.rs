//! What the exported functions share: memory for acrobots, and to exchange values.

use std::alloc::{Layout, alloc};
use std::cell::Cell;

use acrobot::numpy::SeedSequence;
use acrobot::{Error, Params, State};

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

/// The longest seed, in words of 32 bits. Snapshots, error texts and six numbers are shorter.
const LEN: usize = 64;

thread_local! {
    static WORDS: Cell<[u32; LEN]> = const { Cell::new([0; LEN]) };
}

/// The address of numbers or bytes that JavaScript reads and writes between calls.
#[unsafe(no_mangle)]
pub extern "C" fn bytes() -> *const u8 {
    WORDS.with(Cell::as_ptr).cast()
}

pub fn get_state() -> State<f32> {
    let [theta1, theta2, dtheta1, dtheta2, ..] = WORDS.get().map(f32::from_bits);
    State::from([theta1, theta2, dtheta1, dtheta2])
}

fn set(values: impl IntoIterator<Item = u32>) {
    WORDS.with(|words| {
        let words: &Cell<[u32]> = words;
        for (word, value) in words.as_slice_of_cells().iter().zip(values) {
            word.set(value);
        }
    });
}

pub fn set_numbers<const N: usize>(values: [f32; N]) {
    set(values.map(f32::to_bits));
}

/// Writes bytes and returns their count.
pub fn set_bytes(values: impl IntoIterator<Item = u8>) -> usize {
    let mut bytes = [0; 4 * LEN];
    let pairs = bytes.iter_mut().zip(values);
    let len = pairs.map(|(byte, value)| *byte = value).count();
    set(bytes.as_chunks().0.iter().copied().map(u32::from_le_bytes));
    len
}

/// Writes parameters or a snapshot in the format of postcard, and returns the length.
pub fn save(value: &impl serde::Serialize) -> usize {
    let mut bytes = [0; 4 * LEN];
    let saved = postcard::to_slice(value, &mut bytes);
    saved.map_or(0, |saved| set_bytes(saved.iter().copied()))
}

/// The seed in the first `words` 32-bit words. The lowest word is first.
pub fn seed(words: usize) -> SeedSequence {
    SeedSequence::from_words(WORDS.get().get(..words).unwrap_or_default())
}

/// Loads what [`save`] writes from the first of `len` bytes. Returns it with the number of its
/// bytes, or `None` if they are invalid.
pub fn load<T: serde::de::DeserializeOwned>(len: usize) -> Option<(T, usize)> {
    let bytes = WORDS.get().map(u32::to_le_bytes);
    let (value, rest) = postcard::take_from_bytes(bytes.as_flattened().get(..len)?).ok()?;
    Some((value, len - rest.len()))
}

/// The parameters that JavaScript has written as [`save`] writes them.
pub fn get_params() -> Params<f32> {
    load(4 * LEN).map_or(Params::DEFAULT, |(params, _)| params)
}

/// 0, or the length of the reason for which numbers are rejected: name, rule and unit, a line each.
/// JavaScript has the value, and composes the message, because Rust's formatting of floats would
/// add 16 KB to the module.
pub fn reason(result: Result<(), Error>) -> usize {
    let (name, rule, unit) = match result {
        Ok(()) => return 0,
        Err(Error::OutOfRange { name, rule, unit, .. }) => (name, rule, unit),
        Err(Error::NoInertia { name, .. }) => {
            (name, "above 0", "kg m² if the centre of mass is on the joint")
        }
        // Parameters and states have no other errors.
        Err(_) => ("", "", ""),
    };
    set_bytes([name, "\n", rule, "\n", unit].into_iter().flat_map(str::bytes))
}
