//! Tasks: where an episode begins, what an agent sees, its rewards, and when it ends.
//!
//! A [`Task`] is a type parameter of [`Acrobot`](crate::Acrobot) and of
//! [`Batch`](crate::batch::Batch).

mod any;
mod balance;
mod draws;
mod encoders;
pub(crate) mod episode;
mod gymnasium;
mod instruments;
mod measured;
mod memory;
mod noise;
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
pub use encoders::Encoders;
pub use gymnasium::{Gymnasium, GymnasiumV0};
pub use instruments::Instruments;
pub use measured::Measured;
pub use memory::Memory;
use memory::check_finite;
pub use observation::Observation;
pub use reset_bounds::ResetBounds;
pub use reset_options::ResetOptions;
pub use swingup::Swingup;

use crate::arithmetic::{Arithmetic, Numbers, Real};
use crate::error::Error;
use crate::physics::{Given, Params, State, directions, positions, sin_cos};

/// The longest name of a task or an arithmetic, bytes. Saving an acrobot with a longer one does not
/// compile.
#[cfg(feature = "serde")]
pub(crate) const NAME_LIMIT: usize = 16;

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

    /// What the task remembers of an acrobot between steps, `()` for nothing. [An
    /// example](crate::guide::tasks#tasks-that-remember).
    type Memory: Memory;

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

    /// Begins an episode in this pose: sets the memory, which has the numbers of the episode
    /// before, or zeros. A reset brings the generator; a state that is set brings none, and then
    /// what was drawn should stay. Nothing, unless it is replaced.
    #[inline(always)]
    fn begin<A: Arithmetic, R: Rng + ?Sized>(
        &self,
        _memory: &mut Remembered<Self, A::Scalar>,
        _pose: &Pose<A::Scalar>,
        _rng: Option<&mut R>,
    ) {
    }

    /// The torque that acts, N m, where the agent chose this one. Torque noise comes after it. The
    /// same, unless it is replaced.
    #[inline(always)]
    fn act<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        _memory: &mut Remembered<Self, V>,
        _params: &Params<V>,
        torque: V,
    ) -> V {
        torque
    }

    /// Remembers a step to the new state under a torque, N m, before its observation, end and
    /// reward. Nothing, unless it is replaced.
    #[inline(always)]
    fn remember<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        _memory: &mut Remembered<Self, V>,
        _pose: &Pose<V>,
        _params: &Params<V>,
        _torque: V,
    ) {
    }

    /// The observation: `[V; N]`, rounded to `f32` afterwards. That of
    /// [`Acrobot-v1`](Gymnasium) is `Gymnasium.observe::<A, V>(pose)`.
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V, Remembered<Self, V>>,
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
    fn terminated<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        _: &Pose<V, Remembered<Self, V>>,
    ) -> V::Mask {
        let zero = V::splat(A::Scalar::ZERO);
        zero.simd_gt(zero)
    }

    /// The reward of a step to the new state, which `terminated` the episode or not. `torque` is
    /// the one that acted, N m, with its noise. −1, or 0 if `terminated`, unless it is replaced.
    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        _pose: &Pose<V, Remembered<Self, V>>,
        _params: &Params<V>,
        _torque: V,
        terminated: V::Mask,
    ) -> V::Single {
        V::Single::select(terminated, V::Single::splat(0.0), V::Single::splat(-1.0))
    }

    /// Checks what a snapshot or a program makes an acrobot remember. Each number must be finite,
    /// unless this is replaced.
    fn check_memory<S: Real>(&self, memory: &Remembered<Self, S>) -> Result<(), Error> {
        check_finite::<Self::Memory, S>(memory)
    }
}

/// What a task remembers of one acrobot or of many: `[V; 3]` if [`Task::Memory`] is `[f32; 3]`.
pub type Remembered<T, V> = <<T as Task>::Memory as Memory>::Of<V>;

/// Where the links of one acrobot or of many are and how they move: a state, with the sines and
/// cosines of its angles, and what the task remembers.
///
/// ```
/// use acrobot::{Params, State, task::Pose};
///
/// let pose = Pose::new(State::UPRIGHT, [(0.0, -1.0), (0.0, 1.0)]);
/// assert_eq!(pose.directions(), [(0.0, -1.0); 2]); // both links point up
/// assert_eq!(pose.positions(&Params::<f64>::DEFAULT), [[0.0, 1.0], [0.0, 2.0]]); // m
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Pose<'a, V, M = ()> {
    /// The state.
    pub state: State<V>,
    /// Sine and cosine of θ1, then of θ2.
    pub sin_cos: [(V, V); 2],
    /// What the task remembers.
    pub memory: &'a M,
}

impl<S: Real> Pose<'_, S> {
    /// The pose of a state, with the sines of an arithmetic.
    #[must_use]
    pub fn of<A: Arithmetic<Scalar = S>>(state: State<S>) -> Self {
        Self::new(state, sin_cos::<A>([state.theta1, state.theta2]))
    }
}

impl<V> Pose<'_, V> {
    /// Without a memory.
    #[must_use]
    #[inline(always)]
    pub const fn new(state: State<V>, sin_cos: [(V, V); 2]) -> Self {
        Self { state, sin_cos, memory: &() }
    }
}

impl<V: Copy, M> Pose<'_, V, M> {
    /// The same pose with another memory: that of a task inside of this one, or `&()`.
    #[must_use]
    #[inline(always)]
    pub const fn with<L>(self, memory: &L) -> Pose<'_, V, L> {
        Pose { state: self.state, sin_cos: self.sin_cos, memory }
    }
}

impl<V, M> Pose<'_, V, M>
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
