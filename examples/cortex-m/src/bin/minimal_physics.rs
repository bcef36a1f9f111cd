//! The flash that a `Pendulum<Fast>` takes above that of `minimal_without`: physics without random numbers.

#![no_std]
#![no_main]

use core::hint::black_box;

use acrobot::Fast;
use acrobot::physics::Pendulum;
use panic_halt as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    static mut PENDULUM: Pendulum<Fast> = Pendulum::hanging();
    loop {
        // `cycles.py` counts a step here.
        cortex_m::asm::nop();
        // The compiler does not know the controller's torque, nor what the controller needs.
        if PENDULUM.step(black_box(0.0)).is_ok() {
            black_box(PENDULUM.state());
        }
    }
}
