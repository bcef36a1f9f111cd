//! What an agent sees.

use core::fmt;

use crate::math::{Numbers, Real};

/// `[f32; N]`: the numbers that an agent sees.
///
/// ```
/// use acrobot::{Acrobot, Fast, task::Observation};
///
/// fn largest<O: Observation>(observation: O) -> f32 {
///     observation.as_ref().iter().fold(0.0, |largest, x| x.max(largest))
/// }
/// assert!(largest(Acrobot::<Fast>::new(42).observation()) > 0.99); // cos θ1 and cos θ2
/// ```
pub trait Observation:
    AsRef<[f32]> + AsMut<[f32]> + Copy + fmt::Debug + PartialEq + Send + Sync + Sealed + 'static
{
    /// As many numbers of one acrobot or of many: `[V; N]`.
    type Of<V: Copy>;

    #[doc(hidden)]
    const ZEROS: Self;

    /// The numbers of a lane below `V::LEN`, each rounded to `f32`.
    #[doc(hidden)]
    fn write<S: Real, V: Numbers<S>>(&mut self, numbers: &Self::Of<V>, lane: usize);
}

impl<const N: usize> Observation for [f32; N] {
    type Of<V: Copy> = [V; N];

    const ZEROS: Self = [0.0; N];

    #[inline(always)]
    fn write<S: Real, V: Numbers<S>>(&mut self, numbers: &[V; N], lane: usize) {
        for (to, x) in self.iter_mut().zip(numbers) {
            *to = x.lane(lane).to_f64() as f32;
        }
    }
}

pub trait Sealed {}

impl<const N: usize> Sealed for [f32; N] {}
