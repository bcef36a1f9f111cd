//! What each reset draws of the parameters: domain randomization.

use rand_core::Rng;

use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::math::Real;
use crate::numpy::uniform;
use crate::physics::{Dynamics, FIELDS, Modeled, Params, check_params};

/// How a reset draws one parameter, in its unit. Where both bounds are equal, it draws nothing.
///
/// ```
/// use acrobot::task::{Draw, Draws};
/// use acrobot::{Params, numpy::Pcg64};
///
/// let gravity = Draw::Normal { mean: 9.8, std: 0.1, low: 9.5, high: 10.1 }; // m/s²
/// let draws = Draws::new(Params { gravity, ..Draws::FIXED })?;
/// let drawn: Params = draws.draw(&Params::DEFAULT, &mut Pcg64::new(42));
/// assert!((9.5..=10.1).contains(&drawn.gravity));
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Draw<S = f64> {
    /// The parameter stays as it is.
    Fixed,
    /// Uniformly.
    Uniform {
        /// The lower bound.
        low: S,
        /// The upper bound.
        high: S,
    },
    /// Its logarithm uniformly.
    LogUniform {
        /// The lower bound, above 0.
        low: S,
        /// The upper bound.
        high: S,
    },
    /// From a normal distribution, truncated at the bounds.
    Normal {
        /// The mean without the bounds, between which it is.
        mean: S,
        /// The standard deviation without the bounds, above 0.
        std: S,
        /// The lower bound.
        low: S,
        /// The upper bound.
        high: S,
    },
}

impl<S: Real> Draw<S> {
    /// A constant.
    #[must_use]
    pub const fn exactly(number: S) -> Self {
        Self::Uniform { low: number, high: number }
    }

    /// The bounds; of one that does not draw, its number.
    pub(super) fn bounds(self, number: S) -> [S; 2] {
        match self {
            Self::Fixed => [number; 2],
            Self::Uniform { low, high }
            | Self::LogUniform { low, high }
            | Self::Normal { low, high, .. } => [low, high],
        }
    }

    pub(super) fn check(self, name: &'static str, unit: &'static str) -> Result<(), Error> {
        let [low, high] = self.bounds(S::ZERO).map(S::to_f64);
        let out_of_range = |value, rule| Err(Error::OutOfRange { name, value, unit, rule });
        let is_ordered = low <= high; // false for NaN
        if !is_ordered {
            return out_of_range(low, "drawn from a low of at most its high, in");
        }
        if !(high - low).is_finite() {
            return out_of_range(high - low, "drawn from a range of finite width in");
        }
        match self {
            Self::LogUniform { .. } if low <= 0.0 => out_of_range(low, "drawn from above 0"),
            Self::Normal { mean, .. } if !(low <= mean.to_f64() && mean.to_f64() <= high) => {
                out_of_range(mean.to_f64(), "drawn with a mean between its bounds, in")
            }
            Self::Normal { std, .. } if !(std > S::ZERO && std.is_finite()) => {
                out_of_range(std.to_f64(), "drawn with a finite standard deviation above 0")
            }
            _ => Ok(()),
        }
    }

    /// A number between the bounds, with the same bits on all machines.
    pub(super) fn draw<R: Rng + ?Sized>(self, number: S, rng: &mut R) -> S {
        let [low, high] = self.bounds(number);
        if low == high {
            return low;
        }
        let [low, high] = [low, high].map(S::to_f64);
        let drawn = match self {
            Self::LogUniform { .. } => libm::exp(uniform(rng, libm::log(low), libm::log(high))),
            Self::Normal { mean, std, .. } => normal(rng, mean.to_f64(), std.to_f64(), low, high),
            _ => uniform(rng, low, high),
        };
        S::from_f64(drawn.max(low).min(high))
    }
}

/// Draws from a normal distribution that is truncated at the bounds.
fn normal<R: Rng + ?Sized>(rng: &mut R, mean: f64, std: f64, low: f64, high: f64) -> f64 {
    // One of 10¹⁵ draws would be farther from the mean.
    let (low, high) = (low.max(mean - 8.0 * std), high.min(mean + 8.0 * std));
    // A uniform draw is accepted by the density: one in seven. Only a generator or bounds that
    // always give the same number get to the end.
    for _ in 0..1000 {
        let drawn = uniform(rng, low, high);
        let z = (drawn - mean) / std;
        if uniform(rng, 0.0, 1.0) < libm::exp(-0.5 * z * z) {
            return drawn;
        }
    }
    mean
}

