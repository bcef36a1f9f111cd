//! SIMD instructions that are detected at run time.

/// The SIMD instructions that a step of a [`Batch`](crate::batch::Batch) or plans side by side use.
/// They change no bit.
///
/// With the `std` feature on x86-64 they are the widest that the machine has. Elsewhere there
/// is only the baseline, such as WASM's simd128 or NEON.
///
/// ```
/// # use acrobot::Fast;
/// # use acrobot::batch::{Batch, BatchMemory, Block, SimdLevel};
/// # use acrobot::numpy::Pcg64;
/// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
/// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
/// assert_eq!(batch.simd_level(), SimdLevel::widest());
/// batch.set_simd_level(SimdLevel::Baseline);
/// assert!(batch.simd_level().is_available()); // on each machine
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

/// A loop over lanes.
pub(crate) trait Kernel {
    /// Must be `#[inline(always)]`, and so must be what it calls: a function out of line may not
    /// use the SIMD instructions of its caller.
    fn run<const AVX512: bool>(self);
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

    /// Runs a kernel, with the baseline if the machine does not have this level.
    #[allow(unsafe_code, reason = "the one place with instructions that the build does not assume")]
    // Inlined in firmware, so that what it does not use of a kernel is omitted, and in WebAssembly,
    // where a step of a batch takes 14 % longer otherwise.
    #[cfg_attr(any(target_os = "none", target_family = "wasm"), inline(always))]
    pub(crate) fn run<K: Kernel>(self, kernel: K) {
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        {
            #[target_feature(enable = "avx2")]
            fn with_avx2<K: Kernel>(kernel: K) {
                /// On the stack it aligns spilled registers. Without it they cross cache lines in
                /// every second process, because a stack begins at a random multiple of 16, and a
                /// step takes 25 % longer.
                #[repr(align(32))]
                struct Aligned {
                    _byte: u8,
                }
                std::hint::black_box(Aligned { _byte: 0 });
                kernel.run::<false>();
            }
            #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
            fn with_avx512<K: Kernel>(kernel: K) {
                kernel.run::<true>();
            }
            // SAFETY: the machine has the features that the function was compiled for.
            unsafe {
                match self {
                    Self::Avx2 if self.is_available() => return with_avx2(kernel),
                    Self::Avx512 if self.is_available() => return with_avx512(kernel),
                    _ => {}
                }
            }
        }
        kernel.run::<false>();
    }
}
