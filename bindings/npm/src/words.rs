//! What acrobots and batches read and write in the words.

use acrobot::physics::Dynamics;
use acrobot::task::{Draw, Draws};
use acrobot::{Error, Params, State};
use memory::{numbers, set};

#[unsafe(no_mangle)]
pub extern "C" fn param_names() {
    memory::set_param_names();
}

pub fn get_state() -> State<f32> {
    let [theta1, theta2, dtheta1, dtheta2, ..] = numbers();
    State::from([theta1, theta2, dtheta1, dtheta2])
}

/// Writes the numbers in the order of their names, then that of the dynamics.
pub fn set_params(params: &Params<f32>) {
    let dynamics = f32::from(u8::from(params.dynamics == Dynamics::Nips));
    let mut words = [dynamics.to_bits(); 22];
    for (word, (_, number)) in words.iter_mut().zip(params.numbers()) {
        *word = number.to_bits();
    }
    set(&words);
}

/// The draws that JavaScript has written: for each number its kind, and up to four numbers.
pub fn get_draws() -> Result<Draws<f32>, Error> {
    let numbers = numbers();
    let mut draws = Draws::FIXED;
    for (draw, row) in draws.numbers_mut().into_iter().zip(numbers.as_chunks().0) {
        let [kind, a, b, low, high] = *row;
        *draw = match kind as u32 {
            0 => Draw::Fixed,
            1 => Draw::Uniform { low: a, high: b },
            2 => Draw::LogUniform { low: a, high: b },
            _ => Draw::Normal { mean: a, std: b, low, high },
        };
    }
    Draws::new(draws)
}
