//! Which vectors a batch is stepped with.

use super::Output;
use super::Shared;
use super::block::{Block, step_blocks};
use crate::arithmetic::Arithmetic;
#[cfg(feature = "rayon")]
use crate::arithmetic::Form;
use crate::rng::Pcg64;

/// The vectors that a [`Batch`](crate::Batch) of [`Fast`](crate::Fast) is stepped with. They change
/// no bit.
///
/// With the `std` feature on x86-64 a batch takes the widest that the machine has. Elsewhere there is
/// the baseline: what the crate is compiled for, such as WASM's simd128 or NEON.
///
/// ```
/// use acrobot::{Batch, Block, Fast, Pcg64, Vectors};
///
/// let mut batch = Batch::<Fast, _, _>::new(42, [Block::EMPTY; 1], [Pcg64::UNSEEDED; 16])?;
/// batch.set_vectors(Vectors::Baseline); // in place of Vectors::widest(), to compare their speed
/// # assert!(Vectors::widest().is_available());
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Vectors {
    /// What the crate is compiled for.
    Baseline,
    /// AVX2, of eight numbers.
    Avx2,
    /// AVX-512 with its extensions F, BW, DQ and VL, of sixteen numbers.
    Avx512,
}

impl Vectors {
    /// The widest that this machine has.
    #[must_use]
    pub fn widest() -> Self {
        [Self::Avx512, Self::Avx2]
            .into_iter()
            .find(|vectors| vectors.is_available())
            .unwrap_or(Self::Baseline)
    }

    /// Whether this machine has them, and the crate was compiled to find out.
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

    /// Steps all blocks; with vectors that the machine has not, as with the baseline.
    #[allow(
        unsafe_code,
        reason = "the one point where the features of the machine are known and not those of the build"
    )]
    pub(super) fn step<A: Arithmetic, const N: usize>(
        self,
        shared: &Shared<A::Scalar>,
        blocks: &mut [Block<A::Scalar, N>],
        generators: &mut [Pcg64],
        actions: &[impl Copy + Into<u8>],
        output: Output<'_>,
    ) {
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        {
            macro_rules! compiled_for {
                ($name:ident, $features:literal) => {
                    #[target_feature(enable = $features)]
                    fn $name<A: Arithmetic, const N: usize>(
                        shared: &Shared<A::Scalar>,
                        blocks: &mut [Block<A::Scalar, N>],
                        generators: &mut [Pcg64],
                        actions: &[impl Copy + Into<u8>],
                        output: Output<'_>,
                    ) {
                        step_blocks::<A, N>(shared, blocks, generators, actions, output);
                    }
                };
            }
            compiled_for!(with_avx2, "avx2");
            compiled_for!(with_avx512, "avx512f,avx512bw,avx512dq,avx512vl");
            // SAFETY: the machine has the features that the function was compiled for.
            unsafe {
                match self {
                    Self::Avx2 if self.is_available() => {
                        return with_avx2::<A, N>(shared, blocks, generators, actions, output);
                    }
                    Self::Avx512 if self.is_available() => {
                        return with_avx512::<A, N>(shared, blocks, generators, actions, output);
                    }
                    _ => {}
                }
            }
        }
        step_blocks::<A, N>(shared, blocks, generators, actions, output);
    }

    /// The same on all cores: halves in parallel, down to what is worth a task.
    #[cfg(feature = "rayon")]
    pub(super) fn par_step<A: Arithmetic, const N: usize>(
        self,
        shared: &Shared<A::Scalar>,
        blocks: &mut [Block<A::Scalar, N>],
        generators: &mut [Pcg64],
        actions: &[impl Copy + Into<u8> + Sync],
        output: Output<'_>,
    ) {
        // Some hundred microseconds of work: waking a thread takes ten.
        let acrobots_of_a_task = match A::FORM {
            Form::Gymnasium => 1024,
            Form::Lean => 16_384,
        };
        if blocks.len() * N <= acrobots_of_a_task {
            return self.step::<A, N>(shared, blocks, generators, actions, output);
        }
        let middle = blocks.len() / 2;
        let (blocks1, blocks2) = blocks.split_at_mut(middle);
        let (generators1, generators2) = generators.split_at_mut(middle * N);
        let (actions1, actions2) = actions.split_at(middle * N);
        let (output1, output2) = output.split_at(middle * N);
        rayon::join(
            || self.par_step::<A, N>(shared, blocks1, generators1, actions1, output1),
            || self.par_step::<A, N>(shared, blocks2, generators2, actions2, output2),
        );
    }
}
