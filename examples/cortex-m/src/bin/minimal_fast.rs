//! The flash that an `Acrobot<Fast>` takes above that of `minimal_without`.

#![no_std]
#![no_main]

#[path = "../minimal.rs"]
mod minimal;

use acrobot::Fast;
use panic_halt as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    minimal::run::<Fast>()
}
