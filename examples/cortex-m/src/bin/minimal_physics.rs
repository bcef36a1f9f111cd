//! Firmware with a `Pendulum<Fast>`, which has no random numbers: its flash minus that of `minimal_without` is the pendulum's.

#![no_std]
#![no_main]

use core::hint::black_box;

use acrobot::Fast;
use acrobot::physics::Pendulum;
use panic_halt as _;

#[acrobot_cortex_m::entry]
fn main() -> ! {
    static mut PENDULUM: Pendulum<Fast> = Pendulum::hanging();
    loop {
        // `cycles.py` counts a step here.
        acrobot_cortex_m::nop();
        // The compiler must not know the torque, and must compute the whole state.
        if PENDULUM.step(black_box(0.0)).is_ok() {
            black_box(PENDULUM.state());
        }
    }
}
