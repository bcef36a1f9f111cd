//! The error type.

use core::fmt;

/// Why an input was rejected, or why there is no result. `Display` names the value, its unit and
/// the rule: "dt must be finite and above 0 s, got 0".
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Error {
    /// A number is outside its range, infinite or NaN.
    OutOfRange {
        /// The field or argument.
        name: &'static str,
        /// The value given, in `unit`.
        value: f64,
        /// The SI unit, such as `"rad/s"`.
        unit: &'static str,
        /// The rule, before the unit: `"finite and above 0"`.
        rule: &'static str,
    },
    /// A batch has no memory for the parameters of each acrobot.
    SharedParams,
    /// A batch has no acrobots.
    EmptyBatch,
    /// A batch or a plan does not fit into memory.
    #[cfg(feature = "alloc")]
    OutOfMemory {
        /// What it has: `"acrobots"` or `"knots"`.
        of: &'static str,
        /// Their number.
        len: usize,
    },
    /// A slice does not have the length that a batch needs.
    WrongLength {
        /// The argument.
        name: &'static str,
        /// Its length.
        len: usize,
        /// The length that it must have.
        expected: usize,
    },
    /// A batch has no acrobot with this index.
    NoSuchIndex {
        /// The index given, counted from 0.
        index: usize,
        /// The number of acrobots.
        len: usize,
    },
    /// An action number other than 0, 1 and 2.
    UnknownAction(u8),
    /// An element of a matrix or a vector is infinite or NaN.
    NotFinite {
        /// The argument or the result.
        name: &'static str,
        /// The first element that is not finite, in SI units.
        value: f64,
    },
    /// A matrix of weights is not symmetric. Differences of up to 16 machine epsilons of its
    /// largest element do not count.
    NotSymmetric {
        /// The argument.
        name: &'static str,
        /// An element above the diagonal.
        upper: f64,
        /// Its mirror image below the diagonal.
        lower: f64,
    },
    /// A matrix of weights is not positive semidefinite. Up to 16 machine epsilons of its largest
    /// element count as 0.
    NotSemidefinite {
        /// The argument.
        name: &'static str,
        /// The largest absolute value after the elimination of all positive pivots.
        value: f64,
    },
    /// The state of a regulator is not an equilibrium under the torque.
    NotInEquilibrium {
        /// The first velocity that is not 0, rad/s, or acceleration above the largest.
        rate: f64,
        /// The largest acceleration of this machine, rad/s².
        largest: f64,
    },
    /// The torque does not reach a motion that grows or persists, so no regulator makes it vanish.
    NotStabilizable,
    /// The weights do not see a motion that persists: one that needs more than 2⁴⁰ steps to vanish,
    /// or in continuous time about 2⁴⁰ times as long as the fastest.
    NotDetectable,
    /// The measured angles do not show a motion that grows or persists, so no filter follows it.
    NotObservable,
    /// The noise of a filter's model does not excite a motion that persists.
    NotExcited,
    /// The error of a gain can be above 1e-9 of its largest element, or deviations do not vanish
    /// with the gain that the scalar rounds.
    IllConditioned {
        /// The estimated error of the gain, relative to its largest element.
        error: f64,
    },
    /// No plan ends in a state from which the regulator holds.
    NoPlan {
        /// The number of tries.
        tries: u32,
    },
    /// A text that is not a seed.
    #[cfg(feature = "std")]
    MalformedSeed {
        /// The first character that is not a decimal digit or beyond the largest number of digits;
        /// `None` for an empty text.
        found: Option<char>,
        /// Its position, counted from 1.
        position: usize,
    },
}

impl Error {
    /// The field or argument that was rejected; empty for an error that has none.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::OutOfRange { name, .. }
            | Self::WrongLength { name, .. }
            | Self::NotFinite { name, .. }
            | Self::NotSymmetric { name, .. }
            | Self::NotSemidefinite { name, .. } => name,
            Self::UnknownAction(_) => "action",
            _ => "",
        }
    }

    /// The message with another [name](Self::name), such as that of another language.
    pub fn named(&self, name: impl fmt::Display) -> impl fmt::Display {
        Named(*self, name)
    }

    /// The kind of error. `Display` adds the numbers, and needs [more flash than the
    /// crate](crate::guide::embedded_figures#what-adds-flash).
    #[must_use]
    pub const fn message(&self) -> &'static str {
        match self {
            Self::OutOfRange { .. } => "a number is out of range",
            Self::SharedParams => "a batch must have memory for the parameters of each acrobot",
            Self::EmptyBatch => "a batch must have at least 1 acrobot",
            #[cfg(feature = "alloc")]
            Self::OutOfMemory { .. } => "a batch and a plan must fit into memory",
            Self::WrongLength { .. } => "an argument has the wrong length",
            Self::NoSuchIndex { .. } => "a batch has no acrobot with this index",
            Self::UnknownAction(_) => "an action must be 0, 1 or 2",
            Self::NotFinite { .. } => "each element must be finite",
            Self::NotSymmetric { .. } => "weights must be symmetric",
            Self::NotSemidefinite { .. } => "weights must be positive semidefinite",
            Self::NotInEquilibrium { .. } => "the state must be in equilibrium",
            Self::NotStabilizable => {
                "the torque must reach each motion that grows or persists, but does not reach one"
            }
            Self::NotDetectable => {
                "q must weight each motion that persists, but does not weight one"
            }
            Self::NotObservable => {
                "the measured angles must show each motion that grows or persists, but do not show \
                one"
            }
            Self::NotExcited => "w must excite each motion that persists, but does not excite one",
            Self::IllConditioned { .. } => "the relative error of the gain must be at most 1e-9",
            Self::NoPlan { .. } => "no plan ends upright",
            #[cfg(feature = "std")]
            Self::MalformedSeed { .. } => "a seed must be a number of 1 to 4300 decimal digits",
        }
    }
}

