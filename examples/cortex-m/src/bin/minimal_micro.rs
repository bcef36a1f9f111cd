//! Firmware with an `Acrobot<Micro>`: its flash minus that of `minimal_without` is the crate's.

#![no_std]
#![no_main]

use acrobot::arithmetic::Micro;
use acrobot_cortex_m::minimal;
use panic_halt as _;

#[acrobot_cortex_m::entry]
fn main() -> ! {
    minimal::run::<Micro>()
}
