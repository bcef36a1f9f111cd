//! The least firmware that uses the crate: an acrobot is seeded, reset and stepped
//! for ever. What `minimal_without` leaves out is what the crate costs.

use core::hint::black_box;

use acrobot::{Acrobot, Action, Arithmetic};

pub fn run<A: Arithmetic>() -> ! {
    let mut acrobot = Acrobot::<A>::new(black_box(42));
    loop {
        // Where `cycles.py` counts a step.
        cortex_m::asm::nop();
        // From the agent and for it, whatever they are.
        if black_box(acrobot.step(black_box(Action::Zero))).terminated {
            black_box(acrobot.reset());
        }
    }
}
