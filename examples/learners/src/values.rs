//! What every learner has: weights of action values over binary features, and the choice of an action.

use rand_core::Rng;

use crate::error::Error;
use crate::schedule::{Schedule, unit_interval};

/// Turns a state of `D` numbers into the `T` binary features that are 1.
pub trait Features<const D: usize, const T: usize> {
    /// The number of slots, from 1 to 65,536. Each holds a weight for every action.
    fn slots(&self) -> usize;

    /// The `T` slots of a state, each below [`Features::slots`].
    fn active(&self, state: &[f32; D]) -> [u16; T];

    /// Passes `mix` the numbers that define these features, so that weights saved for other features are
    /// rejected.
    fn fingerprint(&self, mix: impl FnMut(u32));
}

/// Whether the learner treats two states as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// The task has no symmetry.
    None,
    /// Negating all numbers of the state and reversing the order of the actions changes nothing. The learner
    /// replaces states that are negative in this dimension by their mirror image.
    Mirror(usize),
}

/// The learner's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// γ, the discount of a step, in \[0, 1\].
    pub gamma: f32,
    /// λ, the decay of a trace in a step, in \[0, 1\].
    pub lambda: f32,
    /// The share of an error that one update removes, in (0, 1]: α times the number of tilings
    /// (Sutton & Barto 9.6).
    pub alpha: Schedule,
    /// ε, the probability of a random action, in \[0, 1\].
    pub epsilon: Schedule,
    /// A symmetry of the task.
    pub symmetry: Symmetry,
}

/// Action values in borrowed memory of `S` slots, for `A` actions, numbered from 0.
///
/// Weights start at 0, which is optimistic where rewards are negative: untried actions look best. Among
/// actions of equal value it takes the first.
#[derive(Debug)]
pub struct Values<'w, F, const S: usize, const A: usize, const D: usize, const T: usize> {
    pub(crate) features: F,
    pub(crate) settings: Settings,
    /// Episodes that have ended.
    episodes: u32,
    /// Steps that were learnt from.
    steps: u32,
    alpha: f32,
    epsilon: f32,
    pub(crate) weights: &'w mut [[f32; A]; S],
}

