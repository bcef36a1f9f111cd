//! What the host's parts refuse.

use core::fmt;
use std::string::String;

/// Why an environment cannot be made or shown.
///
/// ```
/// use acrobot::env::{Env, Error, make};
///
/// let mut env = make("Acrobot-v1")?;
/// assert_eq!(env.render(), Err(Error::NoRenderMode));
/// # Ok::<(), Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// No environment has this name.
    UnknownId {
        /// What was asked for.
        id: String,
        /// The known one that is nearest to it.
        nearest: &'static str,
        /// All known ones.
        known: &'static [&'static str],
    },
    /// A picture was asked of an environment that was made for none.
    NoRenderMode,
    /// A parameter that does not fit.
    Invalid(crate::Error),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownId { id, nearest, known } => write!(
                f,
                "there is no environment {id:?}; did you mean {nearest:?}? Known are {}",
                known.join(" and ")
            ),
            Self::NoRenderMode => write!(
                f,
                "the render mode is None; make the environment with the render mode RgbArray, Ansi or \
                 Human to render it"
            ),
            Self::Invalid(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for Error {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Invalid(error) => Some(error),
            _ => None,
        }
    }
}

impl From<crate::Error> for Error {
    fn from(error: crate::Error) -> Self {
        Self::Invalid(error)
    }
}