/// An error with another name of its field or argument.
struct Named<N>(Error, N);

impl<N: fmt::Display> fmt::Display for Named<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(error, name) = self;
        match *error {
            Error::OutOfRange { value, unit, rule, .. } => {
                let space = if unit.is_empty() { "" } else { " " };
                write!(f, "{name} must be {rule}{space}{unit}, got {value}")
            }
            Error::WrongLength { len, expected, .. } => {
                write!(f, "{name} must have {expected} elements, got {len}")
            }
            Error::SharedParams
            | Error::NotStabilizable
            | Error::NotDetectable
            | Error::NotObservable
            | Error::NotExcited => f.write_str(error.message()),
            Error::EmptyBatch => write!(f, "{}, got 0 generators", error.message()),
            #[cfg(feature = "alloc")]
            Error::OutOfMemory { of, len } => {
                write!(f, "all {of} must fit into memory, got {len}")
            }
            Error::NoSuchIndex { index, len } => {
                write!(f, "member index must be below {len}, got {index}")
            }
            Error::UnknownAction(number) => write!(
                f,
                "{name} must be 0 (negative torque), 1 (none) or 2 (positive), got {number}"
            ),
            Error::NotFinite { value, .. } => {
                write!(f, "{name} must be finite in each element, got {value}")
            }
            Error::NotSymmetric { upper, lower, .. } => write!(
                f,
                "{name} must be symmetric, got {upper} and {lower} on both sides of the diagonal"
            ),
            Error::NotSemidefinite { value, .. } => write!(
                f,
                "{name} must be positive semidefinite, got elements of up to {value} in size after \
                the elimination of its positive pivots"
            ),
            Error::NotInEquilibrium { rate, .. } => write!(
                f,
                "{}: at rest, accelerating at most 0.25 % of a fall, got {rate}",
                error.message()
            ),
            Error::IllConditioned { error: size } => write!(f, "{}, got {size}", error.message()),
            Error::NoPlan { tries } => write!(f, "{} in {tries} tries", error.message()),
            #[cfg(feature = "std")]
            Error::MalformedSeed { found, position } => {
                f.write_str("seed must be a number of 1 to 4300 decimal digits, got ")?;
                match found {
                    Some(found) => write!(f, "{found:?} as character {position}"),
                    None => f.write_str("an empty text"),
                }
            }
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Named(*self, self.name()).fmt(f)
    }
}

impl core::error::Error for Error {}

#[derive(Clone, Copy)]
pub(crate) enum Range {
    Finite,
    AtLeastZero,
    AboveZero,
    /// For velocity bounds, which may be infinite. NEON of 32-bit ARM treats subnormal numbers of
    /// `f32` as 0.
    AtLeastNormalF32,
    /// Finite in `f32`: for reset bounds, because initial states are `f32`.
    InF32,
}

impl Range {
    pub(crate) const fn check(
        self,
        name: &'static str,
        value: f64,
        unit: &'static str,
    ) -> Result<(), Error> {
        let is_finite = value.is_finite();
        let (holds, rule) = match self {
            Self::Finite => (is_finite, "a finite number of"),
            Self::AtLeastZero => (is_finite && value >= 0.0, "finite and at least 0"),
            Self::AboveZero => (is_finite && value > 0.0, "finite and above 0"),
            Self::AtLeastNormalF32 => (value >= f32::MIN_POSITIVE as f64, "at least 1.2e-38"),
            Self::InF32 => (value.abs() <= f32::MAX as f64, "from -3.4e38 to 3.4e38"),
        };
        match holds {
            true => Ok(()),
            false => Err(Error::OutOfRange { name, value, unit, rule }),
        }
    }
}
