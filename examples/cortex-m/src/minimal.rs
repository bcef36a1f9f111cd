//! The smallest firmware that uses an `Acrobot`: it seeds one, and steps and resets it forever. Its flash minus that of
//! `minimal_without` is the flash of the crate.

use core::hint::black_box;

use acrobot::arithmetic::Arithmetic;
use acrobot::{Acrobot, Action};

pub fn run<A: Arithmetic>() -> ! {
    let mut acrobot = Acrobot::<A>::new(black_box(42));
    loop {
        // `cycles.py` counts a step here.
        crate::nop();
        // The compiler must not know the action, and must compute the whole result.
        if black_box(acrobot.step(black_box(Action::Zero))).terminated {
            black_box(acrobot.reset());
        }
    }
}
