//! One step of all blocks of a batch, or of some.

use core::hint::black_box;

use super::block::Block;
use super::buffers::{StepBuffers, take_mut};
use super::inputs::Inputs;
use super::lane_params::LaneParams;
use super::settings::Settings;
use crate::arithmetic::Arithmetic;
use crate::math::Kernel;
#[cfg(feature = "rayon")]
use crate::math::SimdLevel;
use crate::numpy::Pcg64;
use crate::task::{Draws, Task};

/// What a step reads and writes.
pub(super) struct Work<'a, A: Arithmetic, T: Task, const N: usize> {
    pub(super) settings: &'a Settings<A, T>,
    pub(super) blocks: &'a mut [Block<A, N, T::Memory>],
    pub(super) generators: &'a mut [Pcg64],
    /// Empty where acrobots share their parameters.
    pub(super) lane_params: &'a mut [LaneParams<A, N>],
    pub(super) draws: Option<&'a Draws<A::Scalar>>,
    pub(super) inputs: Inputs<'a, A::Scalar>,
    pub(super) buffers: StepBuffers<'a, T::Observation>,
}

impl<A: Arithmetic, T: Task, const N: usize> Kernel for Work<'_, A, T, N> {
    /// Whether acrobots share their parameters is decided once, and not for each block, which would
    /// be 3 to 6 % slower. `HIDE` keeps the model in memory: with AVX-512 the compiler would hold
    /// it in registers and spill the state, 16 % slower.
    #[inline(always)]
    fn run<const HIDE: bool>(self) {
        let Self { settings, blocks, mut generators, mut inputs, mut buffers, .. } = self;
        if let Some(model) = &settings.shared {
            let shared = LaneParams::shared(model);
            for block in blocks {
                let generators = take_mut(&mut generators, N);
                let shared = if HIDE { black_box(&shared) } else { &shared };
                let results = block.advance(settings, shared, inputs.take(N), generators);
                block.finish(settings, results, generators, None, &mut buffers);
            }
        } else if let Some(draws) = self.draws {
            for (block, own) in blocks.iter_mut().zip(self.lane_params) {
                let generators = take_mut(&mut generators, N);
                let results = block.advance(settings, own, inputs.take(N), generators);
                let own = Some((own, draws));
                block.finish(settings, results, generators, own, &mut buffers);
            }
        }
    }
}

#[cfg(feature = "rayon")]
impl<'a, A: Arithmetic, T: Task, const N: usize> Work<'a, A, T, N> {
    /// Steps on all cores: halves the blocks until a task is too small to share.
    pub(super) fn par_step(mut self, level: SimdLevel) {
        // Both are about 100 µs of work: waking a thread takes 10 µs.
        let acrobots_of_a_task = match size_of::<A::Scalar>() {
            4 => 16_384,
            _ => 1024,
        };
        if self.blocks.len() * N <= acrobots_of_a_task {
            return level.run(self);
        }
        let first = self.take(self.blocks.len() / 2);
        rayon::join(|| first.par_step(level), || self.par_step(level));
    }

    /// Splits off the first `blocks` blocks. Cannot panic, whatever the lengths.
    fn take(&mut self, blocks: usize) -> Work<'a, A, T, N> {
        let acrobots = blocks * N;
        Work {
            settings: self.settings,
            blocks: take_mut(&mut self.blocks, blocks),
            generators: take_mut(&mut self.generators, acrobots),
            lane_params: take_mut(&mut self.lane_params, blocks),
            draws: self.draws,
            inputs: self.inputs.take(acrobots),
            buffers: self.buffers.take(acrobots),
        }
    }
}
