//! The module of the page: plain functions over numbers, which JavaScript calls.
//!
//! Longer data passes through the buffer in `memory`: seeds in, reasons out, weights both ways. Without the `page`
//! feature there is only `simulation`.

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
