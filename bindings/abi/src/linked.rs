//! The task of one acrobot, as functions.

use core::fmt;
use core::mem::transmute_copy;
use core::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Damped, Numbers};
use acrobot::numpy::Pcg64;
use acrobot::rand_core::Rng;
use acrobot::task::{AnyTask, Balance, Gymnasium, Pose, ResetBounds, Swingup, Task};
use acrobot::{Fast, Params, State};

/// A task whose code a program links only where it makes acrobots of this task: with [`AnyTask`]
/// itself each firmware would have 1.4 KB more. It is for one acrobot, which computes with `f32`.
#[derive(Clone, Copy)]
pub struct Linked(&'static Functions);

struct Functions {
    task: AnyTask,
    bounds: ResetBounds,
    draw: fn(ResetBounds, &mut Pcg64) -> State<f32>,
    observe: fn(&Pose<f32>) -> [f32; 6],
    terminated: fn(&Pose<f32>) -> bool,
    reward: fn(&Pose<f32>, &Params<f32>, f32, bool) -> f32,
}

const fn functions<T: Task<Observation = [f32; 6], Memory = ()>>(task: AnyTask) -> Functions {
    Functions {
        task,
        bounds: T::RESET_BOUNDS,
        draw: |bounds, rng| T::DEFAULT.draw(bounds, rng),
        observe: |pose| T::DEFAULT.observe::<Damped<Fast>, f32>(pose),
        terminated: |pose| T::DEFAULT.terminated::<Damped<Fast>, f32>(pose),
        reward: |pose, params, torque, terminated| {
            T::DEFAULT.reward::<Damped<Fast>, f32>(pose, params, torque, terminated)
        },
    }
}

impl Linked {
    pub const GYMNASIUM: Self = Self(&const { functions::<Gymnasium>(AnyTask::Gymnasium) });

    pub fn new(task: AnyTask) -> Self {
        match task {
            AnyTask::Gymnasium => Self::GYMNASIUM,
            AnyTask::Swingup => Self(&const { functions::<Swingup>(AnyTask::Swingup) }),
            AnyTask::Balance => Self(&const { functions::<Balance>(AnyTask::Balance) }),
        }
    }

    pub fn task(self) -> AnyTask {
        self.0.task
    }
}

impl fmt::Debug for Linked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.task().fmt(f)
    }
}

impl PartialEq for Linked {
    fn eq(&self, other: &Self) -> bool {
        self.task() == other.task()
    }
}

/// The same value in another generic type.
#[inline(always)]
fn same<T, U>(value: T) -> U {
    const { assert!(size_of::<T>() == size_of::<U>()) };
    // SAFETY: `V` below is `f32`, the scalar of `Damped<Fast>`, for one acrobot.
    unsafe { transmute_copy(&value) }
}

impl Task for Linked {
    const NAME: &'static str = AnyTask::NAME;
    const DEFAULT: Self = Self::GYMNASIUM;
    const MAX_STEPS: NonZeroU32 = AnyTask::MAX_STEPS;

    type Observation = [f32; 6];
    type Memory = ();

    fn name(&self) -> &'static str {
        self.task().name()
    }

    fn named(self, name: &str) -> Option<Self> {
        self.task().named(name).map(Self::new)
    }

    fn max_steps(&self) -> NonZeroU32 {
        self.task().max_steps()
    }

    fn reset_bounds(&self) -> ResetBounds {
        self.0.bounds
    }

    fn params(&self) -> Params {
        self.task().params()
    }

    fn draw<R: Rng + ?Sized>(&self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        // SAFETY: the acrobots of this crate have no other generator.
        (self.0.draw)(bounds, unsafe { &mut *(&raw mut *rng).cast() })
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> [V; 6] {
        same((self.0.observe)(same(pose)))
    }

    #[inline(always)]
    fn terminated<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V>) -> V::Mask {
        same((self.0.terminated)(same(pose)))
    }

    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V>,
        params: &Params<V>,
        torque: V,
        terminated: V::Mask,
    ) -> V::Single {
        same((self.0.reward)(same(pose), same(params), same(torque), same(terminated)))
    }
}

#[cfg(any(target_pointer_width = "64", target_family = "wasm"))]
impl serde::Serialize for Linked {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.task().serialize(serializer)
    }
}

#[cfg(any(target_pointer_width = "64", target_family = "wasm"))]
impl<'de> serde::Deserialize<'de> for Linked {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        AnyTask::deserialize(deserializer).map(Self::new)
    }
}
