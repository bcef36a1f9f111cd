//! The flash that an `Acrobot<Micro>` takes above that of `minimal_without`.

#![no_std]
#![no_main]

use acrobot::arithmetic::Micro;
use acrobot_cortex_m::minimal;
use panic_halt as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    minimal::run::<Micro>()
}
