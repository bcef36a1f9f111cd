//! The tasks: initial states, limits and parameters.

use core::num::NonZeroU32;

use rand_core::Rng;

use super::{Params, ResetBounds, State, Viscous};

/// What an acrobot is to do. An [arithmetic](crate::arithmetic::Arithmetic::TASK) names its task.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Task {
    /// Gymnasium's `Acrobot-v1`: swing the tip above a height.
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

/// The moment of inertia of a capsule of 1 kg about an axis across its centre, kg m². The centres of its hemispheres are 1 m
/// apart. As in MuJoCo, its mass is spread evenly over its volume.
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
