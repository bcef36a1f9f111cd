//! Memory that lives as long as the module.

use core::cell::{Cell, UnsafeCell};

/// Memory that is handed out once.
pub struct Once<T> {
    taken: Cell<bool>,
    value: UnsafeCell<T>,
}

// SAFETY: a module without atomics has one thread, as `memory` makes sure.
unsafe impl<T> Sync for Once<T> {}

impl<T> Once<T> {
    pub const fn new(value: T) -> Self {
        Self {
            taken: Cell::new(false),
            value: UnsafeCell::new(value),
        }
    }

    #[expect(clippy::mut_from_ref, reason = "it is handed out once")]
    pub fn take(&'static self) -> Option<&'static mut T> {
        if self.taken.replace(true) {
            return None;
        }
        // SAFETY: it is taken for the first time, and never again.
        Some(unsafe { &mut *self.value.get() })
    }
}
