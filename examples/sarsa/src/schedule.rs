//! Numbers that change from episode to episode.

use crate::error::Error;

/// A number that changes linearly from `start` to `end`, and stays there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// The number in the first episode, in \[0, 1\].
    pub start: f32,
    /// The number after `episodes`, in \[0, 1\].
    pub end: f32,
    /// Episodes from `start` to `end`; 0 for `end` immediately.
    pub episodes: u32,
}

impl Schedule {
    /// The same number in every episode.
    #[must_use]
    pub const fn constant(value: f32) -> Self {
        Self {
            start: value,
            end: value,
            episodes: 0,
        }
    }

    /// The number in an episode, counted from 0.
    pub(crate) fn at(&self, episode: u32) -> f32 {
        if episode >= self.episodes {
            return self.end;
        }
        let passed = episode as f32 / self.episodes as f32;
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
