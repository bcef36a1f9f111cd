//! Plays and trains as the crate's tests do. `parity.mjs` compares the digests.

#![no_std]

#[path = "../../../tests/common/digest.rs"]
mod digest;
#[path = "../../../tests/common/episodes.rs"]
mod episodes;
#[path = "../../../tests/common/training.rs"]
mod training;

use acrobot::arithmetic::{Micro, Reference};
use acrobot::{Fast, Portable};

/// The digest of an episode in `reference` (0), `portable` (1), `fast` (2) or `micro` (3).
#[unsafe(no_mangle)]
pub extern "C" fn found(arithmetic: u32, episode: u32) -> u64 {
    let digest = match arithmetic {
        0 => episodes::digest::<Reference>,
        1 => episodes::digest::<Portable>,
        2 => episodes::digest::<Fast>,
        _ => episodes::digest::<Micro>,
    };
    digest(episode.into())
}

/// The digest that the crate's tests assert.
#[unsafe(no_mangle)]
pub extern "C" fn expected(arithmetic: u32, episode: u32) -> u64 {
    let digests = match arithmetic {
        0 => episodes::REFERENCE,
        1 => episodes::PORTABLE,
        2 => episodes::FAST,
        _ => episodes::MICRO,
    };
    digests[episode as usize]
}

/// Whether a batch has the digest that the crate's tests assert.
#[unsafe(no_mangle)]
pub extern "C" fn batch_is_equal() -> bool {
    episodes::batch::<4, 5>() == episodes::BATCH && episodes::batch::<16, 2>() == episodes::BATCH
}

/// Whether a training ends with the weights that the crate's tests assert.
#[unsafe(no_mangle)]
pub extern "C" fn training_is_equal() -> bool {
    training::weights() == training::WEIGHTS
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    core::arch::wasm32::unreachable()
}
