//! The task of a batch.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Numbers};
use acrobot::rand_core::Rng;
use acrobot::task::{Balance, Gymnasium, ResetBounds, Seen, Swingup, Task};
use acrobot::{Params, State};
use serde::{Deserialize, Serialize};

/// A task that is chosen when the program runs. A type for each would be another step of each
/// arithmetic: 250 KB, and half a minute to compile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum AnyTask {
    Gymnasium,
    Swingup,
    Balance,
}

/// Calls a function of the task.
macro_rules! call {
    ($task:expr, $($call:tt)*) => {
        match $task {
            AnyTask::Gymnasium => Gymnasium.$($call)*,
            AnyTask::Swingup => Swingup.$($call)*,
            AnyTask::Balance => Balance.$($call)*,
        }
    };
}

impl AnyTask {
    pub fn of(name: &str) -> Self {
        match name {
            Swingup::NAME => Self::Swingup,
            Balance::NAME => Self::Balance,
            _ => Self::Gymnasium,
        }
    }

    pub fn reset_bounds(self) -> ResetBounds {
        match self {
            Self::Gymnasium => Gymnasium::RESET_BOUNDS,
            Self::Swingup => Swingup::RESET_BOUNDS,
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
        call!(self, draw(bounds, rng))
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, seen: &Seen<V>) -> [V; 6] {
        call!(self, observe::<A, V>(seen))
    }

    #[inline(always)]
    fn ended<A: Arithmetic, V: Numbers<A::Scalar>>(&self, seen: &Seen<V>) -> V::Mask {
        call!(self, ended::<A, V>(seen))
    }

    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        seen: &Seen<V>,
        params: &Params<V>,
        torque: V,
        ended: V::Mask,
    ) -> V::Single {
        call!(self, reward::<A, V>(seen, params, torque, ended))
    }
}
