//! What the crate refuses, and why.

use core::fmt;

use crate::arithmetic::Real;

/// What was wrong with a value that was given, in which unit, and what is allowed.
///
/// A refusal changes nothing: the acrobot, its parameters and its generator stay as they were.
///
/// ```
/// use acrobot::{Acrobot, Fast, Params};
///
/// let mut acrobot = Acrobot::<Fast>::new(0);
/// let error = acrobot.set_params(Params { dt: 0.0, ..Params::default() }).unwrap_err();
/// assert_eq!(error.to_string(), "dt is 0 s; allowed is a finite number above 0");
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Error {
    /// A quantity that is not in its range, or not a number.
    OutOfRange {
        /// Which quantity, by the name of its field or argument.
        name: &'static str,
        /// What was given, in `unit`.
        value: f64,
        /// The SI unit of `value`, such as `"rad/s"`.
        unit: &'static str,
        /// What is allowed, in words.
        allowed: &'static str,
    },
    /// Start bounds of which the lower is above the upper.
    ReversedBounds {
        /// The lower bound that was given, in rad and rad/s.
        low: f64,
        /// The upper bound that was given, in rad and rad/s.
        high: f64,
    },
    /// A slice that has not one element for each acrobot of a batch.
    WrongLength {
        /// Which slice.
        name: &'static str,
        /// How many elements it has.
        found: usize,
        /// How many it has to have.
        expected: usize,
    },
    /// An action number other than 0, 1 and 2.
    UnknownAction(u8),
    /// A text that is no seed.
    #[cfg(feature = "std")]
    MalformedSeed {
        /// The first character that is not a decimal digit; none in an empty text.
        found: Option<char>,
        /// Where it stands, counted from 1.
        position: usize,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::OutOfRange {
                name,
                value,
                unit,
                allowed,
            } => write!(f, "{name} is {value} {unit}; allowed is {allowed}"),
            Self::ReversedBounds { low, high } => write!(
                f,
                "low is {low} and high is {high} (rad and rad/s); allowed is a low that is not above high"
            ),
            Self::WrongLength {
                name,
                found,
                expected,
            } => write!(f, "{name} has {found} elements; allowed is {expected}"),
            Self::UnknownAction(number) => write!(
                f,
                "action is {number}; allowed is 0 (negative torque), 1 (none) or 2 (positive)"
            ),
            #[cfg(feature = "std")]
            Self::MalformedSeed { found, position } => {
                match found {
                    Some(found) => write!(f, "seed has {found:?} as character {position}")?,
                    None => write!(f, "seed is empty")?,
                }
                write!(f, "; allowed is a decimal integer, 0 or more, of any size")
            }
        }
    }
}

impl core::error::Error for Error {}

/// The ranges that a quantity can have.
#[derive(Clone, Copy)]
pub(crate) enum Allowed {
    Finite,
    ZeroOrMore,
    AboveZero,
    /// And not beyond what an observation can show.
    AboveZeroInF32,
    /// What a start is drawn in.
    InF32,
}

impl Allowed {
    /// Refuses a `value` outside of the range.
    pub(crate) fn check<S: Real>(
        self,
        name: &'static str,
        value: S,
        unit: &'static str,
    ) -> Result<(), Error> {
        let in_f32 = value.to_f64().abs() <= f64::from(f32::MAX);
        let (holds, allowed) = match self {
            Self::Finite => (true, "any finite number"),
            Self::ZeroOrMore => (value >= S::ZERO, "a finite number, 0 or more"),
            Self::AboveZero => (value > S::ZERO, "a finite number above 0"),
            Self::AboveZeroInF32 => (
                value > S::ZERO && in_f32,
                "a number above 0 that f32 holds, up to 3.4e38",
            ),
            Self::InF32 => (in_f32, "a number that f32 holds, from -3.4e38 to 3.4e38"),
        };
        if holds && value.is_finite() {
            return Ok(());
        }
        let value = value.to_f64();
        Err(Error::OutOfRange {
            name,
            value,
            unit,
            allowed,
        })
    }
}
