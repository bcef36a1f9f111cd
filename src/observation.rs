//! Observations: the six numbers of `Acrobot-v1`, or the four of `Acrobot-v0`.

use core::f32::consts::PI;
use core::ops::Deref;

use crate::arithmetic::Arithmetic;
use crate::math::{Numbers, Real, SinCos};
use crate::physics::{State, Task, directions};

/// What an agent sees: `N` numbers in Gymnasium's order.
///
/// `Observation`, short for `Observation<6>`, is the observation of `Acrobot-v1`: \[cos θ1, sin θ1,
/// cos θ2, sin θ2, θ̇1, θ̇2\], velocities in rad/s. Hanging at rest it is \[1, 0, 1, 0, 0, 0\].
///
/// In a [`Swingup`](crate::arithmetic::Swingup) the six numbers are the sines of both links' angles
/// from upright, their cosines, and the velocities; the accessors have the names of `Acrobot-v1`.
///
/// `Observation<4>` is the observation of `Acrobot-v0`: the state \[θ1, θ2, θ̇1, θ̇2\] in rad and
/// rad/s.
///
/// ```
/// use acrobot::{Acrobot, Observation, Portable};
///
/// let acrobot = Acrobot::<Portable>::new(42);
/// let seen = acrobot.observation();
/// let angles = Observation::<4>::from(acrobot.state());
/// assert_eq!(angles.theta1(), f32::atan2(seen.sin_theta1(), seen.cos_theta1()));
///
/// let [cos_theta1, ..] = seen.to_array();
/// assert!(cos_theta1 > 0.99);
/// assert_eq!(seen[4], seen.dtheta1());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        transparent,
        bound(
            serialize = "[f32; N]: serde::Serialize",
            deserialize = "[f32; N]: serde::Deserialize<'de>"
        )
    )
)]
pub struct Observation<const N: usize = 6>([f32; N]);

impl<const N: usize> Observation<N> {
    /// The numbers.
    #[must_use]
    #[inline]
    pub const fn to_array(self) -> [f32; N] {
        self.0
    }

    /// The numbers, to borrow.
    #[must_use]
    #[inline]
    pub const fn as_slice(&self) -> &[f32] {
        &self.0
    }
}

macro_rules! accessors {
    ($($N:literal: $($index:literal $name:ident $doc:literal),*;)*) => {$(
        impl Observation<$N> {
            $(
                #[doc = $doc]
                #[must_use]
                #[inline]
                pub const fn $name(&self) -> f32 {
                    self.0[$index]
                }
            )*
        }
    )*};
}

accessors! {
    6:
        0 cos_theta1 "cos θ1, between −1 and 1; 1 hanging down.",
        1 sin_theta1 "sin θ1, between −1 and 1.",
        2 cos_theta2 "cos θ2, between −1 and 1; 1 in line with link 1.",
        3 sin_theta2 "sin θ2, between −1 and 1.",
        4 dtheta1 "Angular velocity of link 1, rad/s.",
        5 dtheta2 "Angular velocity of link 2 relative to link 1, rad/s.";
    4:
        0 theta1 "Angle of link 1, rad; 0 hanging down.",
        1 theta2 "Angle of link 2 relative to link 1, rad; 0 in line with it.",
        2 dtheta1 "Angular velocity of link 1, rad/s.",
        3 dtheta2 "Angular velocity of link 2 relative to link 1, rad/s.";
}

impl Observation<4> {
    /// The upper bounds of `Acrobot-v0`'s observation space: π rad, 4π rad/s and 9π rad/s.
    pub const V0_HIGH: Self = Self([PI, PI, 4.0 * PI, 9.0 * PI]);
    /// The lower bounds: `-V0_HIGH`.
    pub const V0_LOW: Self = Self([-PI, -PI, -4.0 * PI, -9.0 * PI]);
}

impl Observation<6> {
    /// The upper bounds of `Acrobot-v1`'s observation space: 1, 4π rad/s and 9π rad/s.
    pub const HIGH: Self = Self([1.0, 1.0, 1.0, 1.0, 4.0 * PI, 9.0 * PI]);
    /// The lower bounds: `-HIGH`.
    pub const LOW: Self = Self([-1.0, -1.0, -1.0, -1.0, -4.0 * PI, -9.0 * PI]);

    /// What an agent sees of a state: in Gymnasium's task or in dm_control's.
    #[inline(always)]
    pub(crate) fn of<A: Arithmetic>(
        sin_cos: [SinCos<A::Scalar>; 2],
        [dtheta1, dtheta2]: [A::Scalar; 2],
    ) -> Self {
        let numbers = match A::TASK {
            Task::Acrobot => {
                let [(sin1, cos1), (sin2, cos2)] = sin_cos;
                [cos1, sin1, cos2, sin2, dtheta1, dtheta2]
            }
            // From upright, not from hanging.
            Task::Swingup | Task::SwingupSparse => {
                let [(sin1, cos1), (sin_sum, cos_sum)] = directions(sin_cos);
                // A sum of two products can be beyond 1 by a rounding.
                let [sin_sum, cos_sum] = [sin_sum, cos_sum].map(|x| x.bound(Real::from_f64(1.0)));
                [-sin1, -sin_sum, -cos1, -cos_sum, dtheta1, dtheta2]
            }
        };
        Self(numbers.map(|x| x.to_f64() as f32))
    }
}

impl<S: Real> From<State<S>> for Observation<4> {
    #[inline]
    fn from(state: State<S>) -> Self {
        Self(state.cast().into())
    }
}

impl<const N: usize> From<[f32; N]> for Observation<N> {
    #[inline]
    fn from(numbers: [f32; N]) -> Self {
        Self(numbers)
    }
}

impl<const N: usize> From<Observation<N>> for [f32; N] {
    #[inline]
    fn from(observation: Observation<N>) -> Self {
        observation.0
    }
}

impl<const N: usize> Deref for Observation<N> {
    type Target = [f32];

    /// The numbers, so that `observation[4]` and `observation.iter()` work as for a slice.
    #[inline]
    fn deref(&self) -> &[f32] {
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
