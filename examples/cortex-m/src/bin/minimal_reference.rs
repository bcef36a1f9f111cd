//! The flash that an `Acrobot<Reference>` takes above that of `minimal_without`.

#![no_std]
#![no_main]

#[path = "../minimal.rs"]
mod minimal;

use acrobot::arithmetic::Reference;
use panic_halt as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    minimal::run::<Reference>()
}
