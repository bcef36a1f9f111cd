//! Memory in the module for what JavaScript passes to functions.

use core::alloc::{GlobalAlloc, Layout};
use core::ptr;

use lol_alloc::{AssumeSingleThreaded, FreeListAllocator};

#[cfg(target_feature = "atomics")]
compile_error!("the allocator needs a module with one thread");

/// std's allocator would add 5 KB.
// SAFETY: a module without atomics has one thread.
static HEAP: AssumeSingleThreaded<FreeListAllocator> =
    unsafe { AssumeSingleThreaded::new(FreeListAllocator::new()) };

/// The largest alignment of a type of the header: ACROBOT_BATCH_ALIGN.
const ALIGN: usize = 64;

fn layout(size: usize) -> Option<Layout> {
    Layout::from_size_align(size, ALIGN).ok().filter(|_| size > 0)
}

/// `size` bytes of zeros, aligned for any type of the header; null without memory.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_memory_new(size: usize) -> *mut u8 {
    // SAFETY: the size is not 0.
    layout(size).map_or(ptr::null_mut(), |layout| unsafe { HEAP.alloc_zeroed(layout) })
}

/// Frees memory of acrobot_memory_new, with its size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_memory_free(memory: *mut u8, size: usize) {
    if let Some(layout) = layout(size) {
        HEAP.dealloc(memory, layout);
    }
}
