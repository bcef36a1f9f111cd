//! The task of one acrobot.

use core::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Numbers};
use acrobot::rand_core::Rng;
use acrobot::task::{Balance, Gymnasium, Pose, ResetBounds, Task};
use acrobot::{Params, State};

/// A value and not a type, so that each function of the header is compiled once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyTask {
    Gymnasium,
    Balance,
}

impl AnyTask {
    /// The bounds of initial states: a constant of each task, so this type has none.
    pub fn reset_bounds(self) -> ResetBounds {
        match self {
            Self::Gymnasium => Gymnasium::RESET_BOUNDS,
            Self::Balance => Balance::RESET_BOUNDS,
        }
    }
}

impl Task for AnyTask {
    const NAME: &'static str = "any";
    const DEFAULT: Self = Self::Gymnasium;
    const MAX_STEPS: NonZeroU32 = Gymnasium::MAX_STEPS;

    type Observation = [f32; 6];

    fn draw<R: Rng + ?Sized>(&self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        match self {
            Self::Gymnasium => Gymnasium.draw(bounds, rng),
            Self::Balance => Balance.draw(bounds, rng),
        }
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> [V; 6] {
        Gymnasium.observe::<A, V>(pose) // also that of `Balance`
    }

    #[inline(always)]
    fn terminated<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> V::Mask {
        match self {
            Self::Gymnasium => Gymnasium.terminated::<A, V>(pose),
            Self::Balance => Balance.terminated::<A, V>(pose),
        }
    }

    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V>,
        params: &Params<V>,
        torque: V,
        terminated: V::Mask,
    ) -> V::Single {
        match self {
            Self::Gymnasium => Gymnasium.reward::<A, V>(pose, params, torque, terminated),
            Self::Balance => Balance.reward::<A, V>(pose, params, torque, terminated),
        }
    }
}
