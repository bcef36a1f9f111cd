//! Tasks: where an episode begins, what an agent sees, its rewards, and when it ends.
//!
//! A [`Task`] is a type parameter of [`Acrobot`](crate::Acrobot) and of
//! [`Batch`](crate::batch::Batch).

mod any;
mod balance;
mod draws;
pub(crate) mod episode;
mod gymnasium;
mod observation;
mod reset_bounds;
mod reset_options;
mod swingup;

use core::fmt;
use core::num::NonZeroU32;
use core::ops::{Add, Mul, Neg, Sub};

use rand_core::Rng;

pub use any::AnyTask;
pub use balance::Balance;
pub use draws::{Draw, Draws};
pub use gymnasium::{Gymnasium, GymnasiumV0};
pub use observation::Observation;
pub use reset_bounds::ResetBounds;
pub use reset_options::ResetOptions;
pub use swingup::Swingup;

use crate::arithmetic::{Arithmetic, Numbers, Real};
use crate::physics::{Given, Params, State, directions, positions};

/// What an acrobot is to do. Its functions compute for one acrobot or for many side by side, so
/// they have no branches: [an example](crate::guide::tasks).
pub trait Task: Copy + fmt::Debug + PartialEq + Send + Sync + 'static {
    /// A short name in lower case, of at most 16 bytes. Snapshots have it, with the task's data, so
    /// no other task can load them.
    const NAME: &'static str;

    /// The task of a new acrobot, if it is not given one. A task can have data, such as a point to
    /// reach.
    const DEFAULT: Self;

    /// The number of steps of an episode.
    const MAX_STEPS: NonZeroU32;

    /// The default bounds of initial states.
    const RESET_BOUNDS: ResetBounds = ResetBounds::DEFAULT;

    /// The default parameters. With friction, the task compiles only in an arithmetic that has it:
    ///
    /// ```compile_fail,E0080
    /// use acrobot::task::Swingup;
    /// use acrobot::{Acrobot, Fast};
    ///
    /// Acrobot::<Fast, Swingup>::new(42); // the arithmetic must be Damped<Fast>
    /// ```
    const PARAMS: Params = Params::DEFAULT;

    /// What an agent sees: `[f32; N]`.
    type Observation: Observation;

    /// The name of this task. This and the next four follow from the type, unless the value
    /// decides, as in [`AnyTask`].
    fn name(&self) -> &'static str {
        Self::NAME
    }

    /// The task of a snapshot with this name and these data, or `None`.
    fn named(self, name: &str) -> Option<Self> {
        (name == Self::NAME).then_some(self)
    }

    /// The number of steps of an episode of this task.
    fn max_steps(&self) -> NonZeroU32 {
        Self::MAX_STEPS
    }

    /// The default bounds of initial states of this task.
    fn reset_bounds(&self) -> ResetBounds {
        Self::RESET_BOUNDS
    }

    /// The default parameters of this task.
    fn params(&self) -> Params {
        Self::PARAMS
    }

    /// Draws an initial state. It is `f32` in every arithmetic.
    #[inline]
    fn draw<R: Rng + ?Sized>(&self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        bounds.draw(rng)
    }

    /// The observation: `[V; N]`, rounded to `f32` afterwards. That of
    /// [`Acrobot-v1`](Gymnasium) is `Gymnasium.observe::<A, V>(pose)`.
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V>,
    ) -> <Self::Observation as Observation>::Of<V>;

    /// The largest magnitude of each number of an observation, in its unit: the bounds of the
    /// observation space in `env`. Any finite number, unless it is replaced.
    fn observation_high(&self, _: &Params<f32>) -> Self::Observation {
        let mut high = Self::Observation::ZEROS;
        high.as_mut().fill(f32::MAX);
        high
    }

    /// Whether the new state ends the episode: never, unless it is replaced.
    #[inline(always)]
    fn terminated<A: Arithmetic, V: Numbers<A::Scalar>>(&self, _: &Pose<V>) -> V::Mask {
        let zero = V::splat(A::Scalar::ZERO);
        zero.simd_gt(zero)
    }

    /// The reward of a step to the new state, which `terminated` the episode or not. `torque` is
    /// the one that acted, N m, with its noise. −1, or 0 if `terminated`, unless it is replaced.
    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        _pose: &Pose<V>,
        _params: &Params<V>,
        _torque: V,
        terminated: V::Mask,
    ) -> V::Single {
        V::Single::select(terminated, V::Single::splat(0.0), V::Single::splat(-1.0))
    }
}

/// Where the links of one acrobot or of many are and how they move: a state, with the sines and
/// cosines of its angles.
///
/// ```
/// use acrobot::{Params, State, task::Pose};
///
/// let pose = Pose { state: State::UPRIGHT, sin_cos: [(0.0, -1.0), (0.0, 1.0)] };
/// assert_eq!(pose.directions(), [(0.0, -1.0); 2]); // both links point up
/// assert_eq!(pose.positions(&Params::<f64>::DEFAULT), [[0.0, 1.0], [0.0, 2.0]]); // m
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Pose<V> {
    /// The state.
    pub state: State<V>,
    /// Sine and cosine of θ1, then of θ2.
    pub sin_cos: [(V, V); 2],
}

impl<V> Pose<V>
where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<Output = V> + Neg<Output = V>,
{
    /// Sine and cosine of θ1, then of θ1 + θ2: the directions of the links.
    #[must_use]
    #[inline(always)]
    pub fn directions(&self) -> [(V, V); 2] {
        directions(self.sin_cos)
    }

    /// Elbow and tip, each \[x, y\] in m from the fixed joint, y upwards.
    #[must_use]
    #[inline(always)]
    pub fn positions(&self, params: &Params<V>) -> [[V; 2]; 2] {
        positions(params, self.sin_cos)
    }
}

impl<T: Task> Given for T {
    const PARAMS: Params = <T as Task>::PARAMS;
}

/// The data of a task that has none, of which a snapshot has the name. TOML has no units, but
/// structs without fields.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct NoData {}

#[cfg(feature = "serde")]
impl<T: Task> From<T> for NoData {
    fn from(_: T) -> Self {
        Self {}
    }
}
