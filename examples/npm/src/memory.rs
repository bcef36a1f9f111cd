//! What the exported functions share: acrobots, batches, and memory to exchange values with JavaScript.

use std::cell::Cell;
use std::thread::LocalKey;

use acrobot::numpy::SeedSequence;
use acrobot::physics::Dynamics;
use acrobot::{Error, Params, State};

use crate::table::Table;

type Shared<T> = LocalKey<Cell<Table<T>>>;

/// Calls `f` with a table, which is moved out meanwhile. A `RefCell`, or `with` for `try_with`, would bring a panic.
pub fn with<T, R: Default>(shared: &'static Shared<T>, f: impl FnOnce(&mut Table<T>) -> R) -> R {
    let called = shared.try_with(|cell| {
        let mut table = cell.replace(Table::EMPTY);
        let result = f(&mut table);
        cell.set(table);
        result
    });
    called.unwrap_or_default()
}

/// Calls `f` with the value of this number. JavaScript uses no number after it has removed the value.
pub fn with_value<T, R: Default>(
    shared: &'static Shared<T>,
    number: usize,
    f: impl FnOnce(&mut T) -> R,
) -> R {
    with(shared, |table| table.get_mut(number).map(f)).unwrap_or_default()
}

/// The number of a new value, or −1 if there is no memory for it.
pub fn insert<T>(shared: &'static Shared<T>, value: T) -> i32 {
    let number = with(shared, |table| table.insert(value));
    number.map_or(-1, |number| number as i32)
}

/// The sixteen numbers of `Params`, then their dynamics.
const NUMBERS_LEN: usize = 17;
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

pub fn get_bytes() -> [u8; BYTES_LEN] {
    BYTES.get()
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

/// Writes a snapshot in the format of postcard, and returns its length.
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

/// The numbers of parameters, in the order in which JavaScript reads and writes them.
fn fields(params: &mut Params<f32>) -> [&mut f32; 16] {
    let [negative, zero, positive] = &mut params.torques;
    [
        &mut params.length1,
        &mut params.length2,
        &mut params.mass1,
        &mut params.mass2,
        &mut params.center_of_mass1,
        &mut params.center_of_mass2,
        &mut params.inertia1,
        &mut params.inertia2,
        &mut params.gravity,
        &mut params.dt,
        &mut params.max_velocity1,
        &mut params.max_velocity2,
        negative,
        zero,
        positive,
        &mut params.torque_noise,
    ]
}

/// Writes parameters, the dynamics after the numbers: 0 for the book's.
pub fn set_params(params: &Params<f32>) {
    let nips = f32::from(params.dynamics == Dynamics::Nips);
    let mut params = *params;
    let numbers = fields(&mut params).map(|number| *number);
    NUMBERS.with(|cells| set(cells, numbers.into_iter().chain([nips])));
}

/// Reads what [`set_params`] writes.
pub fn get_params() -> Params<f32> {
    let mut params = Params::DEFAULT;
    let [numbers @ .., nips] = NUMBERS.get();
    for (field, number) in fields(&mut params).into_iter().zip(numbers) {
        *field = number;
    }
    if nips != 0.0 {
        params.dynamics = Dynamics::Nips;
    }
    params
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
