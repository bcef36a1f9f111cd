//! State that the exported functions share, and most of this crate's `unsafe`.

use core::cell::{RefCell, RefMut};

#[cfg(target_feature = "atomics")]
compile_error!("the statics here need a module with one thread");

/// A static variable that can be changed.
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

    /// The address, for JavaScript, which reads and writes there between calls.
    pub fn address(&self) -> *mut T {
        self.0.as_ptr()
    }
}

/// Passes data that is longer than a number. The longest are the learner's weights, 64 KiB.
pub static BUFFER: Shared<[u8; 1 << 17]> = Shared::new([0; 1 << 17]);

#[unsafe(no_mangle)]
pub extern "C" fn buffer() -> *mut u8 {
    BUFFER.address().cast()
}
