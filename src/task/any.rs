//! A task that a program chooses when it runs.

use core::num::NonZeroU32;

use rand_core::Rng;

#[cfg(feature = "serde")]
use super::NoData;
use super::balance::Balance;
use super::gymnasium::Gymnasium;
use super::reset_bounds::ResetBounds;
use super::swingup::Swingup;
use super::{Pose, Task};
use crate::arithmetic::{Arithmetic, Numbers};
use crate::physics::{Params, State};

// bindings/abi/derive.py copies the variants to other languages.
/// One of the crate's tasks, as a value: a program or another language chooses it when it runs, and
/// contains the code of all three. It has the bits and the snapshots of the task itself.
///
/// ```
/// use acrobot::arithmetic::{Damped, Fast};
/// use acrobot::task::{AnyTask, Balance};
/// use acrobot::{Acrobot, TimeLimit};
///
/// let task = AnyTask::ALL.into_iter().find(|task| task.name() == "balance").unwrap();
/// let any = Acrobot::<Damped<Fast>, AnyTask>::with_task(42, task)?;
/// assert_eq!(any.state(), Acrobot::<Damped<Fast>, Balance>::new(42).state());
/// assert_eq!(TimeLimit::with_task_limit(any).max_steps().get(), 500);
/// # use acrobot::task::Task as _;
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "NoData", into = "NoData"))]
pub enum AnyTask {
    /// [`Gymnasium`]. Gymnasium's `Acrobot-v1`: swing the tip above a height within 500 steps of
    /// 0.2 s.
    #[default]
    Gymnasium,
    /// [`Swingup`]. dm_control's `acrobot-swingup`, with friction: from rest anywhere to upright
    /// within 1,000 steps of 0.01 s. The reward is from 0 to 1. The observation has the sines of
    /// both links' angles from upright, their cosines, and the velocities.
    Swingup,
    /// [`Balance`]. Stay upright for 500 steps of 0.02 s with a motor of 10 N m, from within
    /// ±0.05 of upright. The reward is 1 upright and 0 hanging.
    Balance,
}

/// Computes with the task itself.
macro_rules! with_task {
    ($any:expr, $task:ident => $result:expr) => {
        match $any {
            AnyTask::Gymnasium => {
                let $task = Gymnasium;
                $result
            }
            AnyTask::Swingup => {
                let $task = Swingup;
                $result
            }
            AnyTask::Balance => {
                let $task = Balance;
                $result
            }
        }
    };
}

impl AnyTask {
    /// All tasks, in the order of their numbers in other languages.
    pub const ALL: [Self; 3] = [Self::Gymnasium, Self::Swingup, Self::Balance];
}

#[cfg(feature = "serde")]
impl From<NoData> for AnyTask {
    fn from(_: NoData) -> Self {
        Self::DEFAULT
    }
}

// Each item of the trait, so that none has a constant of another task.
impl Task for AnyTask {
    const NAME: &'static str = Gymnasium::NAME;
    const DEFAULT: Self = Self::Gymnasium;
    const MAX_STEPS: NonZeroU32 = Gymnasium::MAX_STEPS;
    const RESET_BOUNDS: ResetBounds = Gymnasium::RESET_BOUNDS;
    const PARAMS: Params = Gymnasium::PARAMS;

    type Observation = [f32; 6];
    type Memory = ();

    fn name(&self) -> &'static str {
        with_task!(self, task => task.name())
    }

    fn named(self, name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|task| task.name() == name)
    }

    fn max_steps(&self) -> NonZeroU32 {
        with_task!(self, task => task.max_steps())
    }

    fn reset_bounds(&self) -> ResetBounds {
        with_task!(self, task => task.reset_bounds())
    }

    fn params(&self) -> Params {
        with_task!(self, task => task.params())
    }

    fn draw<R: Rng + ?Sized>(&self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        with_task!(self, task => task.draw(bounds, rng))
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> [V; 6] {
        with_task!(self, task => task.observe::<A, V>(pose))
    }

    fn observation_high(&self, params: &Params<f32>) -> [f32; 6] {
        with_task!(self, task => task.observation_high(params))
    }

    #[inline(always)]
    fn terminated<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> V::Mask {
        with_task!(self, task => task.terminated::<A, V>(pose))
    }

    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V>,
        params: &Params<V>,
        torque: V,
        terminated: V::Mask,
    ) -> V::Single {
        with_task!(self, task => task.reward::<A, V>(pose, params, torque, terminated))
    }
}
