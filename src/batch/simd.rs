//! The SIMD instructions that a step of a batch uses.

use super::work::Work;
use crate::arithmetic::Arithmetic;
use crate::task::Task;

/// The SIMD instructions that a step of a [`Batch`](super::Batch) uses. They change no bit.
///
/// With the `std` feature on x86-64 a batch takes the widest that the machine has. Elsewhere there
/// is only the baseline, such as WASM's simd128 or NEON.
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

    /// Whether this machine has it.
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
    #[allow(unsafe_code, reason = "the one place with instructions that the build does not assume")]
    // Inlined where there is one level, so that kernels which a program does not use are omitted.
    #[cfg_attr(not(all(feature = "std", target_arch = "x86_64")), inline(always))]
    pub(super) fn step<A: Arithmetic, T: Task, const N: usize>(self, work: Work<'_, A, T, N>) {
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        {
            #[target_feature(enable = "avx2")]
            fn with_avx2<A: Arithmetic, T: Task, const N: usize>(work: Work<'_, A, T, N>) {
                /// On the stack it aligns spilled registers. Without it they cross cache lines in
                /// every second process, because a stack begins at a random multiple of 16, and a
                /// step takes 25 % longer.
                #[repr(align(32))]
                struct Aligned {
                    _byte: u8,
                }
                std::hint::black_box(Aligned { _byte: 0 });
                work.step::<false>();
            }
            #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
            fn with_avx512<A: Arithmetic, T: Task, const N: usize>(work: Work<'_, A, T, N>) {
                work.step::<true>();
            }
            // SAFETY: the machine has the features that the function was compiled for.
            unsafe {
                match self {
                    Self::Avx2 if self.is_available() => return with_avx2(work),
                    Self::Avx512 if self.is_available() => return with_avx512(work),
                    _ => {}
                }
            }
        }
        work.step::<false>();
    }

    /// As [`step`](Self::step), on all cores: halves the blocks until a task is too small to share.
    #[cfg(feature = "rayon")]
    pub(super) fn par_step<A: Arithmetic, T: Task, const N: usize>(
        self,
        mut work: Work<'_, A, T, N>,
    ) {
        // Both are about 100 µs of work: waking a thread takes 10 µs.
        let acrobots_of_a_task = match size_of::<A::Scalar>() {
            4 => 16_384,
            _ => 1024,
        };
        if work.blocks.len() * N <= acrobots_of_a_task {
            return self.step(work);
        }
        let first = work.take(work.blocks.len() / 2);
        rayon::join(|| self.par_step(first), || self.par_step(work));
    }
}
