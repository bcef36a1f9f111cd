//! The state.

use super::bounds::wrap;
use crate::error::{Error, Range};
use crate::math::Real;

/// The state of an acrobot: two angles and their velocities, in the order of Gymnasium's
/// `env.unwrapped.state`, also as an array.
///
/// After a step the angles are within \[−π, π\] and the velocities within their bounds. Before, a
/// state may be outside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(C)] // for bindings/abi
pub struct State<S = f64> {
    /// Angle of link 1, rad; 0 = hanging straight down, counter-clockwise positive.
    pub theta1: S,
    /// Angle of link 2 relative to link 1, rad; 0 = in line with it.
    pub theta2: S,
    /// Angular velocity of link 1, rad/s.
    pub dtheta1: S,
    /// Angular velocity of link 2 relative to link 1, rad/s.
    pub dtheta2: S,
}

impl<S> From<[S; 4]> for State<S> {
    #[inline]
    fn from([theta1, theta2, dtheta1, dtheta2]: [S; 4]) -> Self {
        Self { theta1, theta2, dtheta1, dtheta2 }
    }
}

impl<S> From<State<S>> for [S; 4] {
    #[inline]
    fn from(state: State<S>) -> Self {
        [state.theta1, state.theta2, state.dtheta1, state.dtheta2]
    }
}

impl<S: Real> State<S> {
    /// Hanging at rest: all four numbers are 0.
    pub const HANGING: Self =
        Self { theta1: S::ZERO, theta2: S::ZERO, dtheta1: S::ZERO, dtheta2: S::ZERO };

    /// Standing upright at rest: θ1 is π, the others are 0.
    pub const UPRIGHT: Self = Self { theta1: S::PI, ..Self::HANGING };

    /// The same state in another scalar. Each number is rounded to the nearest.
    #[must_use]
    #[inline]
    pub fn cast<T: Real>(self) -> State<T> {
        <[S; 4]>::from(self).map(|x| T::from_f64(x.to_f64())).into()
    }

    /// The deviation from another state, rad and rad/s. Differences of angles are wrapped to
    /// \[−π, π\], so it is continuous upright, where θ1 jumps from π to −π.
    ///
    /// ```
    /// use acrobot::State;
    ///
    /// let leaning = State::from([-3.0, 0.0, 0.0, 0.0_f64]); // beyond upright
    /// let [theta1, ..] = leaning.deviation_from(State::UPRIGHT);
    /// assert!((theta1 - 0.1416).abs() < 1e-4); // rad
    /// ```
    #[must_use]
    pub fn deviation_from(self, target: Self) -> [S; 4] {
        // Wrapped first, so that no difference overflows.
        let between = |x, y| wrap(wrap(x) - wrap(y));
        [
            between(self.theta1, target.theta1),
            between(self.theta2, target.theta2),
            self.dtheta1 - target.dtheta1,
            self.dtheta2 - target.dtheta2,
        ]
    }

    /// Checks that all four numbers are finite.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] with the first number that is not.
    pub fn validate(&self) -> Result<(), Error> {
        self.cast::<f64>().check()
    }
}

for_f32_and_f64! {
    impl State<S> {
        /// [`State::validate`], also in a `const`, where neither `?` nor `for` is allowed.
        pub(crate) const fn check(&self) -> Result<(), Error> {
            let mut fields: &[_] = &[
                ("theta1", self.theta1, "rad"),
                ("theta2", self.theta2, "rad"),
                ("dtheta1", self.dtheta1, "rad/s"),
                ("dtheta2", self.dtheta2, "rad/s"),
            ];
            while let [(name, value, unit), rest @ ..] = fields {
                if let Err(error) = Range::Finite.check(name, *value as f64, unit) {
                    return Err(error);
                }
                fields = rest;
            }
            Ok(())
        }
    }
}
