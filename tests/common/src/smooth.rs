//! A task that remembers.

use core::num::NonZeroU32;

use acrobot::Params;
use acrobot::arithmetic::{Arithmetic, Numbers, Real};
use acrobot::rand_core::Rng;
use acrobot::task::{Gymnasium, Pose, Task};

/// Little change of the torque, and a goal that is drawn and moves.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Smooth;

impl Task for Smooth {
    const NAME: &'static str = "smooth";
    const DEFAULT: Self = Self;
    const MAX_STEPS: NonZeroU32 = NonZeroU32::new(60).unwrap();

    type Observation = [f32; 7];
    /// The last two torques, N m, and the goal.
    type Memory = ([f32; 2], f32);

    fn begin<A: Arithmetic, R: Rng + ?Sized>(
        &self,
        (torques, goal): &mut ([A::Scalar; 2], A::Scalar),
        _: &Pose<A::Scalar>,
        rng: Option<&mut R>,
    ) {
        *torques = [Real::ZERO; 2];
        if let Some(rng) = rng {
            *goal = Real::from_f64(f64::from(rng.next_u32() >> 8) / f64::from(1 << 24));
        }
    }

    #[inline(always)]
    fn act<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        _: &mut ([V; 2], V),
        _: &Params<V>,
        torque: V,
    ) -> V {
        torque * V::splat(Real::from_f64(0.5))
    }

    #[inline(always)]
    fn remember<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        ([before, last], goal): &mut ([V; 2], V),
        _: &Pose<V>,
        _: &Params<V>,
        torque: V,
    ) {
        (*before, *last) = (*last, torque);
        *goal = *goal + V::splat(Real::from_f64(0.001));
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(&self, pose: &Pose<V, ([V; 2], V)>) -> [V; 7] {
        let [a, b, c, d, e, f] = Gymnasium.observe::<A, V>(&pose.with(&()));
        [a, b, c, d, e, f, pose.memory.1]
    }

    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V, ([V; 2], V)>,
        _: &Params<V>,
        _: V,
        _: V::Mask,
    ) -> V::Single {
        let [before, last] = pose.memory.0;
        (-(last - before) * (last - before)).to_f32()
    }
}
