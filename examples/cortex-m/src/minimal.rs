//! The least firmware that uses an `Acrobot`: it seeds one, and steps and resets it forever. The crate costs what this has
//! above `minimal_without`.

use core::hint::black_box;

use acrobot::arithmetic::Arithmetic;
use acrobot::{Acrobot, Action};

pub fn run<A: Arithmetic>() -> ! {
    let mut acrobot = Acrobot::<A>::new(black_box(42));
    loop {
        // `cycles.py` counts a step here.
        cortex_m::asm::nop();
        // The compiler does not know what the agent does, nor what it needs.
        if black_box(acrobot.step(black_box(Action::Zero))).terminated {
            black_box(acrobot.reset());
        }
    }
}
