//! What the exported functions share: memory for acrobots and batches, and to exchange values with JavaScript.

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

/// A state, the energy and the tip's height, or an observation.
const NUMBERS_LEN: usize = 6;
/// The longest seed, 64 words of 4 bytes. Snapshots and error texts are shorter.
const BYTES_LEN: usize = 256;

thread_local! {
    static NUMBERS: Cell<[f32; NUMBERS_LEN]> = const { Cell::new([0.0; NUMBERS_LEN]) };
    static BYTES: Cell<[u8; BYTES_LEN]> = const { Cell::new([0; BYTES_LEN]) };
}

/// The address of numbers that JavaScript reads and writes between calls.
#[unsafe(no_mangle)]
pub extern "C" fn numbers() -> *const f32 {
    NUMBERS.with(Cell::as_ptr).cast()
}

/// The address of bytes that JavaScript reads and writes between calls.
#[unsafe(no_mangle)]
pub extern "C" fn bytes() -> *const u8 {
    BYTES.with(Cell::as_ptr).cast()
}

pub fn get_state() -> State<f32> {
    let [theta1, theta2, dtheta1, dtheta2, ..] = NUMBERS.get();
    State::from([theta1, theta2, dtheta1, dtheta2])
}

fn set<T>(cells: &Cell<[T]>, values: impl IntoIterator<Item = T>) -> usize {
    let pairs = cells.as_slice_of_cells().iter().zip(values);
    pairs.map(|(cell, value)| cell.set(value)).count()
}

pub fn set_numbers<const N: usize>(values: [f32; N]) {
    NUMBERS.with(|cells| set(cells, values));
}

/// Writes bytes and returns their count.
pub fn set_bytes(values: impl IntoIterator<Item = u8>) -> usize {
    BYTES.with(|cells| set(cells, values))
}

/// Writes parameters or a snapshot in the format of postcard, and returns the length.
pub fn save(value: &impl serde::Serialize) -> usize {
    let mut bytes = [0; BYTES_LEN];
    let saved = postcard::to_slice(value, &mut bytes);
    saved.map_or(0, |saved| set_bytes(saved.iter().copied()))
}

/// The seed in the first `words` 32-bit words. The lowest word is first.
pub fn seed(words: usize) -> SeedSequence {
    let bytes = BYTES.get();
    let mut seed = [0; BYTES_LEN / 4];
    for (word, bytes) in seed.iter_mut().zip(bytes.as_chunks().0).take(words) {
        *word = u32::from_le_bytes(*bytes);
    }
    // Leading zeros do not count.
    SeedSequence::from_words(&seed)
}

/// Loads what [`save`] writes from the first of `len` bytes. Returns it with the number of its bytes, or `None` if they are invalid.
pub fn load<T: serde::de::DeserializeOwned>(len: usize) -> Option<(T, usize)> {
    let bytes = BYTES.get();
    let (value, rest) = postcard::take_from_bytes(bytes.get(..len)?).ok()?;
    Some((value, len - rest.len()))
}

/// The parameters that JavaScript has written as [`save`] writes them.
pub fn get_params() -> Params<f32> {
    load(BYTES_LEN).map_or(Params::DEFAULT, |(params, _)| params)
}

/// 0, or the length of the reason for which numbers are rejected: name, rule and unit, a line each. JavaScript has the
/// value, and composes the message, because Rust's formatting of floats would add 16 KB to the module.
pub fn reason(result: Result<(), Error>) -> usize {
    let (name, rule, unit) = match result {
        Ok(()) => return 0,
        Err(Error::OutOfRange {
            name, rule, unit, ..
        }) => (name, rule, unit),
        Err(Error::NoInertia { name, .. }) => (
            name,
            "above 0",
            "kg m² if the centre of mass is on the joint",
        ),
        // Parameters and states have no other errors.
        Err(_) => ("", "", ""),
    };
    set_bytes(
        [name, "\n", rule, "\n", unit]
            .into_iter()
            .flat_map(str::bytes),
    )
}
