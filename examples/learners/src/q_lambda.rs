//! Watkins's Q(λ) over whole episodes, from the last step to the first, with replay (Sutton & Barto 12.10; Lin 1992).

use core::ops::{Deref, DerefMut};

use rand_core::Rng;

use crate::error::Error;
use crate::learn::Learn;
use crate::values::{Features, Settings, Values, best, value_of};

/// A step of an episode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition<const D: usize> {
    state: [f32; D],
    reward: f32,
    action: u8,
    next: Next,
}

/// What follows a step.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Next {
    /// Nothing that is known: the episode was truncated before this step. It is first, so that empty memory is zeros, which
    /// a program need not contain.
    Unknown,
    /// The next transition.
    Step,
    /// The goal, whose value is 0.
    Goal,
}

impl<const D: usize> Transition<D> {
    /// Fills unused memory.
    pub const EMPTY: Self = Self {
        state: [0.0; D],
        reward: 0.0,
        action: 0,
        next: Next::Unknown,
    };
}

/// Learns after each episode from the latest steps in its memory, from the last one to the first, so that a return is
/// known before the step that led to it. The memory may hold several episodes, or a part of one.
#[derive(Debug)]
pub struct QLambda<'w, F, const S: usize, const A: usize, const D: usize, const T: usize> {
    values: Values<'w, F, S, A, D, T>,
    /// A ring of the latest transitions.
    memory: &'w mut [Transition<D>],
    /// The place after the latest transition.
    next: usize,
    state: [f32; D],
    action: usize,
}

impl<'w, F: Features<D, T>, const S: usize, const A: usize, const D: usize, const T: usize>
    QLambda<'w, F, S, A, D, T>
{
    /// The number of bytes that [`Values::save`] returns.
    pub const BYTES: usize = Values::<F, S, A, D, T>::BYTES;

    /// An untrained learner. This sets the weights to 0 and the memory to [`Transition::EMPTY`].
    ///
    /// # Errors
    ///
    /// As [`Sarsa::new`](crate::Sarsa::new), and for an empty memory.
    pub fn new(
        features: F,
        settings: Settings,
        weights: &'w mut [[f32; A]; S],
        memory: &'w mut [Transition<D>],
    ) -> Result<Self, Error> {
        Error::unless(!memory.is_empty(), "memory", 0, "at least", 1)?;
        let values = Values::new(features, settings, weights)?;
        memory.fill(Transition::EMPTY);
        Ok(Self {
            values,
            memory,
            next: 0,
            state: [0.0; D],
            action: 0,
        })
    }

    /// An ε-greedy action in `state`.
    #[inline]
    fn act<R: Rng + ?Sized>(&mut self, state: &[f32; D], rng: &mut R) -> usize {
        let (state, side) = self.fold(state);
        let (action, _) = self.choose(&self.at(&self.features.active(&state)), rng);
        (self.state, self.action) = (state, action);
        side.action::<A>(action)
    }

    /// Stores the latest step in place of the oldest.
    fn store(&mut self, reward: f32, next: Next) {
        if self.next >= self.memory.len() {
            self.next = 0;
        }
        if let Some(transition) = self.memory.get_mut(self.next) {
            *transition = Transition {
                state: self.state,
                reward,
                action: self.action as u8,
                next,
            };
        }
        self.next += 1;
    }

    /// w ← w + α (G − q(S, A)) ∇q(S, A), from the last step to the first, where G is the λ-return: R + γ max q where the
    /// greedy policy would not take the next action, and R + γ ((1 − λ) max q + λ G′) elsewhere.
    fn replay(&mut self) {
        let Settings { gamma, lambda, .. } = self.settings;
        // The return from the state after a step, as the replay of that state left it.
        let mut following = 0.0;
        let (later, earlier) = self.memory.split_at(self.next.min(self.memory.len()));
        for transition in later.iter().rev().chain(earlier.iter().rev()) {
            let slots = self.values.features.active(&transition.state);
            let values = self.values.at(&slots);
            let (greedy, value) = best(&values);
            let action = usize::from(transition.action);
            let target = match transition.next {
                Next::Step => transition.reward + gamma * following,
                Next::Goal => transition.reward,
                Next::Unknown => {
                    following = value;
                    continue;
                }
            };
            let delta = target - value_of(&values, action);
            self.values.add(&slots, action, delta);
            let (_, value) = best(&self.values.at(&slots));
            following = if action == greedy {
                value + lambda * (target - value)
            } else {
                value
            };
        }
    }
}

impl<F: Features<D, T>, const S: usize, const A: usize, const D: usize, const T: usize> Learn<D>
    for QLambda<'_, F, S, A, D, T>
{
    fn start<R: Rng + ?Sized>(&mut self, state: &[f32; D], rng: &mut R) -> usize {
        self.act(state, rng)
    }

    #[inline]
    fn step<R: Rng + ?Sized>(&mut self, reward: f32, state: &[f32; D], rng: &mut R) -> usize {
        self.store(reward, Next::Step);
        self.values.count();
        self.act(state, rng)
    }

    fn end(&mut self, reward: f32) {
        self.store(reward, Next::Goal);
        self.values.count();
        self.replay();
        self.values.advance();
    }

    fn cut(&mut self) {
        self.store(0.0, Next::Unknown);
        self.replay();
        self.values.advance();
    }
}

impl<'w, F, const S: usize, const A: usize, const D: usize, const T: usize> Deref
    for QLambda<'w, F, S, A, D, T>
{
    type Target = Values<'w, F, S, A, D, T>;

    fn deref(&self) -> &Self::Target {
        &self.values
    }
}

impl<F, const S: usize, const A: usize, const D: usize, const T: usize> DerefMut
    for QLambda<'_, F, S, A, D, T>
{
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.values
    }
}
