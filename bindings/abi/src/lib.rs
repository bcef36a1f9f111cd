//! The one door: what other languages may do. C links these functions, and the npm package has them
//! as WebAssembly. `python3 derive.py` writes what other languages repeat of these files and of the
//! crate: with cbindgen `../c/include/acrobot.h`, and parts of the bindings and pages.
//!
//! All `unsafe` is here: the crate sees only valid references.

#![no_std]
#![expect(non_camel_case_types, reason = "the names of the header")]
#![expect(clippy::missing_safety_doc, reason = "the header states it once")]
#![expect(
    unsafe_op_in_unsafe_fn,
    reason = "each function of the header is unsafe as a whole: it gets pointers"
)]

// The header has the same order. Without the empty lines rustfmt would sort them.
pub mod status;

pub mod data;

pub mod task;

#[cfg(feature = "acrobots")]
pub mod single;

#[cfg(feature = "control")]
pub mod model;

#[cfg(feature = "control")]
pub mod regulator;

#[cfg(feature = "control")]
pub mod plan;

#[cfg(feature = "control")]
pub mod swing_up;

#[cfg(feature = "control")]
pub mod estimate;

#[cfg(feature = "control")]
pub mod identify;

#[cfg(feature = "control")]
pub mod mpc;

#[cfg(feature = "acrobots")]
pub mod action_space;

#[cfg(feature = "acrobots")]
pub mod batch;

#[cfg(feature = "acrobots")]
pub mod members;

#[cfg(feature = "instruments")]
pub mod instruments;

#[cfg(all(feature = "acrobots", any(target_pointer_width = "64", target_family = "wasm")))]
pub mod snapshot;

#[cfg(target_family = "wasm")]
mod heap;

#[cfg(all(target_family = "wasm", feature = "control", feature = "instruments"))]
mod layout;

#[cfg(feature = "acrobots")]
mod linked;

mod memory;

#[cfg(target_feature = "sse")]
mod mode;

unsafe extern "C" {
    /// Does not exist: a program links only if no branch that panics is left.
    fn acrobot_has_a_panicking_branch() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    // SAFETY: it is never called, because a program that contains this call does not link.
    unsafe { acrobot_has_a_panicking_branch() }
}
