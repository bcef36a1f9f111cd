//! The three actions.

use core::num::NonZeroU32;

use rand_core::Rng;

use crate::error::Error;
use crate::numpy::integers;

/// One of the three torques between the links, numbered 0, 1 and 2 as in Gymnasium.
/// [`Params::torques`](crate::Params::torques) has their values in N m.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(u8)]
pub enum Action {
    /// Action 0: −1 N m by default.
    Negative = 0,
    /// Action 1: no torque by default.
    Zero = 1,
    /// Action 2: +1 N m by default.
    Positive = 2,
}

impl Action {
    /// All three actions, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Negative, Self::Zero, Self::Positive];

    /// Draws an action, all equally likely: Gymnasium's `action_space.sample()`, if `rng` is a
    /// [`Pcg64`](crate::numpy::Pcg64) with the seed of the space.
    #[inline]
    pub fn sample<R: Rng + ?Sized>(rng: &mut R) -> Self {
        match integers(rng, const { NonZeroU32::new(3).unwrap() }) {
            0 => Self::Negative,
            1 => Self::Zero,
            _ => Self::Positive,
        }
    }
}

impl TryFrom<u8> for Action {
    type Error = Error;

    /// The action with this number.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownAction`] for a number above 2.
    #[inline]
    fn try_from(number: u8) -> Result<Self, Error> {
        match number {
            0 => Ok(Self::Negative),
            1 => Ok(Self::Zero),
            2 => Ok(Self::Positive),
            _ => Err(Error::UnknownAction(number)),
        }
    }
}

impl From<Action> for u8 {
    #[inline]
    fn from(action: Action) -> Self {
        action as u8
    }
}
