//! A range of parameters, to draw from.

use rand_core::Rng;

use super::friction::{self, Friction, Frictionless};
use super::params::Params;
use crate::error::Error;
use crate::math::Real;
use crate::numpy::uniform;

/// A range for each parameter, to draw from: domain randomization.
///
/// ```
/// use acrobot::Params;
/// use acrobot::numpy::Pcg64;
/// use acrobot::physics::ParamsRange;
///
/// let params = Params::<f64>::DEFAULT;
/// // Masses within 10 % of Gymnasium's.
/// let range = ParamsRange::new(
///     Params { mass1: 0.9, mass2: 0.9, ..params },
///     Params { mass1: 1.1, mass2: 1.1, ..params },
/// )?;
/// let drawn = range.draw(&mut Pcg64::new(42));
/// assert!((0.9..=1.1).contains(&drawn.mass1) && drawn.length1 == 1.0);
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ParamsRange<S = f64, F = Frictionless> {
    low: Params<S, F>,
    high: Params<S, F>,
}

impl<S: Real, F: Friction<S, Of<S> = F>> ParamsRange<S, F> {
    /// The range from `low` to `high`. A parameter that is equal in both is fixed.
    ///
    /// # Errors
    ///
    /// Those of [`Params::validate`], [`Error::ReversedRange`] for a parameter whose `low` is above its `high`,
    /// [`Error::OutOfRange`] for a range so wide that its width is infinite, and [`Error::DifferentDynamics`].
    pub fn new(low: Params<S, F>, high: Params<S, F>) -> Result<Self, Error> {
        low.validate()?;
        high.validate()?;
        let numbers = low.fields().into_iter().zip(high.fields());
        let numbers = numbers.map(|((name, low, unit, _), (_, high, ..))| (name, low, high, unit));
        let friction = friction::fields(&low.friction).zip(friction::fields(&high.friction));
        let friction = friction.map(|((name, low), (_, high))| (name, low, high, "N m s/rad"));
        for (name, low, high, unit) in numbers.chain(friction) {
            let (low, high) = (low.to_f64(), high.to_f64());
            if low > high {
                return Err(Error::ReversedRange {
                    name,
                    low,
                    high,
                    unit,
                });
            }
            let width = high - low;
            if !width.is_finite() {
                return Err(Error::OutOfRange {
                    name,
                    value: width,
                    unit,
                    rule: "a range of finite width in",
                });
            }
        }
        if low.dynamics != high.dynamics {
            return Err(Error::DifferentDynamics);
        }
        Ok(Self { low, high })
    }

    /// The lower bounds.
    #[must_use]
    pub const fn low(&self) -> &Params<S, F> {
        &self.low
    }

    /// The upper bounds.
    #[must_use]
    pub const fn high(&self) -> &Params<S, F> {
        &self.high
    }

    /// Draws each parameter uniformly, in the order of the fields of [`Params`]. A fixed one draws nothing.
    pub fn draw<R: Rng + ?Sized>(&self, rng: &mut R) -> Params<S, F> {
        let mut draw = |low: S, high: S| {
            if low == high {
                return low;
            }
            // At most `high`: `uniform` adds at most the exact width to `low`, and rounding keeps the order.
            S::from_f64(uniform(rng, low.to_f64(), high.to_f64()))
        };
        let drawn = self.low.zip(&self.high, &mut draw, Frictionless);
        drawn.with_friction(F::zip(self.low.friction, self.high.friction, draw))
    }
}
