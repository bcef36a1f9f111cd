//! Where a batch writes its results.

use crate::error::Error;

/// Where a step of a [`Batch`](super::Batch) writes its results. Each slice has one element for each acrobot.
#[derive(Debug)]
pub struct StepBuffers<'a> {
    /// −1, or 0 for the step that reaches the goal and for one that only resets.
    pub rewards: &'a mut [f32],
    /// Whether the new state is in the goal.
    pub terminated: &'a mut [bool],
    /// Whether the time limit is reached.
    pub truncated: &'a mut [bool],
    /// What the agents see of the new states.
    pub observations: Observations<'a>,
    /// The last observations of the episodes that this step ended, with [`Autoreset::SameStep`](super::Autoreset::SameStep) only. Elements of
    /// other acrobots stay as they are.
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

impl StepBuffers<'_> {
    /// The buffers of the acrobots before an index, and of the others.
    #[cfg(feature = "rayon")]
    pub(super) fn split_at(self, index: usize) -> (Self, Self) {
        let (rewards1, rewards2) = self.rewards.split_at_mut(index);
        let (terminated1, terminated2) = self.terminated.split_at_mut(index);
        let (truncated1, truncated2) = self.truncated.split_at_mut(index);
        let (observations1, observations2) = self.observations.split_at(index);
        let (finals1, finals2) = self.final_observations.split_at(index);
        let before = Self {
            rewards: rewards1,
            terminated: terminated1,
            truncated: truncated1,
            observations: observations1,
            final_observations: finals1,
        };
        let after = Self {
            rewards: rewards2,
            terminated: terminated2,
            truncated: truncated2,
            observations: observations2,
            final_observations: finals2,
        };
        (before, after)
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
    #[cfg(feature = "rayon")]
    pub(super) fn split_at(self, index: usize) -> (Self, Self) {
        match self {
            Self::None => (Self::None, Self::None),
            Self::Rows(rows) => {
                let (before, after) = rows.split_at_mut(index);
                (Self::Rows(before), Self::Rows(after))
            }
            Self::Columns(columns) => {
                let mut halves = columns.map(|column| column.split_at_mut(index));
                let before = halves.each_mut().map(|(before, _)| core::mem::take(before));
                let after = halves.map(|(_, after)| after);
                (Self::Columns(before), Self::Columns(after))
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

    /// Writes the six numbers of one acrobot, if it is in the batch.
    pub(super) fn write(&mut self, index: usize, row: [f32; 6]) {
        match self {
            Self::None => {}
            Self::Rows(rows) => {
                if let Some(to) = rows.get_mut(index) {
                    *to = row;
                }
            }
            Self::Columns(columns) => {
                for (column, x) in columns.iter_mut().zip(row) {
                    if let Some(to) = column.get_mut(index) {
                        *to = x;
                    }
                }
            }
        }
    }
}

/// Rejects a slice of another length.
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
