//! Errors: what was wrong with an input.

use core::fmt;

/// Why a coder or a learner was not built.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A number is outside its range or not a number.
    OutOfRange {
        /// The field or argument.
        name: &'static str,
        /// The value given.
        value: f32,
        /// The rule.
        rule: &'static str,
    },
    /// A count does not fit the others.
    Count {
        /// What is counted.
        name: &'static str,
        /// The count given.
        value: usize,
        /// The rule, to be read before `limit`.
        rule: &'static str,
        /// The number after the rule.
        limit: usize,
    },
}

impl Error {
    /// Rejects a count unless it `fits`.
    pub(crate) fn unless(
        fits: bool,
        name: &'static str,
        value: usize,
        rule: &'static str,
        limit: usize,
    ) -> Result<(), Self> {
        if fits {
            return Ok(());
        }
        Err(Self::Count {
            name,
            value,
            rule,
            limit,
        })
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::OutOfRange { name, value, rule } => {
                write!(f, "{name} must be {rule}, got {value}")
            }
            Self::Count {
                name,
                value,
                rule,
                limit,
            } => write!(f, "{name} must be {rule} {limit}, got {value}"),
        }
    }
}

impl core::error::Error for Error {}

/// Why bytes were rejected as weights. The learner is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LoadError {
    /// The bytes do not begin as saved weights do.
    Magic,
    /// Another version of the format.
    Version {
        /// The version in the bytes.
        found: u32,
        /// The version that this code reads.
        expected: u32,
    },
    /// Too few or too many bytes, or a table of another size.
    Size {
        /// The bytes given, or that the header counts.
        found: usize,
        /// The bytes that this learner's weights take, header included.
        expected: usize,
    },
    /// The weights of a learner with other features, for which they mean something else.
    Features {
        /// The fingerprint in the bytes.
        found: u32,
        /// The fingerprint of this learner's features.
        expected: u32,
    },
    /// A weight that is infinite or NaN.
    NotFinite {
        /// Its index among the weights, counted from 0.
        index: usize,
    },
    /// The bytes changed since they were saved.
    Checksum {
        /// The checksum in the bytes.
        found: u32,
        /// The checksum computed from the bytes.
        expected: u32,
    },
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Magic => write!(f, "weights must begin with the bytes TILE"),
            Self::Version { found, expected } => {
                write!(f, "weights must have version {expected}, got {found}")
            }
            Self::Size { found, expected } => {
                write!(f, "weights must have {expected} bytes, got {found}")
            }
            Self::Features { found, expected } => {
                write!(
                    f,
                    "weights must be for features {expected:08x}, got {found:08x}"
                )
            }
            Self::NotFinite { index } => write!(f, "weight {index} must be a finite number"),
            Self::Checksum { found, expected } => write!(
                f,
                "damaged weights: the checksum must be {expected:08x}, got {found:08x}"
            ),
        }
    }
}

impl core::error::Error for LoadError {}
