//! The same firmware as `minimal_fast` and the others, without an acrobot.

#![no_std]
#![no_main]

use core::hint::black_box;

use acrobot::Action;
use panic_halt as _;

#[acrobot_cortex_m::entry]
fn main() -> ! {
    loop {
        // `cycles.py` counts a step here.
        acrobot_cortex_m::nop();
        black_box(black_box(Action::Zero));
    }
}
