//! Where a batch writes its results.

use crate::error::Error;

/// Where a step of a [`Batch`](super::Batch) writes its results. Each slice has one element for each acrobot.
#[derive(Debug)]
#[non_exhaustive]
pub struct StepBuffers<'a> {
    /// −1, or 0 if the acrobot terminated or was only reset.
    pub rewards: &'a mut [f32],
    /// Whether the new state is a goal state.
    pub terminated: &'a mut [bool],
    /// Whether the time limit is reached.
    pub truncated: &'a mut [bool],
    /// The observations of the new states.
    pub observations: Observations<'a>,
    /// With [`Autoreset::SameStep`](super::Autoreset::SameStep), the last observations of the episodes that this step
    /// ended. Elements of other acrobots are not written.
    pub final_observations: Observations<'a>,
}

/// Where a [`Batch`](super::Batch) writes [observations](crate::Observation).
#[derive(Debug)]
pub enum Observations<'a> {
    /// Nowhere: they are not computed.
    None,
    /// Six numbers for each acrobot.
    Rows(&'a mut [[f32; 6]]),
    /// Six slices with one number for each acrobot.
    Columns([&'a mut [f32]; 6]),
}

impl<'a> StepBuffers<'a> {
    /// Buffers without observations.
    #[must_use]
    pub fn new(
        rewards: &'a mut [f32],
        terminated: &'a mut [bool],
        truncated: &'a mut [bool],
    ) -> Self {
        Self {
            rewards,
            terminated,
            truncated,
            observations: Observations::None,
            final_observations: Observations::None,
        }
    }

    /// The same buffers, and one for the observations.
    #[must_use]
    pub fn with_observations(self, observations: Observations<'a>) -> Self {
        Self {
            observations,
            ..self
        }
    }

    /// The same buffers, and one for the last observations of episodes that end.
    #[must_use]
    pub fn with_final_observations(self, final_observations: Observations<'a>) -> Self {
        Self {
            final_observations,
            ..self
        }
    }

    /// Splits off the buffers of the first `n` acrobots, or of all if there are fewer.
    #[cfg(feature = "rayon")]
    pub(super) fn take(&mut self, n: usize) -> Self {
        Self {
            rewards: take_mut(&mut self.rewards, n),
            terminated: take_mut(&mut self.terminated, n),
            truncated: take_mut(&mut self.truncated, n),
            observations: self.observations.take(n),
            final_observations: self.final_observations.take(n),
        }
    }

    pub(super) fn check(&self, len: usize) -> Result<(), Error> {
        check_length("rewards", self.rewards.len(), len)?;
        check_length("terminated", self.terminated.len(), len)?;
        check_length("truncated", self.truncated.len(), len)?;
        self.observations.check("observations", len)?;
        self.final_observations.check("final_observations", len)
    }
}

impl Observations<'_> {
    /// Splits off the observations of the first `n` acrobots, or of all if there are fewer.
    #[inline(always)]
    pub(super) fn take(&mut self, n: usize) -> Self {
        match self {
            Self::None => Self::None,
            Self::Rows(rows) => Self::Rows(take_mut(rows, n)),
            Self::Columns(columns) => {
                Self::Columns(columns.each_mut().map(|column| take_mut(column, n)))
            }
        }
    }

    pub(super) fn check(&self, name: &'static str, len: usize) -> Result<(), Error> {
        match self {
            Self::None => Ok(()),
            Self::Rows(rows) => check_length(name, rows.len(), len),
            Self::Columns(columns) => columns
                .iter()
                .try_for_each(|column| check_length(name, column.len(), len)),
        }
    }

    /// Writes the six numbers of one acrobot, if `index` is in range.
    pub(super) fn write(&mut self, index: usize, row: [f32; 6]) {
        match self {
            Self::None => {}
            Self::Rows(rows) => set(rows, index, row),
            Self::Columns(columns) => {
                for (column, x) in columns.iter_mut().zip(row) {
                    set(column, index, x);
                }
            }
        }
    }
}

/// Splits off the first `n` elements of a slice, or all if there are fewer. Not `chunks`, which divides by `n`: some
/// compilers keep the panic of a division by zero.
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

/// Rejects a slice whose length is not `expected`.
pub(super) fn check_length(name: &'static str, len: usize, expected: usize) -> Result<(), Error> {
    if len == expected {
        Ok(())
    } else {
        Err(Error::WrongLength {
            name,
            len,
            expected,
        })
    }
}
