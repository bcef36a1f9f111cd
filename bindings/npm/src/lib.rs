//! The WebAssembly module of the npm package `acrobot-rs`: functions that its JavaScript calls.
//!
//! JavaScript keeps the address of each acrobot and of each batch in a private field, until it
//! frees it. Longer data passes through the memory in `memory`. The JavaScript checks numbers,
//! lengths and actions, and the crate checks parameters, states and snapshots.

mod many;
mod memory;
mod single;

use lol_alloc::{AssumeSingleThreaded, FreeListAllocator};

#[cfg(target_feature = "atomics")]
compile_error!("the allocator needs a module with one thread");

/// std's allocator would add 5 KB.
// SAFETY: a module without atomics has one thread.
#[global_allocator]
static ALLOCATOR: AssumeSingleThreaded<FreeListAllocator> =
    unsafe { AssumeSingleThreaded::new(FreeListAllocator::new()) };
