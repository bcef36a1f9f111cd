//! Staying upright.

use core::f32::consts::PI;
use core::num::NonZeroU32;

use rand_core::Rng;

#[cfg(feature = "serde")]
use super::NoData;
use super::gymnasium::Gymnasium;
use super::reset_bounds::ResetBounds;
use super::{Pose, Task};
use crate::arithmetic::{Arithmetic, Numbers, Real};
use crate::physics::{Params, State};

/// Stay upright: Gymnasium's acrobot with steps of 0.02 s and a motor of 10 N m. An episode begins
/// within the bounds of upright, and no state ends it.
///
/// ```
/// use acrobot::{Acrobot, Fast, State, task::Balance};
///
/// let mut acrobot = Acrobot::<Fast, Balance>::new(42);
/// let x = acrobot.state().deviation_from(State::UPRIGHT);
/// assert!(x.iter().all(|x| x.abs() <= 0.051)); // rad and rad/s
/// assert!(acrobot.step_torque(2.5)?.reward > 0.99); // N m
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "NoData", into = "NoData"))]
pub struct Balance;

#[cfg(feature = "serde")]
impl From<NoData> for Balance {
    fn from(_: NoData) -> Self {
        Self::DEFAULT
    }
}

impl Task for Balance {
    const NAME: &'static str = "balance";
    const DEFAULT: Self = Self;
    const MAX_STEPS: NonZeroU32 = NonZeroU32::new(500).unwrap();
    const RESET_BOUNDS: ResetBounds = ResetBounds::NEAR;
    const PARAMS: Params = Params { dt: 0.02, torques: [-10.0, 0.0, 10.0], ..Params::DEFAULT };

    /// That of [`Gymnasium`].
    type Observation = [f32; 6];
    type Memory = ();

    #[inline]
    fn draw<R: Rng + ?Sized>(&self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        let drawn = bounds.draw(rng);
        State { theta1: PI + drawn.theta1, ..drawn }
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> [V; 6] {
        Gymnasium.observe::<A, V>(pose)
    }

    fn observation_high(&self, params: &Params<f32>) -> [f32; 6] {
        Gymnasium.observation_high(params)
    }

    /// (2 − cos θ1 − cos(θ1 + θ2)) / 4: 1 upright, 0 hanging.
    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V>,
        _: &Params<V>,
        _: V,
        _: V::Mask,
    ) -> V::Single {
        let number = |x| V::splat(Real::from_f64(x));
        let [(_, cos1), (_, cos_sum)] = pose.directions();
        // A sum of two products can be beyond 1 by a rounding.
        let height = -cos1 - cos_sum.simd_clamp(number(-1.0), number(1.0));
        (number(0.5) + number(0.25) * height).to_f32()
    }
}
