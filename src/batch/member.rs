//! One acrobot of a batch, to save and to load.

use super::Batch;
use super::buffers::take_mut;
use super::storage::{SlicesMut, Storage};
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::numpy::Pcg64;
use crate::physics::{Params, State};
#[cfg(feature = "serde")]
use crate::snapshot::numbers;
use crate::task::{Memory, Task};

/// One acrobot of a batch, as plain data. Unlike a [whole batch](Batch#snapshots), it is stored
/// without a version. Others can continue from it by [`set_member`](Batch::set_member).
///
/// ```
/// # use acrobot::Fast;
/// # use acrobot::batch::{Batch, BatchMemory, Block, Member};
/// # use acrobot::numpy::Pcg64;
/// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
/// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
/// let best: Member<Fast> = batch.member(2)?;
/// batch.set_member(0, best.clone())?; // it continues from the best
/// assert_eq!(batch.member(0)?, best);
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Member<A: Arithmetic, M: Memory = ()> {
    /// The parameters.
    pub params: Params<A::Scalar>,
    /// The state.
    pub state: State<A::Scalar>,
    /// The number of steps since the last reset.
    pub elapsed_steps: u32,
    /// Whether its episode has ended and it waits for a reset.
    pub is_done: bool,
    /// The generator of its initial states and its torque noise.
    pub rng: Pcg64,
    /// What the [task remembers](Task::Memory).
    #[cfg_attr(
        feature = "serde",
        serde(
            skip_serializing_if = "numbers::is_empty::<A::Scalar, M>",
            default = "numbers::missing::<A::Scalar, M>",
            serialize_with = "numbers::serialize::<A::Scalar, M, _>",
            deserialize_with = "numbers::deserialize::<A::Scalar, M, _>"
        )
    )]
    pub memory: M::Of<A::Scalar>,
}

impl<A: Arithmetic, S: Storage<A, N, T::Memory>, T: Task, const N: usize> Batch<A, S, T, N> {
    /// Acrobot `index`, or [`Error::NoSuchIndex`].
    #[inline(never)] // saves flash: each call would copy the fields
    pub fn member(&self, index: usize) -> Result<Member<A, T::Memory>, Error> {
        let (block, rng) = self.block_and_rng(index)?;
        let (elapsed_steps, is_done) = block.progress(index % N);
        let (params, state) = (self.params(index)?, block.state(index % N));
        let (rng, memory) = (rng.clone(), block.memory(index % N));
        Ok(Member { params, state, elapsed_steps, is_done, rng, memory })
    }

    /// Replaces acrobot `index` by `member`. [`Autoreset::SameStep`](super::Autoreset) resets
    /// it immediately if its episode has ended.
    ///
    /// # Errors
    ///
    /// Those of [`set_state`](Self::set_state), of [`set_memory`](Self::set_memory) and of
    /// [`set_params`](Self::set_params), which fails with [`Error::SharedParams`] only for other
    /// parameters than those that all acrobots share.
    pub fn set_member(&mut self, index: usize, member: Member<A, T::Memory>) -> Result<(), Error> {
        member.state.validate()?;
        self.settings.task.check_memory(&member.memory)?;
        match &self.settings.shared {
            Some(model) if model.params == member.params => _ = self.block_and_rng(index)?,
            _ => self.set_params(index, member.params)?,
        }
        let SlicesMut { blocks, generators, lane_params, draws } = self.storage.slices_mut();
        let mut generators = generators.get_mut(index - index % N..);
        let generators = take_mut(generators.get_or_insert_default(), N);
        if let (Some(block), Some(rng)) = (blocks.get_mut(index / N), generators.get_mut(index % N))
        {
            block.set_state(index % N, member.state);
            block.set_memory(index % N, &member.memory);
            block.set_progress(index % N, member.elapsed_steps, member.is_done);
            *rng = member.rng;
            let own = lane_params.get_mut(index / N).zip(draws.as_deref());
            block.reset_done(&self.settings, generators, own);
        }
        Ok(())
    }
}
