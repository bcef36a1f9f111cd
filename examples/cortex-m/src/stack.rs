//! Measures stack: paints it, calls a function, and finds the deepest word that changed.

use core::arch::asm;

const PAINT: u32 = 0xa5c3_9617;
const WORDS: usize = 2048;

/// The bytes of stack that `run` takes, or `None` if it takes all that is painted, 8 KiB.
#[inline(never)]
pub fn depth(run: impl FnOnce()) -> Option<usize> {
    // The paint begins below this function's own frame.
    let end = pointer();
    for i in 1..=WORDS {
        // SAFETY: the words below the stack pointer are unused stack, because no interrupt is
        // enabled.
        unsafe { end.sub(i).write_volatile(PAINT) };
    }
    run();
    let deepest = (1..=WORDS)
        .rev()
        // SAFETY: as above.
        .find(|&i| unsafe { end.sub(i).read_volatile() } != PAINT)?;
    (deepest < WORDS).then_some(deepest * size_of::<u32>())
}

fn pointer() -> *mut u32 {
    let pointer;
    // SAFETY: it only reads the stack pointer.
    #[cfg(target_arch = "arm")]
    unsafe {
        asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack, preserves_flags));
    }
    // SAFETY: as above.
    #[cfg(target_arch = "riscv32")]
    unsafe {
        asm!("mv {}, sp", out(reg) pointer, options(nomem, nostack, preserves_flags));
    }
    pointer
}
