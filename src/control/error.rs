//! The error type of the module.

use core::fmt;

use crate::error::Error;

/// Why a model, a force or a regulator cannot be computed. `Display` names the value, its unit and
/// the rule.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ControlError {
    /// An argument was rejected.
    Invalid(Error),
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
    /// The weights do not see a motion that persists: one that needs more than 2⁴⁰ steps to vanish.
    NotDetectable,
    /// A plan does not fit into memory.
    #[cfg(feature = "alloc")]
    OutOfMemory {
        /// The number of knots.
        knots: usize,
    },
    /// The error of a gain can be above 1e-9 of its largest element, or deviations do not vanish
    /// with the gain that the scalar rounds.
    IllConditioned {
        /// The estimated error of the gain, relative to its largest element.
        error: f64,
    },
}

impl fmt::Display for ControlError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Invalid(error) => error.fmt(f),
            Self::NotFinite { name, value } => {
                write!(f, "{name} must be finite in each element, got {value}")
            }
            Self::NotSymmetric { name, upper, lower } => write!(
                f,
                "{name} must be symmetric, got {upper} and {lower} on both sides of the diagonal"
            ),
            Self::NotSemidefinite { name, value } => write!(
                f,
                "{name} must be positive semidefinite, got elements of up to {value} in size after \
                the elimination of its positive pivots"
            ),
            Self::NotInEquilibrium { rate, largest } => write!(
                f,
                "the state must be in equilibrium, with velocities of 0 and accelerations of at \
                most {largest:.1e} rad/s², got {rate}"
            ),
            Self::NotStabilizable => write!(
                f,
                "the torque must reach each motion that grows or persists, but does not reach one"
            ),
            Self::NotDetectable => {
                write!(f, "q must weight each motion that persists, but does not weight one")
            }
            #[cfg(feature = "alloc")]
            Self::OutOfMemory { knots } => {
                write!(f, "a plan must fit into memory, got {knots} knots")
            }
            Self::IllConditioned { error } => {
                write!(f, "the relative error of the gain must be at most 1e-9, got {error:e}")
            }
        }
    }
}

impl core::error::Error for ControlError {}

impl From<Error> for ControlError {
    fn from(error: Error) -> Self {
        Self::Invalid(error)
    }
}
