//! The module behind the page: what JavaScript calls, as plain functions over numbers.
//!
//! Longer things pass through the one buffer of `memory`: a seed's words in, reasons out, weights both ways. Without the
//! `page` feature only `simulation` is left.

#![no_std]

#[cfg(feature = "page")]
mod learner;
mod memory;
#[cfg(feature = "page")]
mod once;
#[cfg(feature = "page")]
mod picture;
#[cfg(feature = "page")]
mod policies;
mod simulation;
#[cfg(feature = "page")]
mod speed;

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    core::arch::wasm32::unreachable()
}
