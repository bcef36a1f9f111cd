//! What the exported functions share, and most of the crate's `unsafe`.

use core::cell::{RefCell, RefMut};

#[cfg(target_feature = "atomics")]
compile_error!("the statics here are for a module with one thread");

/// A value that all exported functions see.
pub struct Shared<T>(RefCell<T>);

// SAFETY: a module without atomics has one thread.
unsafe impl<T> Sync for Shared<T> {}

impl<T> Shared<T> {
    pub const fn new(value: T) -> Self {
        Self(RefCell::new(value))
    }

    pub fn borrow(&self) -> RefMut<'_, T> {
        self.0.borrow_mut()
    }

    /// Where JavaScript reads and writes between calls.
    pub fn address(&self) -> *mut T {
        self.0.as_ptr()
    }
}

/// What is too long for a number passes here; the longest are the learner's weights, 64 KiB.
pub static BUFFER: Shared<[u8; 1 << 17]> = Shared::new([0; 1 << 17]);

#[unsafe(no_mangle)]
pub extern "C" fn buffer() -> *mut u8 {
    BUFFER.address().cast()
}
