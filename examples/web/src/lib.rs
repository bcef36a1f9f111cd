//! The module of the page: plain functions over numbers, which JavaScript calls.
//!
//! Longer data passes through the buffer in `memory`: seeds in, reasons out, weights both ways. Without the `page`
//! feature there is only `simulation`. The fuzz targets call the same functions on the machine that builds.

#![cfg_attr(target_family = "wasm", no_std)]

#[cfg(feature = "page")]
pub mod learner;
pub mod memory;
#[cfg(feature = "page")]
pub mod once;
#[cfg(feature = "page")]
pub mod picture;
#[cfg(feature = "page")]
pub mod policies;
pub mod simulation;
#[cfg(feature = "page")]
pub mod speed;

#[cfg(target_family = "wasm")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    core::arch::wasm32::unreachable()
}
