//! A range of parameters, to draw from.

use rand_core::Rng;

use crate::error::Error;
use crate::math::Real;
use crate::numpy::uniform;
use crate::physics::Params;

/// A range for each parameter: domain randomization.
///
/// ```
/// use acrobot::Params;
/// use acrobot::numpy::Pcg64;
/// use acrobot::task::ParamsRange;
///
/// let heavy = Params { mass2: 1.1, ..Params::<f64>::DEFAULT };
/// let drawn = ParamsRange::new(Params::DEFAULT, heavy)?.draw(&mut Pcg64::new(42));
/// assert!((1.0..=1.1).contains(&drawn.mass2) && drawn.length1 == 1.0);
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ParamsRange<S = f64> {
    low: Params<S>,
    high: Params<S>,
}

impl<S: Real> ParamsRange<S> {
    /// The range from `low` to `high`. A parameter that is equal in both is fixed.
    ///
    /// # Errors
    ///
    /// Those of [`Params::validate`], [`Error::ReversedRange`] for a parameter whose `low` is above
    /// its `high`, [`Error::OutOfRange`] for an infinite width, and [`Error::DifferentDynamics`].
    pub fn new(low: Params<S>, high: Params<S>) -> Result<Self, Error> {
        low.validate()?;
        high.validate()?;
        for ((name, low, unit, _), (_, high, ..)) in low.fields().into_iter().zip(high.fields()) {
            let (low, high) = (low.to_f64(), high.to_f64());
            if low > high {
                return Err(Error::ReversedRange { name, low, high, unit });
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
    pub const fn low(&self) -> &Params<S> {
        &self.low
    }

    /// The upper bounds.
    #[must_use]
    pub const fn high(&self) -> &Params<S> {
        &self.high
    }

    /// Draws each parameter uniformly, in the order of the fields. A fixed one draws nothing.
    pub fn draw<R: Rng + ?Sized>(&self, rng: &mut R) -> Params<S> {
        self.low.zip(&self.high, |low, high| {
            if low == high {
                return low;
            }
            // At most `high`: `uniform` adds at most the exact width, and rounding keeps the order.
            S::from_f64(uniform(rng, low.to_f64(), high.to_f64()))
        })
    }
}
