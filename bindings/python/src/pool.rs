//! The threads of a batch.

use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Threads, and the process that started them: a child made by `fork` would wait for them forever.
#[derive(Default)]
pub struct Pool {
    process: u32,
    threads: Option<ThreadPool>,
}

impl Pool {
    pub fn of_this_process(&mut self, count: usize) -> PyResult<&ThreadPool> {
        if self.process != std::process::id() {
            *self = Self { process: std::process::id(), threads: None };
        }
        match &mut self.threads {
            Some(threads) => Ok(threads),
            none => {
                let threads = ThreadPoolBuilder::new().num_threads(count).build();
                Ok(none.insert(threads.map_err(|error| PyOSError::new_err(error.to_string()))?))
            }
        }
    }
}

impl Drop for Pool {
    /// In a child made by `fork`, ending the parent's threads could wait forever too.
    fn drop(&mut self) {
        if self.process != std::process::id() {
            std::mem::forget(self.threads.take());
        }
    }
}
