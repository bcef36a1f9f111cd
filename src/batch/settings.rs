//! The settings that all acrobots of a batch share.

use core::num::NonZeroU32;

use super::params::ParamsKind;
use crate::arithmetic::Arithmetic;
use crate::physics::ResetBounds;

/// When a batch resets an acrobot whose episode has ended: Gymnasium's `AutoresetMode`.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Autoreset {
    /// In the next step, which ignores its action and returns the initial observation and a reward of 0.
    #[default]
    NextStep,
    /// In the step that ends the episode. It returns the initial observation of the next episode, and the last one of
    /// the ended episode in [`final_observations`](super::StepBuffers::final_observations).
    SameStep,
    /// Never. Acrobots continue after the end of an episode, as an [`Acrobot`](crate::Acrobot) does, until
    /// [`Batch::reset_masked`](super::Batch::reset_masked) or another reset.
    Disabled,
}

/// What all acrobots of a batch share.
#[derive(Clone, Debug)]
pub(super) struct Settings<A: Arithmetic, P: ParamsKind<A>> {
    pub(super) params: P::Shared,
    pub(super) bounds: ResetBounds,
    pub(super) limit: NonZeroU32,
    pub(super) autoreset: Autoreset,
}
