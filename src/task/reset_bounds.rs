//! The bounds of initial states.

use rand_core::Rng;

use crate::error::{Error, Range};
use crate::numpy::uniform;
use crate::physics::State;

/// The bounds between which a reset draws each number of an initial state, rad and rad/s.
///
/// ```
/// use acrobot::{Acrobot, Fast, numpy::Pcg64, task::ResetBounds};
///
/// let mut acrobot = Acrobot::<Fast>::new(0);
/// acrobot.reset_with(ResetBounds::new(0.3, 0.4)?.into());
/// assert!((0.3..=0.4).contains(&acrobot.state().theta1)); // rad
/// assert_eq!(ResetBounds::new(0.5, 0.5)?.draw(&mut Pcg64::new(0)), [0.5; 4].into());
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ResetBounds {
    low: f64,
    high: f64,
}

impl ResetBounds {
    /// Gymnasium's bounds: from −0.1 to 0.1.
    pub const DEFAULT: Self = Self { low: -0.1, high: 0.1 };

    /// From −0.05 to 0.05.
    pub(crate) const NEAR: Self = Self { low: -0.05, high: 0.05 };

    /// Any angle: from −π to π.
    pub(crate) const ANYWHERE: Self =
        Self { low: -core::f64::consts::PI, high: core::f64::consts::PI };

    /// Bounds from `low` to `high`, rad and rad/s. Equal bounds fix the initial state.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a bound that is not finite in `f32`, and for a `low` above `high`.
    pub const fn new(low: f64, high: f64) -> Result<Self, Error> {
        let unit = "rad and rad/s";
        if let Err(error) = Range::InF32.check("low", low, unit) {
            return Err(error);
        }
        if let Err(error) = Range::InF32.check("high", high, unit) {
            return Err(error);
        }
        match low <= high {
            true => Ok(Self { low, high }),
            false => {
                Err(Error::OutOfRange { name: "low", value: low, unit, rule: "at most high, in" })
            }
        }
    }

    /// Draws an initial state. It is `f32` in every arithmetic, as in Gymnasium.
    #[inline(never)] // saves flash: each kind of reset calls it
    pub fn draw<R: Rng + ?Sized>(&self, rng: &mut R) -> State<f32> {
        let numbers = [(); 4].map(|()| uniform(rng, self.low, self.high) as f32);
        numbers.into()
    }

    /// The lower bound, rad and rad/s.
    #[must_use]
    #[inline]
    pub const fn low(&self) -> f64 {
        self.low
    }

    /// The upper bound, rad and rad/s.
    #[must_use]
    #[inline]
    pub const fn high(&self) -> f64 {
        self.high
    }
}
