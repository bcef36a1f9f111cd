//! The settings that all acrobots of a batch share.

use core::num::NonZeroU32;

use crate::arithmetic::Arithmetic;
use crate::physics::Model;
use crate::task::ResetBounds;

/// When a batch resets an acrobot whose episode has ended: Gymnasium's `AutoresetMode`.
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
