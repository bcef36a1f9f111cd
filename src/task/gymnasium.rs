//! Gymnasium's task, in two versions.

use core::f32::consts::PI;
use core::num::NonZeroU32;

#[cfg(feature = "serde")]
use super::NoData;
use super::{Pose, Task};
use crate::arithmetic::{Arithmetic, Form, Numbers, Real};
use crate::math::sealed::Sealed;
use crate::physics::Params;

/// Gymnasium's `Acrobot-v1`: swing the tip above a height.
///
/// ```
/// use acrobot::{Acrobot, Action, Fast, numpy::Pcg64, task::Gymnasium};
///
/// let mut acrobot = Acrobot::<Fast, Gymnasium>::hanging(Pcg64::new(42));
/// assert_eq!(acrobot.observation(), [1.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
/// assert_eq!(acrobot.step(Action::Zero).reward, -1.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "NoData", into = "NoData"))]
pub struct Gymnasium;

#[cfg(feature = "serde")]
impl From<NoData> for Gymnasium {
    fn from(_: NoData) -> Self {
        Self::DEFAULT
    }
}

impl Task for Gymnasium {
    const NAME: &'static str = "gymnasium";
    const DEFAULT: Self = Self;
    const MAX_STEPS: NonZeroU32 = NonZeroU32::new(500).unwrap();

    /// \[cos θ1, sin θ1, cos θ2, sin θ2, θ̇1, θ̇2\], velocities in rad/s: hanging at rest \[1, 0,
    /// 1, 0, 0, 0\].
    type Observation = [f32; 6];
    type Memory = ();

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> [V; 6] {
        let [(sin1, cos1), (sin2, cos2)] = pose.sin_cos;
        [cos1, sin1, cos2, sin2, pose.state.dtheta1, pose.state.dtheta2]
    }

    /// 1, 1, 1, 1, and the largest velocities, at least 0.1 rad/s for the initial states.
    fn observation_high(&self, params: &Params<f32>) -> [f32; 6] {
        let [dtheta1, dtheta2] = highest_velocities(params);
        [1.0, 1.0, 1.0, 1.0, dtheta1, dtheta2]
    }

    /// Whether −cos θ1 − cos(θ1 + θ2) > 1, whatever the lengths of the links.
    #[inline(always)]
    fn terminated<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> V::Mask {
        let [(sin1, cos1), (sin2, cos2)] = pose.sin_cos;
        let one = V::splat(A::Scalar::ONE);
        let cos_sum = match A::FORM {
            Form::Lean => cos1 * cos2 - sin1 * sin2,
            Form::Gymnasium => {
                // Without a positive −cos θ1 the sum cannot exceed 1, and needs no second cosine.
                let zero = V::splat(A::Scalar::ZERO);
                let lowest = cos1.map(|x| if x < A::Scalar::ZERO { x } else { A::Scalar::ZERO });
                if lowest.all_abs_le(zero) {
                    return zero.simd_gt(one);
                }
                A::cos_near(pose.state.theta2 + pose.state.theta1)
            }
        };
        (-cos1 - cos_sum).simd_gt(one)
    }
}

/// The largest velocities after a step or a reset with the default bounds, rad/s.
fn highest_velocities(params: &Params<f32>) -> [f32; 2] {
    let initial = Gymnasium::RESET_BOUNDS.high() as f32;
    [params.max_velocity1, params.max_velocity2].map(|limit| limit.max(initial))
}

/// Gymnasium's `Acrobot-v0`: as [`Gymnasium`], with the state as the observation and 200 steps.
///
/// ```
/// use acrobot::{Acrobot, Fast, TimeLimit, task::GymnasiumV0};
///
/// let mut acrobot = TimeLimit::with_task_limit(Acrobot::<Fast, GymnasiumV0>::new(42));
/// assert_eq!(acrobot.observation(), <[f32; 4]>::from(acrobot.state())); // rad and rad/s
/// assert_eq!(acrobot.max_steps().get(), 200);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "NoData", into = "NoData"))]
pub struct GymnasiumV0;

#[cfg(feature = "serde")]
impl From<NoData> for GymnasiumV0 {
    fn from(_: NoData) -> Self {
        Self::DEFAULT
    }
}

impl Task for GymnasiumV0 {
    const NAME: &'static str = "gymnasium_v0";
    const DEFAULT: Self = Self;
    const MAX_STEPS: NonZeroU32 = NonZeroU32::new(200).unwrap();

    /// \[θ1, θ2, θ̇1, θ̇2\], rad and rad/s.
    type Observation = [f32; 4];
    type Memory = ();

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> [V; 4] {
        pose.state.into()
    }

    /// π, π, and the largest velocities of [`Gymnasium`].
    fn observation_high(&self, params: &Params<f32>) -> [f32; 4] {
        let [dtheta1, dtheta2] = highest_velocities(params);
        [PI, PI, dtheta1, dtheta2]
    }

    #[inline(always)]
    fn terminated<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> V::Mask {
        Gymnasium.terminated::<A, V>(pose)
    }
}
