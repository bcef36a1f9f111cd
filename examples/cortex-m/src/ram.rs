//! Measures RAM.

use cortex_m_rt::{STACK_PAINT_VALUE, heap_start};

/// Bytes of RAM in use. The start-up code paints the RAM.
pub fn used() -> usize {
    unsafe extern "C" {
        static _ram_start: u32;
        static _ram_end: u32;
    }
    let mut deepest = heap_start();
    // SAFETY: the search begins in RAM, and ends at this function's own frame, which is not
    // painted.
    while unsafe { deepest.read_volatile() } == STACK_PAINT_VALUE {
        deepest = deepest.wrapping_add(1);
    }
    let statics = heap_start() as usize - (&raw const _ram_start) as usize;
    statics + (&raw const _ram_end) as usize - deepest as usize
}
