//! One step of an episode, of one acrobot or of many side by side.

use core::num::NonZeroU32;

use rand_core::Rng;

use super::{Pose, Remembered, Task};
use crate::arithmetic::{Arithmetic, Numbers, Real};
use crate::math::SinCos;
use crate::numpy::uniform;
use crate::physics::{Model, step as advance};

/// A step's reward, and whether the new state ends the episode.
pub(crate) type Outcome<S, V> = (<V as Numbers<S>>::Single, <V as Numbers<S>>::Mask);

/// Advances [`step`](advance)'s numbers by one dt under a constant torque, N m.
#[inline(always)]
pub(crate) fn step<A: Arithmetic, T: Task, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    y: &mut [V; 4],
    sin_cos: &mut [SinCos<V>; 2],
    torque: V,
    task: &T,
    memory: &mut Remembered<T, V>,
) -> Outcome<A::Scalar, V> {
    advance::<A, V>(model, y, sin_cos, torque);
    let pose = Pose::new((*y).into(), *sin_cos);
    task.remember::<A, V>(memory, &pose, &model.params, torque);
    let pose = pose.with(&*memory);
    let terminated = task.terminated::<A, V>(&pose);
    (task.reward::<A, V>(&pose, &model.params, torque, terminated), terminated)
}

/// Adds a draw from \[−noise, noise) to each torque with noise, from its generator. One without
/// draws nothing.
#[inline(always)]
pub(crate) fn disturb<'a, S: Real, V: Numbers<S>, R: Rng + 'a>(
    torque: V,
    noise: V,
    generators: impl Iterator<Item = Option<&'a mut R>>,
) -> V {
    if noise.all_abs_le(V::splat(S::ZERO)) {
        return torque;
    }
    draw(torque, noise, generators)
}

#[cfg_attr(feature = "std", cold)]
fn draw<'a, S: Real, V: Numbers<S>, R: Rng + 'a>(
    torque: V,
    noise: V,
    mut generators: impl Iterator<Item = Option<&'a mut R>>,
) -> V {
    torque.zip(noise, |torque, noise| match generators.next().flatten() {
        Some(rng) if noise > S::ZERO => {
            let noise = noise.to_f64();
            torque + S::from_f64(uniform(rng, -noise, noise))
        }
        _ => torque,
    })
}

/// Counts a step. Returns whether it is the last of the episode.
#[inline(always)]
pub(crate) fn count(elapsed_steps: &mut u32, max_steps: NonZeroU32) -> bool {
    *elapsed_steps = elapsed_steps.saturating_add(1);
    *elapsed_steps >= max_steps.get()
}
