//! The flash that an `Acrobot<Micromath>` takes above that of `minimal_without`.

#![no_std]
#![no_main]

use acrobot_cortex_m::micromath::Micromath;
use acrobot_cortex_m::minimal;
use panic_halt as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    minimal::run::<Micromath>()
}
