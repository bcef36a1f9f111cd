//! Sarsa(λ) with binary features (Sutton & Barto 12.7).

use core::ops::{Deref, DerefMut};

use rand_core::Rng;

use crate::error::Error;
use crate::learn::Learn;
use crate::traces::Traces;
use crate::values::{Features, Settings, Values, value_of};

/// Learns in each step. Traces end below 0.05 and after 64 steps.
#[derive(Debug)]
pub struct Sarsa<'w, F, const S: usize, const A: usize, const D: usize, const T: usize> {
    values: Values<'w, F, S, A, D, T>,
    traces: Traces<T>,
    slots: [u16; T],
    action: usize,
}

impl<'w, F: Features<D, T>, const S: usize, const A: usize, const D: usize, const T: usize>
    Sarsa<'w, F, S, A, D, T>
{
    /// The number of bytes that [`Values::save`] returns.
    pub const BYTES: usize = Values::<F, S, A, D, T>::BYTES;

    /// An untrained learner. This sets the weights to 0.
    ///
    /// # Errors
    ///
    /// [`Error`] for a parameter outside its range, for no actions or more than 256, for no tilings, for
    /// features that need more slots than `S`, and for a mirror in a missing dimension. The weights are
    /// unchanged then.
    pub fn new(
        features: F,
        settings: Settings,
        weights: &'w mut [[f32; A]; S],
    ) -> Result<Self, Error> {
        Ok(Self {
            values: Values::new(features, settings, weights)?,
            traces: Traces::new(settings.gamma * settings.lambda),
            slots: [0; T],
            action: 0,
        })
    }

    /// The update towards `target`.
    #[inline]
    fn update(&mut self, target: f32, next: Option<(&[u16; T], usize)>) {
        let delta = target - value_of(&self.values.at(&self.slots), self.action);
        let step = self.values.step_size() * delta;
        self.traces.update(self.values.weights, step, next);
        self.values.count();
    }
}

impl<F: Features<D, T>, const S: usize, const A: usize, const D: usize, const T: usize> Learn<D>
    for Sarsa<'_, F, S, A, D, T>
{
    /// Begins an episode, without traces.
    fn start<R: Rng + ?Sized>(&mut self, state: &[f32; D], rng: &mut R) -> usize {
        let (state, side) = self.fold(state);
        self.slots = self.features.active(&state);
        (self.action, _) = self.choose(&self.at(&self.slots), rng);
        self.traces.clear();
        self.traces.push(&self.slots, self.action);
        side.action::<A>(self.action)
    }

    /// Learns: δ = R + γ q(S′, A′) − q(S, A), and w ← w + αδz (Sutton & Barto 12.7).
    #[inline]
    fn step<R: Rng + ?Sized>(&mut self, reward: f32, state: &[f32; D], rng: &mut R) -> usize {
        let (state, side) = self.fold(state);
        let slots = self.features.active(&state);
        let (action, value) = self.choose(&self.at(&slots), rng);
        let target = reward + self.settings.gamma * value;
        self.update(target, Some((&slots, action)));
        self.traces.push(&slots, action);
        (self.slots, self.action) = (slots, action);
        side.action::<A>(action)
    }

    /// Learns: δ = R − q(S, A).
    fn end(&mut self, reward: f32) {
        self.update(reward, None);
        self.cut();
    }

    fn cut(&mut self) {
        self.values.advance();
    }
}

impl<'w, F, const S: usize, const A: usize, const D: usize, const T: usize> Deref
    for Sarsa<'w, F, S, A, D, T>
{
    type Target = Values<'w, F, S, A, D, T>;

    fn deref(&self) -> &Self::Target {
        &self.values
    }
}

impl<F, const S: usize, const A: usize, const D: usize, const T: usize> DerefMut
    for Sarsa<'_, F, S, A, D, T>
{
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.values
    }
}
