//! State feedback about an equilibrium, as plain data.

use super::region::Region;
use crate::math::Real;
use crate::physics::State;

/// State feedback that holds an equilibrium: plain data, which a `const` can have. A
/// [`BoundedRegulator`](super::BoundedRegulator) has one, and says from which states it holds.
///
/// With dry friction there are two gains. At rest dry friction acts like strong viscous friction,
/// in motion hardly at all, and the gains for both have opposite signs.
///
/// ```
/// use acrobot::State;
/// use acrobot::control::regulator::{Feedback, Region};
///
/// const K: Region = Region { gain: [-180.0, -45.0, -86.0, -28.0], ..Region::NONE };
/// const NONE: Region = Region::NONE;
/// const HOLD: Feedback =
///     Feedback { target: State::UPRIGHT, torque: 0.0, moving: K, resting: NONE, reach: 0.0 };
/// assert_eq!(HOLD.torque(State { dtheta1: 0.5, ..State::UPRIGHT }), 43.0); // N m
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)] // for bindings/abi
pub struct Feedback<S = f64> {
    /// The equilibrium.
    pub target: State<S>,
    /// The torque that holds it, N m.
    pub torque: S,
    /// The gain in motion.
    pub moving: Region<S>,
    /// The gain at rest.
    pub resting: Region<S>,
    /// The gain at rest is used where |F x|² of its region is below this: nowhere if it is 0.
    pub reach: S,
}

impl<S: Real> Feedback<S> {
    /// The torque at a state, N m, which can be beyond that of the motor:
    /// [`saturate`](crate::physics::saturate) limits it. From an extreme state it can be infinite
    /// or NaN.
    #[must_use]
    pub fn torque(&self, state: State<S>) -> S {
        self.torque_of(self.deviation(state))
    }

    /// The torque for a deviation, N m.
    #[inline(never)] // saves flash
    pub(in crate::control) fn torque_of(&self, x: [S; 4]) -> S {
        let has_rest = self.reach > S::ZERO; // squares cost time
        let region = match has_rest && self.resting.square(x) < self.reach {
            true => &self.resting,
            false => &self.moving,
        };
        self.torque + region.torque(x)
    }

    /// The deviation of a state from the equilibrium.
    #[inline(never)] // saves flash
    pub(in crate::control) fn deviation(&self, state: State<S>) -> [S; 4] {
        state.deviation_from(self.target)
    }
}
