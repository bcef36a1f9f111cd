//! The WebAssembly module of the npm package `acrobot-rs`: functions that its JavaScript calls.
//!
//! JavaScript keeps the address of each acrobot and of each batch in a private field, until it
//! frees it. Longer data passes through the memory in `memory`. There a seed has `words` words of
//! 32 bits; without any the generator continues. JavaScript checks numbers, lengths and actions,
//! and the crate checks parameters, states and snapshots. A setter returns 0, or the length of the
//! reason for a rejection.

mod many;
mod memory;
mod single;

use acrobot::task::{Gymnasium, Swingup, Task};
use lol_alloc::{AssumeSingleThreaded, FreeListAllocator};

#[cfg(target_feature = "atomics")]
compile_error!("the allocator needs a module with one thread");

/// std's allocator would add 5 KB.
// SAFETY: a module without atomics has one thread.
#[global_allocator]
static ALLOCATOR: AssumeSingleThreaded<FreeListAllocator> =
    unsafe { AssumeSingleThreaded::new(FreeListAllocator::new()) };

/// What has another type for each task.
pub enum Tasks<A, B> {
    Acrobot(A),
    Swingup(B),
}

/// A task's bound of initial states on both sides.
#[unsafe(no_mangle)]
pub extern "C" fn task_bound(task: u32) -> f64 {
    let bounds = match task {
        0 => Gymnasium::RESET_BOUNDS,
        _ => Swingup::RESET_BOUNDS,
    };
    bounds.high()
}

/// Does something with what an enum [`Tasks`] has, whatever the task.
macro_rules! with_task {
    ($tasks:expr, $of:ident => $result:expr) => {
        match $tasks {
            $crate::Tasks::Acrobot($of) => $result,
            $crate::Tasks::Swingup($of) => $result,
        }
    };
}
pub(crate) use with_task;
