//! What is refused, and why.

use core::fmt;

/// Why a coder or a learner was not built.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A number outside of what is allowed.
    OutOfRange {
        /// What the number is.
        name: &'static str,
        /// The number itself.
        value: f32,
        /// Its unit; empty for a pure number.
        unit: &'static str,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A count that does not fit the others.
    Count {
        /// What is counted.
        name: &'static str,
        /// How many there are.
        value: usize,
        /// What is allowed.
        allowed: &'static str,
        /// The number that `allowed` speaks of.
        limit: usize,
    },
}

impl Error {
    /// Refuses a count unless `fits`.
    pub(crate) fn unless(
        fits: bool,
        name: &'static str,
        value: usize,
        allowed: &'static str,
        limit: usize,
    ) -> Result<(), Self> {
        let error = Self::Count {
            name,
            value,
            allowed,
            limit,
        };
        if fits { Ok(()) } else { Err(error) }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::OutOfRange {
                name,
                value,
                unit,
                allowed,
            } => {
                let space = if unit.is_empty() { "" } else { " " };
                write!(f, "{name} is {value}{space}{unit}; allowed is {allowed}")
            }
            Self::Count {
                name,
                value,
                allowed,
                limit,
            } => write!(f, "{value} {name}; allowed is {allowed} {limit}"),
        }
    }
}

impl core::error::Error for Error {}

/// Why bytes were not taken as weights; the learner is as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LoadError {
    /// They do not begin as saved weights do.
    Magic,
    /// Saved by another version of the format.
    Version {
        /// Of the bytes.
        found: u32,
        /// That this code reads.
        expected: u32,
    },
    /// Too few or too many bytes, or a table of another size.
    Size {
        /// Bytes given, or that the header says there are.
        found: usize,
        /// Bytes that this learner's weights take, header included.
        expected: usize,
    },
    /// Of a learner with other features: the same weights would mean something else.
    Features {
        /// Fingerprint in the bytes.
        found: u32,
        /// Fingerprint of this learner's features.
        expected: u32,
    },
    /// A weight that is infinite or NaN.
    NotFinite {
        /// Its place among the weights, counted from 0.
        index: usize,
    },
    /// Changed since they were saved.
    Checksum {
        /// In the bytes.
        found: u32,
        /// Computed from the bytes.
        expected: u32,
    },
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Magic => write!(f, "these are no weights of this learner"),
            Self::Version { found, expected } => {
                write!(f, "weights of version {found}; allowed is {expected}")
            }
            Self::Size { found, expected } => {
                write!(f, "weights of {found} bytes; allowed is {expected}")
            }
            Self::Features { found, expected } => write!(
                f,
                "weights of features {found:08x}; allowed is {expected:08x}"
            ),
            Self::NotFinite { index } => {
                write!(
                    f,
                    "weight {index} is not finite; allowed are finite numbers"
                )
            }
            Self::Checksum { found, expected } => write!(
                f,
                "damaged weights: checksum {found:08x}, computed {expected:08x}"
            ),
        }
    }
}

impl core::error::Error for LoadError {}
