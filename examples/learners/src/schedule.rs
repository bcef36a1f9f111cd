//! Numbers that change from episode to episode.

use crate::error::Error;

/// How long learning takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Budget {
    /// This many episodes.
    Episodes(u32),
    /// This many steps, and the rest of the episode in which they end.
    Steps(u32),
}

/// A number that changes linearly from `start` to `end`, and stays there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// The number in the first episode, in \[0, 1\].
    pub start: f32,
    /// The number after `over`, in \[0, 1\].
    pub end: f32,
    /// The time from `start` to `end`; 0 for `end` immediately.
    pub over: Budget,
}

impl Schedule {
    /// The same number in every episode.
    #[must_use]
    pub const fn constant(value: f32) -> Self {
        Self {
            start: value,
            end: value,
            over: Budget::Episodes(0),
        }
    }

    /// The number after this many episodes with this many steps in all.
    pub(crate) fn at(&self, episodes: u32, steps: u32) -> f32 {
        let (passed, all) = match self.over {
            Budget::Episodes(all) => (episodes, all),
            Budget::Steps(all) => (steps, all),
        };
        if passed >= all {
            return self.end;
        }
        let passed = passed as f32 / all as f32;
        self.start + (self.end - self.start) * passed
    }

    /// Rejects a schedule that leaves \[0, 1\].
    pub(crate) fn check(&self, names: [&'static str; 2]) -> Result<(), Error> {
        unit_interval(names[0], self.start)?;
        unit_interval(names[1], self.end)
    }
}

/// Rejects a number outside \[0, 1\], also NaN.
pub(crate) fn unit_interval(name: &'static str, value: f32) -> Result<(), Error> {
    if (0.0..=1.0).contains(&value) {
        return Ok(());
    }
    Err(Error::OutOfRange {
        name,
        value,
        rule: "between 0 and 1",
    })
}
