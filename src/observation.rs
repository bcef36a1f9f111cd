//! What an agent sees: the six numbers of `Acrobot-v1`, or the four of `Acrobot-v0`.

use core::f32::consts::PI;
use core::ops::Deref;

use crate::arithmetic::Real;
use crate::state::State;

/// An observation: the `N` numbers of Gymnasium's, in its order.
///
/// `Observation`, that is `Observation<6>`, is that of `Acrobot-v1`, the state with its angles as
/// points on the unit circle: \[cos θ1, sin θ1, cos θ2, sin θ2, θ̇1, θ̇2\]. Hanging at rest is
/// \[1, 0, 1, 0, 0, 0\].
///
/// `Observation<4>` is that of `Acrobot-v0`, the state itself: \[θ1, θ2, θ̇1, θ̇2\] in rad and rad/s.
///
/// ```
/// use acrobot::{Acrobot, Observation, Portable};
///
/// let acrobot = Acrobot::<Portable>::new(42);
/// let [cos1, sin1, ..] = *acrobot.observation();
/// let angles = Observation::<4>::from(acrobot.state());
/// assert_eq!(angles[0], f32::atan2(sin1, cos1));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Observation<const N: usize = 6>(pub [f32; N]);

impl Observation<6> {
    /// The upper bounds of `Acrobot-v1`'s observation space: 1, and 4π and 9π rad/s.
    pub const HIGH: Self = Self([1.0, 1.0, 1.0, 1.0, 4.0 * PI, 9.0 * PI]);
    /// The lower bounds: `-HIGH`.
    pub const LOW: Self = Self([-1.0, -1.0, -1.0, -1.0, -4.0 * PI, -9.0 * PI]);
}

impl Observation<4> {
    /// The upper bounds of `Acrobot-v0`'s observation space: π rad, and 4π and 9π rad/s.
    pub const V0_HIGH: Self = Self([PI, PI, 4.0 * PI, 9.0 * PI]);
    /// The lower bounds: `-V0_HIGH`.
    pub const V0_LOW: Self = Self([-PI, -PI, -4.0 * PI, -9.0 * PI]);
}

impl<S: Real> From<State<S>> for Observation<4> {
    #[inline]
    fn from(state: State<S>) -> Self {
        Self(state.cast().into())
    }
}

impl<const N: usize> Deref for Observation<N> {
    type Target = [f32; N];

    #[inline]
    fn deref(&self) -> &[f32; N] {
        &self.0
    }
}

impl<const N: usize> AsRef<[f32]> for Observation<N> {
    #[inline]
    fn as_ref(&self) -> &[f32] {
        &self.0
    }
}

impl<const N: usize> AsMut<[f32]> for Observation<N> {
    #[inline]
    fn as_mut(&mut self) -> &mut [f32] {
        &mut self.0
    }
}

impl<const N: usize> From<Observation<N>> for [f32; N] {
    #[inline]
    fn from(observation: Observation<N>) -> Self {
        observation.0
    }
}
