//! The tasks: initial states and limits.

use core::num::NonZeroU32;

use rand_core::Rng;

use super::state::{ResetBounds, State};

/// What an acrobot is to do. An [arithmetic](crate::arithmetic::Arithmetic::TASK) names its task.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Task {
    /// Gymnasium's `Acrobot-v1`: swing the tip above a height.
    Acrobot,
    /// dm_control's `acrobot-swingup`: swing up from anywhere and stay up. The reward is 1 up to
    /// 0.2 m from the target, 2 m above the fixed joint, and falls to 0.1 at 1.2 m.
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
