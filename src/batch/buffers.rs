//! Where a batch writes its results.

use crate::error::Error;

/// Where a step of a [`Batch`](super::Batch) writes its results, one element for each acrobot.
///
/// ```
/// # use acrobot::Fast;
/// # use acrobot::batch::{Batch, BatchMemory, Block, StepBuffers};
/// # use acrobot::numpy::Pcg64;
/// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
/// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
/// let (mut rewards, mut terminated, mut truncated) = ([0.0; 3], [false; 3], [false; 3]);
/// let mut rows = [[0.0; 6]; 3];
/// let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated);
/// batch.step_into(&[2_u8; 3], buffers.with_observations(&mut rows))?;
/// assert_eq!(rows[0][4], batch.state(0)?.dtheta1); // rad/s
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub struct StepBuffers<'a, O = [f32; 6]> {
    /// The rewards; 0 where an acrobot was only reset.
    pub rewards: &'a mut [f32],
    /// Whether the task ended each episode.
    pub terminated: &'a mut [bool],
    /// Whether the time limit is reached.
    pub truncated: &'a mut [bool],
    /// The [observations](crate::task::Task::Observation) of the new states. With `None` they are
    /// not computed.
    pub observations: Option<&'a mut [O]>,
    /// With [`Autoreset::SameStep`](super::Autoreset::SameStep), the last observations of episodes
    /// that this step ended. Others are not written.
    pub final_observations: Option<&'a mut [O]>,
}

impl<'a, O> StepBuffers<'a, O> {
    /// Buffers without observations.
    #[must_use]
    pub fn new(
        rewards: &'a mut [f32],
        terminated: &'a mut [bool],
        truncated: &'a mut [bool],
    ) -> Self {
        Self { rewards, terminated, truncated, observations: None, final_observations: None }
    }

    /// The same buffers, and one for the observations.
    #[must_use]
    pub fn with_observations(mut self, observations: &'a mut [O]) -> Self {
        self.observations = Some(observations);
        self
    }

    /// The same buffers, and one for the last observations of episodes that end.
    ///
    /// ```
    /// # use acrobot::batch::StepBuffers;
    /// let (mut rewards, mut terminated, mut truncated) = ([0.0; 3], [false; 3], [false; 3]);
    /// let (mut rows, mut last) = ([[0.0; 6]; 3], [[0.0; 6]; 3]);
    /// let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated)
    ///     .with_observations(&mut rows)
    ///     .with_final_observations(&mut last);
    /// assert!(buffers.final_observations.is_some());
    /// ```
    #[must_use]
    pub fn with_final_observations(mut self, final_observations: &'a mut [O]) -> Self {
        self.final_observations = Some(final_observations);
        self
    }

    /// Splits off the buffers of the first `n` acrobots, or of all if there are fewer.
    #[cfg(feature = "rayon")]
    pub(super) fn take(&mut self, n: usize) -> Self {
        let rows = |rows: &mut Option<_>| rows.as_mut().map(|rows| take_mut(rows, n));
        Self {
            rewards: take_mut(&mut self.rewards, n),
            terminated: take_mut(&mut self.terminated, n),
            truncated: take_mut(&mut self.truncated, n),
            observations: rows(&mut self.observations),
            final_observations: rows(&mut self.final_observations),
        }
    }

    pub(super) fn check(&self, len: usize) -> Result<(), Error> {
        check_length("rewards", self.rewards.len(), len)?;
        check_length("terminated", self.terminated.len(), len)?;
        check_length("truncated", self.truncated.len(), len)?;
        if let Some(rows) = &self.observations {
            check_length("observations", rows.len(), len)?;
        }
        if let Some(rows) = &self.final_observations {
            check_length("final_observations", rows.len(), len)?;
        }
        Ok(())
    }
}

/// Splits off the first `n` elements of a slice, or all if there are fewer. Not `chunks`: some
/// compilers keep the panic of its division by `n`.
#[inline(always)]
pub(super) fn take<'a, T>(rest: &mut &'a [T], n: usize) -> &'a [T] {
    let first = rest.split_off(..n);
    first.unwrap_or_else(|| core::mem::take(rest))
}

/// [`take`] for a mutable slice.
#[inline(always)]
pub(super) fn take_mut<'a, T>(rest: &mut &'a mut [T], n: usize) -> &'a mut [T] {
    let first = rest.split_off_mut(..n);
    first.unwrap_or_else(|| core::mem::take(rest))
}

/// Writes one element, if `index` is in range.
pub(super) fn set<T>(to: &mut [T], index: usize, x: T) {
    if let Some(to) = to.get_mut(index) {
        *to = x;
    }
}

pub(super) fn check_length(name: &'static str, len: usize, expected: usize) -> Result<(), Error> {
    match len == expected {
        true => Ok(()),
        false => Err(Error::WrongLength { name, len, expected }),
    }
}
