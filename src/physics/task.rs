//! The tasks: initial states, observations and rewards.

use core::num::NonZeroU32;

use rand_core::Rng;

use super::{Arithmetic, Params, ResetBounds, State, Viscous, common};
use crate::math::{Numbers, Real, SinCos};

/// What an acrobot is to do. An [arithmetic](Arithmetic::TASK) names its task.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Task {
    /// Gymnasium's `Acrobot-v1`: swing the tip above a height.
    #[default]
    Acrobot,
    /// dm_control's `acrobot-swingup`: swing up from anywhere and stay up. The reward is 1 up to 0.2 m from the target,
    /// 2 m above the fixed joint, and falls to 0.1 at 1.2 m. No state ends an episode.
    Swingup,
    /// dm_control's `acrobot-swingup_sparse`: as `Swingup`, with a reward of 0 beyond 0.2 m.
    SwingupSparse,
}

impl Task {
    /// The number of steps of an episode: 500, or 1000 of a swing-up.
    #[must_use]
    pub const fn limit(self) -> NonZeroU32 {
        match self {
            Self::Acrobot => const { NonZeroU32::new(500).unwrap() },
            Self::Swingup | Self::SwingupSparse => const { NonZeroU32::new(1000).unwrap() },
        }
    }

    /// The default bounds of initial states: ±0.1, or ±π rad of a swing-up.
    #[must_use]
    pub const fn reset_bounds(self) -> ResetBounds {
        match self {
            Self::Acrobot => ResetBounds::DEFAULT,
            Self::Swingup | Self::SwingupSparse => ResetBounds::ANYWHERE,
        }
    }

    /// Draws an initial state. A swing-up begins at rest.
    #[inline]
    pub(crate) fn draw<R: Rng + ?Sized>(self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        match self {
            Self::Acrobot => bounds.draw(rng),
            Self::Swingup | Self::SwingupSparse => bounds.draw_at_rest(rng),
        }
    }
}

/// The observation of a state.
#[inline(always)]
pub(crate) fn observe<A: Arithmetic>(
    sin_cos: [SinCos<A::Scalar>; 2],
    [dtheta1, dtheta2]: [A::Scalar; 2],
) -> [f32; 6] {
    match A::TASK {
        Task::Acrobot => {
            let [(sin1, cos1), (sin2, cos2)] = sin_cos;
            [cos1, sin1, cos2, sin2, dtheta1, dtheta2]
        }
        // From upright, where this crate's angles are from hanging.
        Task::Swingup | Task::SwingupSparse => {
            let [(sin1, cos1), (sin_sum, cos_sum)] = common::directions(sin_cos);
            [-sin1, -sin_sum, -cos1, -cos_sum, dtheta1, dtheta2]
        }
    }
    .map(|x| x.to_f64() as f32)
}

/// The reward of a swing-up: dm_control's `tolerance` of the distance from the tip to the target, 0.1^(d²) at d metres
/// from its edge. None for Gymnasium's task, whose reward is −1 before the goal.
#[inline(always)]
pub(crate) fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
    params: &Params<V, impl Copy>,
    sin_cos: [SinCos<V>; 2],
) -> Option<V> {
    const TARGET: f64 = 2.0;
    const RADIUS: f64 = 0.2;
    let number = |x| V::splat(A::Scalar::from_f64(x));
    let is_sparse = match A::TASK {
        Task::Acrobot => return None,
        Task::Swingup => false,
        Task::SwingupSparse => true,
    };
    let [_, [x, y]] = common::positions(params, sin_cos);
    let below = number(TARGET) - y;
    let distance = (x * x + below * below).map(Real::sqrt);
    let beyond = distance - number(RADIUS);
    let outside = if is_sparse {
        number(0.0)
    } else {
        exp2(beyond * beyond * number(-core::f64::consts::LOG2_10))
    };
    Some(distance.select_within(A::Scalar::from_f64(RADIUS), number(1.0), outside))
}

/// 2^x for x up to 0, with a relative error below 1e-8 and the rounding of the scalar. Below −100, and for NaN, 2^−100.
#[inline(always)]
fn exp2<S: Real, V: Numbers<S>>(x: V) -> V {
    const LEAST: f64 = -100.0;
    let number = |x| V::splat(S::from_f64(x));
    let x = x.select_within(S::from_f64(-LEAST), x, number(LEAST));
    let whole = x.map(S::round_small);
    // The Taylor series of e^y, |y| ≤ ln 2 / 2.
    let y = (x - whole) * number(core::f64::consts::LN_2);
    let factorials = [720.0, 120.0, 24.0, 6.0, 2.0, 1.0, 1.0];
    let series = factorials
        .into_iter()
        .fold(number(1.0 / 5040.0), |sum, factorial| {
            sum * y + number(1.0 / factorial)
        });
    series * whole.map(S::power_of_two)
}

/// The mass 1 kg of a capsule of length 1 m between the centres of its hemispheres, about an axis across its centre,
/// kg m². MuJoCo computes it from the same volumes.
const fn inertia_of_capsule(radius: f64) -> f64 {
    let (cylinder, sphere) = (1.0, 4.0 / 3.0 * radius);
    let whole = cylinder + sphere;
    let of_cylinder = (3.0 * radius * radius + 1.0) / 12.0;
    let of_sphere = 0.4 * radius * radius + 0.25 + 0.375 * radius;
    (cylinder * of_cylinder + sphere * of_sphere) / whole
}

for_f32_and_f64! {
    impl Params<S, Viscous<S>> {
        /// The parameters of dm_control's acrobot: capsules of 1 kg, damping of 0.05 N m s/rad, a step of 0.01 s and
        /// torques of ±2 N m. Its velocities have no bounds.
        pub const SWINGUP: Self = Params::<S> {
            inertia1: inertia_of_capsule(0.05) as S,
            inertia2: inertia_of_capsule(0.049) as S,
            gravity: 9.81,
            dt: 0.01,
            max_velocity1: 1e30,
            max_velocity2: 1e30,
            torques: [-2.0, 0.0, 2.0],
            ..Params::<S>::DEFAULT
        }
        .with_friction(Viscous { joint1: 0.05, joint2: 0.05 });
    }
}
