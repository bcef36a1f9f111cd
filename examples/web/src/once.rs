//! Memory that lives as long as the module, and belongs to one owner.

use core::cell::{Cell, UnsafeCell};

/// Memory that can be taken once.
pub struct Once<T> {
    taken: Cell<bool>,
    value: UnsafeCell<T>,
}

// SAFETY: a module without atomics has one thread. `memory` does not compile with atomics.
unsafe impl<T> Sync for Once<T> {}

impl<T> Once<T> {
    pub const fn new(value: T) -> Self {
        Self {
            taken: Cell::new(false),
            value: UnsafeCell::new(value),
        }
    }

    #[expect(clippy::mut_from_ref, reason = "it can be taken once")]
    pub fn take(&'static self) -> Option<&'static mut T> {
        if self.taken.replace(true) {
            return None;
        }
        // SAFETY: this line runs once, so no other reference exists.
        Some(unsafe { &mut *self.value.get() })
    }
}
