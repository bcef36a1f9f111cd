//! The settings that all acrobots of a batch share.

use core::num::NonZeroU32;

use crate::arithmetic::Arithmetic;
use crate::physics::Model;
use crate::task::ResetBounds;

/// When a batch resets an acrobot whose episode has ended: Gymnasium's `AutoresetMode`.
///
/// ```
/// # use std::num::NonZeroU32;
/// # use acrobot::Fast;
/// # use acrobot::batch::{Autoreset, Batch, BatchMemory, Block, StepBuffers};
/// # use acrobot::numpy::Pcg64;
/// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
/// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
/// batch.set_autoreset(Autoreset::SameStep);
/// batch.set_max_steps(NonZeroU32::MIN); // each step ends the episode
/// let (mut rewards, mut terminated, mut truncated) = ([0.0; 3], [false; 3], [false; 3]);
/// batch.step_into(&[2_u8; 3], StepBuffers::new(&mut rewards, &mut terminated, &mut truncated))?;
/// assert_eq!((truncated, batch.elapsed_steps(0)?), ([true; 3], 0));
/// # Ok::<(), acrobot::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Autoreset {
    /// In the next step, which ignores its action and returns the initial observation and a reward
    /// of 0.
    #[default]
    NextStep,
    /// In the step that ends the episode. It returns the initial observation of the next one, and
    /// the last of the ended one in [`final_observations`](super::StepBuffers::final_observations).
    SameStep,
    /// Never: until [`Batch::reset_masked`](super::Batch::reset_masked) or another reset acrobots
    /// step on.
    Disabled,
}

#[derive(Clone, Debug)]
pub(super) struct Settings<A: Arithmetic, T> {
    /// The parameters that all share. `None`: each has its own.
    pub(super) shared: Option<Model<A::Scalar>>,
    pub(super) bounds: ResetBounds,
    pub(super) max_steps: NonZeroU32,
    pub(super) autoreset: Autoreset,
    pub(super) task: T,
}
