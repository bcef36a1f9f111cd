//! The caller's floating-point mode on x86. Start-up code that `gcc -ffast-math` links flushes
//! subnormal numbers to zero, and `fesetround` rounds in another direction. Rust expects neither.

use core::arch::asm;

/// MXCSR after a reset.
const DEFAULT: u32 = 0x1f80;

/// The caller's mode, until this is dropped.
pub struct Replaced {
    mxcsr: u32,
}

impl Replaced {
    pub fn by_default() -> Self {
        let mut callers = Self { mxcsr: 0 };
        // SAFETY: it writes to `callers`, and sets the mode that Rust expects.
        unsafe {
            asm!(
                "stmxcsr [{}]", "ldmxcsr [{}]",
                in(reg) &raw mut callers.mxcsr, in(reg) &DEFAULT,
                options(nostack, preserves_flags),
            );
        }
        callers
    }
}

impl Drop for Replaced {
    fn drop(&mut self) {
        // SAFETY: the function of the header returns to C, which set this mode.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &self.mxcsr, options(nostack, preserves_flags)) }
    }
}