impl<'w, F: Features<D, T>, const S: usize, const A: usize, const D: usize, const T: usize>
    Values<'w, F, S, A, D, T>
{
    /// Untrained values. This sets the weights to 0.
    ///
    /// # Errors
    ///
    /// As [`Sarsa::new`](crate::Sarsa::new).
    pub(crate) fn new(
        features: F,
        settings: Settings,
        weights: &'w mut [[f32; A]; S],
    ) -> Result<Self, Error> {
        unit_interval("gamma", settings.gamma)?;
        unit_interval("lambda", settings.lambda)?;
        let Settings { alpha, epsilon, .. } = settings;
        alpha.check(["alpha", "alpha's end"])?;
        epsilon.check(["epsilon", "epsilon's end"])?;
        if alpha.at(0, 0) == 0.0 {
            return Err(Error::OutOfRange {
                name: "alpha",
                value: 0.0,
                rule: "above 0 and at most 1",
            });
        }
        Error::unless(T > 0, "tilings", T, "at least", 1)?;
        Error::unless((1..=256).contains(&A), "actions", A, "from 1 to", 256)?;
        let slots = features.slots();
        let fits = (1..=S).contains(&slots);
        Error::unless(fits, "slots of the features", slots, "from 1 to", S)?;
        if let Symmetry::Mirror(d) = settings.symmetry {
            Error::unless(d < D, "the mirror's dimension", d, "below", D)?;
        }
        weights.fill([0.0; A]);
        Ok(Self {
            features,
            settings,
            episodes: 0,
            steps: 0,
            alpha: alpha.at(0, 0),
            epsilon: epsilon.at(0, 0),
            weights,
        })
    }

    /// The action with the highest value; the first among equals.
    #[must_use]
    #[inline]
    pub fn greedy(&self, state: &[f32; D]) -> usize {
        let (state, side) = self.fold(state);
        let (action, _) = best(&self.at(&self.features.active(&state)));
        side.action::<A>(action)
    }

    /// q of each action, in units of the reward.
    #[must_use]
    #[inline]
    pub fn values(&self, state: &[f32; D]) -> [f32; A] {
        let (state, side) = self.fold(state);
        let values = self.at(&self.features.active(&state));
        core::array::from_fn(|action| value_of(&values, side.action::<A>(action)))
    }

    /// The weights: in each slot one for each action, in units of the reward.
    #[must_use]
    pub fn weights(&self) -> &[[f32; A]; S] {
        self.weights
    }

    /// Counts a step. The schedules advance when the episode ends.
    #[inline]
    pub(crate) fn count(&mut self) {
        self.steps = self.steps.saturating_add(1);
    }

    /// Counts an episode: the schedules advance.
    pub(crate) fn advance(&mut self) {
        self.episodes = self.episodes.saturating_add(1);
        let Settings { alpha, epsilon, .. } = self.settings;
        self.alpha = alpha.at(self.episodes, self.steps);
        self.epsilon = epsilon.at(self.episodes, self.steps);
    }

    /// Adds α/T times `delta` to the weights of the active features: the value moves by α times `delta`.
    #[inline]
    pub(crate) fn add(&mut self, slots: &[u16; T], action: usize, delta: f32) {
        let step = self.step_size() * delta;
        for &slot in slots {
            let weights = self.weights.get_mut(usize::from(slot));
            if let Some(w) = weights.and_then(|weights| weights.get_mut(action)) {
                *w += step;
            }
        }
    }

    /// α for each active feature.
    #[inline]
    pub(crate) fn step_size(&self) -> f32 {
        self.alpha / T as f32
    }

    /// q̂(s, a, w) = Σ w of the active features.
    #[inline]
    pub(crate) fn at(&self, slots: &[u16; T]) -> [f32; A] {
        let mut values = [0.0; A];
        for &slot in slots {
            if let Some(weights) = self.weights.get(usize::from(slot)) {
                for (value, w) in values.iter_mut().zip(weights) {
                    *value += w;
                }
            }
        }
        values
    }

    /// ε-greedy (Sutton & Barto 2.2): an action and its value. Draws nothing if ε is 0.
    #[inline]
    pub(crate) fn choose<R: Rng + ?Sized>(&self, values: &[f32; A], rng: &mut R) -> (usize, f32) {
        if self.epsilon > 0.0 && (rng.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0) < self.epsilon
        {
            let action = (u64::from(rng.next_u32()) * A as u64) >> 32;
            return (action as usize, value_of(values, action as usize));
        }
        best(values)
    }

    /// The state that the learner sees instead of this one.
    #[inline]
    pub(crate) fn fold(&self, state: &[f32; D]) -> ([f32; D], Side) {
        match self.settings.symmetry {
            Symmetry::Mirror(d) if state.get(d).is_some_and(|&x| x < 0.0) => {
                (state.map(|x| -x), Side::Mirrored)
            }
            _ => (*state, Side::Same),
        }
    }
}

/// On which side of the mirror a state is.
#[derive(Clone, Copy)]
pub(crate) enum Side {
    Same,
    Mirrored,
}

impl Side {
    /// The action that is `action` on the other side.
    #[inline]
    pub fn action<const A: usize>(self, action: usize) -> usize {
        match self {
            Self::Same => action,
            Self::Mirrored => A - 1 - action,
        }
    }
}

/// The first of the actions with the highest value, and that value.
#[inline]
pub(crate) fn best<const A: usize>(values: &[f32; A]) -> (usize, f32) {
    let mut best = (0, f32::NEG_INFINITY);
    for (action, &value) in values.iter().enumerate() {
        if value > best.1 {
            best = (action, value);
        }
    }
    best
}

/// Every action has a value. Indexing is avoided, because some compilers would keep its panic.
#[inline]
pub(crate) fn value_of<const A: usize>(values: &[f32; A], action: usize) -> f32 {
    values.get(action).copied().unwrap_or_default()
}
