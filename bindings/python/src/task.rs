//! The tasks of batches.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Numbers};
use acrobot::rand_core::Rng;
use acrobot::task::{Balance, Gymnasium, Pose, ResetBounds, Swingup, Task};
use acrobot::{Params, State};
use serde::{Deserialize, Serialize};

/// The task of a batch. A value and not a type, so that a step is compiled once for all tasks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum AnyTask {
    Gymnasium,
    Swingup,
    Balance,
}

/// Computes something with the type of the task.
macro_rules! with_task {
    ($task:expr, $is:ident => $result:expr) => {
        match $task {
            AnyTask::Gymnasium => {
                type $is = Gymnasium;
                $result
            }
            AnyTask::Swingup => {
                type $is = Swingup;
                $result
            }
            AnyTask::Balance => {
                type $is = Balance;
                $result
            }
        }
    };
}

impl AnyTask {
    pub fn params(self) -> Params {
        with_task!(self, Is => Is::PARAMS)
    }

    pub fn bounds(self) -> ResetBounds {
        with_task!(self, Is => Is::RESET_BOUNDS)
    }

    /// The torque of a continuous action, N m, which is within the smallest and the largest torque.
    /// In a swing-up the action 1 is the largest torque, −1 the smallest and 0 none. In other tasks
    /// actions are torques.
    pub fn torque(self, action: f64, low: f64, high: f64) -> f64 {
        let torque = match self {
            Self::Swingup => match action.clamp(-1.0, 1.0) {
                action if action < 0.0 => action * -low,
                action => action * high,
            },
            _ => action,
        };
        torque.max(low).min(high)
    }

    pub fn named(name: &str) -> Self {
        match name {
            Swingup::NAME => Self::Swingup,
            Balance::NAME => Self::Balance,
            _ => Self::Gymnasium,
        }
    }
}

impl Task for AnyTask {
    const NAME: &'static str = "any";
    const DEFAULT: Self = Self::Gymnasium;
    const MAX_STEPS: NonZeroU32 = Gymnasium::MAX_STEPS;

    type Observation = [f32; 6];

    fn draw<R: Rng + ?Sized>(&self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        with_task!(self, Is => Is::DEFAULT.draw(bounds, rng))
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> [V; 6] {
        with_task!(self, Is => Is::DEFAULT.observe::<A, V>(pose))
    }

    #[inline(always)]
    fn terminated<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> V::Mask {
        with_task!(self, Is => Is::DEFAULT.terminated::<A, V>(pose))
    }

    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V>,
        params: &Params<V>,
        torque: V,
        terminated: V::Mask,
    ) -> V::Single {
        with_task!(self, Is => Is::DEFAULT.reward::<A, V>(pose, params, torque, terminated))
    }
}
