//! Numbers that fall from episode to episode.

use crate::error::Error;

/// A number that is multiplied by `factor` after each episode and stays at `floor`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// In the first episode.
    pub start: f32,
    /// From one episode to the next, in \[0, 1\].
    pub factor: f32,
    /// Where it stays, in \[0, `start`\].
    pub floor: f32,
}

impl Schedule {
    /// The same number in every episode.
    #[must_use]
    pub const fn constant(value: f32) -> Self {
        Self {
            start: value,
            factor: 1.0,
            floor: value,
        }
    }

    /// What comes after an episode with `value`.
    pub(crate) fn next(&self, value: f32) -> f32 {
        let next = value * self.factor;
        if next > self.floor { next } else { self.floor }
    }

    /// Refuses what does not fall within \[0, 1\].
    pub(crate) fn check(&self, names: [&'static str; 3]) -> Result<(), Error> {
        unit_interval(names[0], self.start)?;
        unit_interval(names[1], self.factor)?;
        if (0.0..=self.start).contains(&self.floor) {
            return Ok(());
        }
        Err(Error::OutOfRange {
            name: names[2],
            value: self.floor,
            unit: "",
            allowed: "0 to its start",
        })
    }
}

/// Refuses what lies outside of \[0, 1\], NaN included.
pub(crate) fn unit_interval(name: &'static str, value: f32) -> Result<(), Error> {
    if (0.0..=1.0).contains(&value) {
        return Ok(());
    }
    Err(Error::OutOfRange {
        name,
        value,
        unit: "",
        allowed: "0 to 1",
    })
}
