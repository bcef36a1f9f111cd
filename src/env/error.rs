//! Errors of environments.

use core::fmt;
use std::string::String;

/// Why an environment cannot be made or rendered.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// No environment has this id.
    UnknownId(String),
    /// The environment was made without a render mode.
    NoRenderMode,
    /// A parameter was rejected.
    Invalid(crate::error::Error),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownId(id) => {
                write!(f, r#"the id must be "Acrobot-v1" or "Acrobot-v0", got {id:?}"#)
            }
            Self::NoRenderMode => {
                write!(f, "the render mode must be RgbArray, Ansi or Human to render, got None")
            }
            Self::Invalid(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for Error {}

impl From<crate::error::Error> for Error {
    fn from(error: crate::error::Error) -> Self {
        Self::Invalid(error)
    }
}
