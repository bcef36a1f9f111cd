//! The SIMD instructions that a step of a batch uses.

use super::block::{Block, step_blocks};
#[cfg(feature = "rayon")]
use super::buffers::take_mut;
use super::inputs::Inputs;
use super::params::ParamsKind;
use super::{Settings, StepBuffers};
use crate::arithmetic::Arithmetic;
use crate::numpy::Pcg64;

/// The SIMD instructions that a step of a [`Batch`](super::Batch) uses. They change no bit.
///
/// With the `std` feature on x86-64 a batch takes the widest that the machine has. Elsewhere there is only the
/// baseline: what the crate is compiled for, such as WASM's simd128 or NEON.
///
/// ```
/// use acrobot::Fast;
/// use acrobot::batch::{Batch, Block, SimdLevel};
/// use acrobot::numpy::Pcg64;
///
/// let mut batch = Batch::<Fast, _, _>::new(42, [Block::EMPTY; 1], [Pcg64::UNSEEDED; 16])?;
/// assert_eq!(batch.simd_level(), SimdLevel::widest());
/// batch.set_simd_level(SimdLevel::Baseline); // to compare their speed
/// # assert!(SimdLevel::widest().is_available());
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SimdLevel {
    /// What the crate is compiled for.
    Baseline,
    /// AVX2: eight `f32` at once.
    Avx2,
    /// AVX-512 with its extensions F, BW, DQ and VL: sixteen `f32` at once.
    Avx512,
}

impl SimdLevel {
    /// The widest that this machine has.
    #[must_use]
    pub fn widest() -> Self {
        [Self::Avx512, Self::Avx2]
            .into_iter()
            .find(|level| level.is_available())
            .unwrap_or(Self::Baseline)
    }

    /// Whether this machine has it. Without `std`, and on targets other than x86-64, only the baseline is available.
    #[must_use]
    pub fn is_available(self) -> bool {
        match self {
            Self::Baseline => true,
            #[cfg(all(feature = "std", target_arch = "x86_64"))]
            Self::Avx2 => std::arch::is_x86_feature_detected!("avx2"),
            #[cfg(all(feature = "std", target_arch = "x86_64"))]
            Self::Avx512 => {
                std::arch::is_x86_feature_detected!("avx512f")
                    && std::arch::is_x86_feature_detected!("avx512bw")
                    && std::arch::is_x86_feature_detected!("avx512dq")
                    && std::arch::is_x86_feature_detected!("avx512vl")
            }
            #[cfg(not(all(feature = "std", target_arch = "x86_64")))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// Steps all blocks, with the baseline if the machine does not have this level.
    #[allow(
        unsafe_code,
        reason = "the one place that uses instructions which the machine has and the build does not assume"
    )]
    pub(super) fn step<A: Arithmetic, const N: usize, P: ParamsKind<A>>(
        self,
        settings: &Settings<A, P>,
        blocks: &mut [Block<A, N, P>],
        generators: &mut [Pcg64],
        inputs: Inputs<'_, A::Scalar>,
        buffers: StepBuffers<'_>,
    ) {
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        {
            macro_rules! compiled_for {
                ($name:ident, $features:literal, $hide:literal) => {
                    #[target_feature(enable = $features)]
                    fn $name<A: Arithmetic, const N: usize, P: ParamsKind<A>>(
                        settings: &Settings<A, P>,
                        blocks: &mut [Block<A, N, P>],
                        generators: &mut [Pcg64],
                        inputs: Inputs<'_, A::Scalar>,
                        buffers: StepBuffers<'_>,
                    ) {
                        step_blocks::<A, N, P, $hide>(
                            settings, blocks, generators, inputs, buffers,
                        );
                    }
                };
            }
            compiled_for!(with_avx2, "avx2", false);
            compiled_for!(with_avx512, "avx512f,avx512bw,avx512dq,avx512vl", true);
            // SAFETY: the machine has the features that the function was compiled for.
            unsafe {
                match self {
                    Self::Avx2 if self.is_available() => {
                        return with_avx2::<A, N, P>(settings, blocks, generators, inputs, buffers);
                    }
                    Self::Avx512 if self.is_available() => {
                        return with_avx512::<A, N, P>(
                            settings, blocks, generators, inputs, buffers,
                        );
                    }
                    _ => {}
                }
            }
        }
        step_blocks::<A, N, P, false>(settings, blocks, generators, inputs, buffers);
    }

    /// As [`step`](Self::step), on all cores: halves the blocks until a task is too small to share.
    #[cfg(feature = "rayon")]
    pub(super) fn par_step<A: Arithmetic, const N: usize, P: ParamsKind<A>>(
        self,
        settings: &Settings<A, P>,
        blocks: &mut [Block<A, N, P>],
        mut generators: &mut [Pcg64],
        mut inputs: Inputs<'_, A::Scalar>,
        mut buffers: StepBuffers<'_>,
    ) {
        // Both are about 100 µs of work: waking a thread takes 10 µs.
        let acrobots_of_a_task = match size_of::<A::Scalar>() {
            4 => 16_384,
            _ => 1024,
        };
        if blocks.len() * N <= acrobots_of_a_task {
            return self.step::<A, N, P>(settings, blocks, generators, inputs, buffers);
        }
        let middle = blocks.len() / 2;
        let acrobots = middle * N;
        let (blocks1, blocks2) = blocks.split_at_mut(middle);
        // Unlike `split_at`, these cannot panic, whatever length a user's `AsMut` returns.
        let generators1 = take_mut(&mut generators, acrobots);
        let inputs1 = inputs.take(acrobots);
        let buffers1 = buffers.take(acrobots);
        rayon::join(
            || self.par_step::<A, N, P>(settings, blocks1, generators1, inputs1, buffers1),
            || self.par_step::<A, N, P>(settings, blocks2, generators, inputs, buffers),
        );
    }
}
