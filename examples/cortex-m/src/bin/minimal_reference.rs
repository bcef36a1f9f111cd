//! The flash that an `Acrobot<Reference>` takes above that of `minimal_without`.

#![no_std]
#![no_main]

use acrobot::arithmetic::Reference;
use acrobot_cortex_m::minimal;
use panic_halt as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    minimal::run::<Reference>()
}
