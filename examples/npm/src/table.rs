//! Memory for what JavaScript refers to by a number.

/// Values with their numbers. A number is used again after its value has been removed.
pub struct Table<T> {
    slots: Vec<Slot<T>>,
    /// The first free slot. The number of slots or a larger number means that there is none.
    free: usize,
}

enum Slot<T> {
    Used(T),
    /// With the next free slot.
    Free(usize),
}

impl<T> Table<T> {
    pub const EMPTY: Self = Self {
        slots: Vec::new(),
        free: usize::MAX,
    };

    /// Inserts a value and returns its number, or `None` if there is no memory.
    pub fn insert(&mut self, value: T) -> Option<usize> {
        if let Some(slot) = self.slots.get_mut(self.free) {
            let number = self.free;
            if let Slot::Free(next) = *slot {
                self.free = next;
            }
            *slot = Slot::Used(value);
            return Some(number);
        }
        self.slots.try_reserve(1).ok()?;
        let number = self.slots.len();
        // Always true. With this check the compiler omits the growth in `push`, and its panic.
        if number == self.slots.capacity() {
            return None;
        }
        self.slots.push(Slot::Used(value));
        Some(number)
    }

    pub fn get_mut(&mut self, number: usize) -> Option<&mut T> {
        match self.slots.get_mut(number)? {
            Slot::Used(value) => Some(value),
            Slot::Free(_) => None,
        }
    }

    pub fn remove(&mut self, number: usize) {
        if let Some(slot @ Slot::Used(_)) = self.slots.get_mut(number) {
            *slot = Slot::Free(self.free);
            self.free = number;
        }
    }
}
