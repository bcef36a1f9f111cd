//! The space of observations. That of actions is the type [`Action`](crate::Action).

use std::vec::Vec;

use rand_core::Rng;

use crate::numpy::uniform;

/// Gymnasium's `Box`: vectors of `f32`, each component between two finite bounds. It has no
/// generator: `space.seed(s)` is a new `Pcg64`.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxSpace {
    low: Vec<f32>,
    high: Vec<f32>,
}

impl BoxSpace {
    /// The vectors from `low` to `high`. `None` if the two differ in length, a bound is not finite,
    /// or a lower bound is above its upper bound.
    #[must_use]
    pub fn new(low: Vec<f32>, high: Vec<f32>) -> Option<Self> {
        let mut bounds = low.iter().zip(&high);
        let valid = low.len() == high.len()
            && bounds.all(|(low, high)| low.is_finite() && high.is_finite() && low <= high);
        valid.then_some(Self { low, high })
    }

    /// The vectors whose components have at most these magnitudes.
    pub(super) fn symmetric(mut high: Vec<f32>) -> Self {
        // A task may give any number.
        high.iter_mut().for_each(|x| *x = x.abs().min(f32::MAX));
        Self { low: high.iter().map(|x| -x).collect(), high }
    }

    /// The lower bounds.
    #[must_use]
    pub fn low(&self) -> &[f32] {
        &self.low
    }

    /// The upper bounds.
    #[must_use]
    pub fn high(&self) -> &[f32] {
        &self.high
    }

    /// Whether `vector` is in it.
    #[must_use]
    pub fn contains(&self, vector: &[f32]) -> bool {
        let mut all = vector.iter().zip(self.low.iter().zip(&self.high));
        vector.len() == self.low.len() && all.all(|(x, (low, high))| low <= x && x <= high)
    }

    /// Draws a vector: Gymnasium's `sample()`, if `rng` is a [`Pcg64`](crate::numpy::Pcg64) with
    /// the seed of the space.
    pub fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> Vec<f32> {
        let bounds = self.low.iter().zip(&self.high);
        bounds.map(|(&low, &high)| uniform(rng, low.into(), high.into()) as f32).collect()
    }
}
