//! The page's WebAssembly module: exported functions with numbers as arguments and results, which JavaScript calls.
//!
//! Longer data passes through the buffer in `memory`: JavaScript writes seeds, Rust writes error texts, both write weights.
//! Without the `page` feature the module contains only `simulation`. Fuzz targets call the same functions natively.

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
