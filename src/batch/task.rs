//! The task of a batch.

use super::Batch;
use super::storage::Storage;
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::numpy::SeedSequence;
use crate::task::{Remembered, Task};

impl<A: Arithmetic, S: Storage<A, N, T::Memory>, T: Task, const N: usize> Batch<A, S, T, N> {
    /// As [`new`](Self::new), for this task with its parameters, and the errors of
    /// [`set_all_params`](Self::set_all_params).
    pub fn with_task(seed: impl Into<SeedSequence>, task: T, storage: S) -> Result<Self, Error> {
        let seed = seed.into();
        let mut batch = Self::new(seed.clone(), storage)?;
        let settings = &mut batch.settings;
        (settings.task, settings.bounds) = (task, task.reset_bounds());
        settings.max_steps = task.max_steps();
        batch.set_all_params(task.params().cast())?;
        batch.reset_with_seed(seed);
        Ok(batch)
    }

    /// The task.
    #[must_use]
    pub fn task(&self) -> &T {
        &self.settings.task
    }

    /// Sets the task of all acrobots for the next steps and resets.
    pub fn set_task(&mut self, task: T) {
        self.settings.task = task;
    }

    /// What the task remembers of acrobot `index`, or [`Error::NoSuchIndex`].
    pub fn memory(&self, index: usize) -> Result<Remembered<T, A::Scalar>, Error> {
        let (block, _) = self.block_and_rng(index)?;
        Ok(block.memory(index % N))
    }

    /// Sets what the task remembers of acrobot `index`.
    ///
    /// # Errors
    ///
    /// [`Error::NoSuchIndex`], and those of [`Task::check_memory`].
    pub fn set_memory(
        &mut self,
        index: usize,
        memory: Remembered<T, A::Scalar>,
    ) -> Result<(), Error> {
        self.settings.task.check_memory(&memory)?;
        let len = self.len();
        let block = self.storage.slices_mut().blocks.get_mut(index / N).filter(|_| index < len);
        block.ok_or(Error::NoSuchIndex { index, len })?.set_memory(index % N, &memory);
        Ok(())
    }
}
