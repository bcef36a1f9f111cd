//! dm_control's swing-up.

use core::num::NonZeroU32;

use rand_core::Rng;

#[cfg(feature = "serde")]
use super::NoData;
use super::reset_bounds::ResetBounds;
use super::{Pose, Task};
use crate::arithmetic::{Arithmetic, Numbers, Real};
use crate::math::sealed::Sealed;
use crate::numpy::uniform;
use crate::physics::{Params, State};

/// dm_control's `acrobot-swingup`: swing up from anywhere and stay up. The reward is 1 up to
/// 0.2 m from the target, 2 m above the fixed joint, and falls to 0.1 at 1.2 m.
///
/// Beyond 0.2 m it is below 1. So `reward == 1.0` is the reward of `acrobot-swingup_sparse`.
///
/// ```
/// use acrobot::task::Swingup;
/// use acrobot::{Acrobot, Fast, State, arithmetic::Damped};
///
/// let mut acrobot = Acrobot::<Damped<Fast>, Swingup>::new(42);
/// acrobot.set_state(State::UPRIGHT)?;
/// assert_eq!(acrobot.step_torque(0.0)?.reward, 1.0);
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "NoData", into = "NoData"))]
pub struct Swingup;

#[cfg(feature = "serde")]
impl From<NoData> for Swingup {
    fn from(_: NoData) -> Self {
        Self::DEFAULT
    }
}

impl Task for Swingup {
    const NAME: &'static str = "swingup";
    const DEFAULT: Self = Self;
    const MAX_STEPS: NonZeroU32 = NonZeroU32::new(1000).unwrap();
    const RESET_BOUNDS: ResetBounds = ResetBounds::ANYWHERE;
    const PARAMS: Params = Params::SWINGUP;

    /// The sines of both links' angles from upright, their cosines, θ̇1 and θ̇2, rad/s: hanging at
    /// rest \[0, 0, −1, −1, 0, 0\].
    type Observation = [f32; 6];
    type Memory = ();

    /// At rest: it draws the angles only.
    #[inline]
    fn draw<R: Rng + ?Sized>(&self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        let [theta1, theta2] = [(); 2].map(|()| uniform(rng, bounds.low(), bounds.high()) as f32);
        State { theta1, theta2, ..State::HANGING }
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> [V; 6] {
        let [(sin1, cos1), (sin_sum, cos_sum)] = pose.directions();
        // A sum of two products can be beyond 1 by a rounding.
        let one = V::splat(A::Scalar::ONE);
        let [sin_sum, cos_sum] = [sin_sum, cos_sum].map(|x| x.simd_clamp(-one, one));
        [-sin1, -sin_sum, -cos1, -cos_sum, pose.state.dtheta1, pose.state.dtheta2]
    }

    /// 1, 1, 1, 1, and the largest velocities.
    fn observation_high(&self, params: &Params<f32>) -> [f32; 6] {
        [1.0, 1.0, 1.0, 1.0, params.max_velocity1, params.max_velocity2]
    }

    /// dm_control's `tolerance`: 0.1^(d²) at d metres beyond 0.2 m from the target.
    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V>,
        params: &Params<V>,
        _: V,
        _: V::Mask,
    ) -> V::Single {
        const RADIUS: f64 = 0.2;
        // Up to 0.1 mm beyond, the nearest `f32` would be 1.
        const BELOW_1: f64 = 1.0_f32.next_down() as f64;
        let number = |x| V::splat(Real::from_f64(x));
        let [_, [x, y]] = pose.positions(params);
        let below = number(2.0) - y;
        let distance = (x * x + below * below).map(Real::sqrt);
        let beyond = distance - number(RADIUS);
        let outside = exp2(beyond * beyond * number(-core::f64::consts::LOG2_10));
        let outside = outside.simd_clamp(number(0.0), number(BELOW_1));
        distance.select_abs_le(Real::from_f64(RADIUS), number(1.0), outside).to_f32()
    }
}

/// 2^x for x up to 0, for rewards, which are `f32`. Below −100, and for NaN, 2^−100.
#[inline(always)]
fn exp2<S: Real, V: Numbers<S>>(x: V) -> V {
    const LEAST: f64 = -100.0;
    let number = |x| V::splat(S::from_f64(x));
    let x = x.select_abs_le(S::from_f64(-LEAST), x, number(LEAST));
    let whole = x.map(S::round_small);
    // The Taylor series of e^y, |y| ≤ ln 2 / 2. Its first omitted term is at most 6e-9.
    let y = (x - whole) * number(core::f64::consts::LN_2);
    let factorials = [720.0, 120.0, 24.0, 6.0, 2.0, 1.0, 1.0];
    let series = factorials
        .into_iter()
        .fold(number(1.0 / 5040.0), |sum, factorial| sum * y + number(1.0 / factorial));
    series * whole.map(S::power_of_two)
}
