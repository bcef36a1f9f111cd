//! The threads of a batch.

use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;

/// Threads, and the process that started them: a child made by `fork` would wait for them forever.
pub struct Pool {
    process: u32,
    threads: Option<rayon::ThreadPool>,
}

impl Pool {
    pub fn of_this_process(
        pool: &mut Option<Self>,
        threads: usize,
    ) -> PyResult<&rayon::ThreadPool> {
        let process = std::process::id();
        let is_ours = pool.as_ref().is_some_and(|pool| pool.process == process);
        if !is_ours {
            let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let error = |error: rayon::ThreadPoolBuildError| PyOSError::new_err(error.to_string());
            let threads = Some(builder.build().map_err(error)?);
            *pool = Some(Self { process, threads });
        }
        let threads = pool.as_ref().and_then(|pool| pool.threads.as_ref());
        threads.ok_or_else(|| PyRuntimeError::new_err("there are no threads"))
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