/// How each reset draws the parameters: after the initial state, in the order of the fields, from
/// the same generator. Those of a [batch](crate::guide::rust#many-at-once) draw by themselves, an
/// acrobot by [`draw_params`](crate::Acrobot::draw_params).
///
/// ```
/// use acrobot::task::{Draw, Draws};
/// use acrobot::{Acrobot, Fast, Params};
///
/// let mass2 = Draw::Uniform { low: 0.8, high: 1.2 }; // kg
/// let mut acrobot = Acrobot::<Fast>::new(42);
/// acrobot.draw_params(&Draws::new(Params { mass2, ..Draws::FIXED })?)?;
/// assert!((0.8..=1.2).contains(&acrobot.params().mass2) && acrobot.params().mass1 == 1.0);
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Draws<S = f64>(Params<Draw<S>>);

impl<S: Real> Draws<S> {
    /// Draws nothing.
    pub const NONE: Self = Self(Self::FIXED);

    /// Parameters that stay as they are, to begin from. The dynamics have no meaning.
    pub const FIXED: Params<Draw<S>> = Params {
        length1: Draw::Fixed,
        length2: Draw::Fixed,
        mass1: Draw::Fixed,
        mass2: Draw::Fixed,
        center_of_mass1: Draw::Fixed,
        center_of_mass2: Draw::Fixed,
        inertia1: Draw::Fixed,
        inertia2: Draw::Fixed,
        gravity: Draw::Fixed,
        dt: Draw::Fixed,
        max_velocity1: Draw::Fixed,
        max_velocity2: Draw::Fixed,
        torques: [Draw::Fixed; 3],
        torque_noise: Draw::Fixed,
        dynamics: Dynamics::Book,
        damping1: Draw::Fixed,
        damping2: Draw::Fixed,
        coulomb1: Draw::Fixed,
        coulomb2: Draw::Fixed,
        rotor: Draw::Fixed,
    };

    /// Draws parameters so.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a lower bound above the upper one, for an infinite width, for a
    /// [`LogUniform`](Draw::LogUniform) that begins at 0 or below, and for a
    /// [`Normal`](Draw::Normal) whose mean is not between its bounds or whose standard deviation is
    /// not above 0.
    pub fn new(mut params: Params<Draw<S>>) -> Result<Self, Error> {
        for (draw, (name, unit, _)) in params.numbers_mut().into_iter().zip(FIELDS) {
            draw.check(name, unit)?;
        }
        Ok(Self(params))
    }

    /// How each parameter is drawn.
    #[must_use]
    pub const fn params(&self) -> &Params<Draw<S>> {
        &self.0
    }

    /// These parameters, with each drawn one replaced.
    pub fn draw<R: Rng + ?Sized>(&self, params: &Params<S>, rng: &mut R) -> Params<S> {
        self.replace(params, |draw, number| draw.draw(number, rng))
    }

    /// These parameters, each replaced by `f` of its draw and its number. A loop: written out for
    /// each parameter, the code would be larger.
    fn replace(&self, params: &Params<S>, mut f: impl FnMut(Draw<S>, S) -> S) -> Params<S> {
        let mut replaced = *params;
        for (number, (_, draw)) in replaced.numbers_mut().into_iter().zip(self.0.numbers()) {
            *number = f(draw, *number);
        }
        replaced
    }
}

impl<S: Modeled> Draws<S> {
    /// Checks these parameters with all drawn ones at their lower, and at their upper bounds. A
    /// draw is between them.
    pub(crate) fn check<A: Arithmetic<Scalar = S>>(&self, params: &Params<S>) -> Result<(), Error> {
        let low = self.replace(params, |draw, number| draw.bounds(number)[0]);
        let high = self.replace(params, |draw, number| draw.bounds(number)[1]);
        check_params::<A>(&low)?;
        check_params::<A>(&high)?;
        // Of draws between them the determinant U L − (r + k)² is at least (s − r) (s + r + 2 k),
        // where s² is the product of the least inertias of link 1 about its joint and of link 2
        // about its centre of mass. Rounding changes it by less than 8 machine epsilons times
        // (s + k)².
        let [least, most]: [Params<f64>; 2] = [low.cast(), high.cast()];
        let ([link1, ..], [.., k]) = (least.inertias(), most.inertias());
        let s = Real::sqrt(link1 * least.inertia2);
        let r = least.rotor.abs().max(most.rotor.abs());
        let is_below = r + 16.0 * S::EPSILON.to_f64() * (s + k) < s; // false for NaN
        if low != high && r > 0.0 && !is_below {
            let rule = "below √((inertia1 + m1 lc1²) inertia2) where one of them is drawn, in";
            return Err(Error::OutOfRange { name: "rotor", value: r, unit: "kg m²", rule });
        }
        Ok(())
    }
}
