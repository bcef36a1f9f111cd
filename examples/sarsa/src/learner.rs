//! Sarsa(λ) with binary features (Sutton & Barto 12.7).

use rand_core::Rng;

use crate::error::Error;
use crate::schedule::{Schedule, unit_interval};
use crate::traces::Traces;

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
    /// λ, the decay of a trace in a step, in \[0, 1\]. Traces end below 0.05 and after 64 steps.
    pub lambda: f32,
    /// The share of an error that one update removes, in (0, 1]: α times the number of tilings
    /// (Sutton & Barto 9.6).
    pub alpha: Schedule,
    /// ε, the probability of a random action, in \[0, 1\].
    pub epsilon: Schedule,
    /// A symmetry of the task.
    pub symmetry: Symmetry,
}

/// A learner with `A` actions, numbered from 0, in borrowed memory of `S` slots.
///
/// Weights start at 0, which is optimistic where rewards are negative: untried actions look best. Among
/// actions of equal value it takes the first.
#[derive(Debug)]
pub struct Sarsa<'w, F, const S: usize, const A: usize, const D: usize, const T: usize> {
    pub(crate) features: F,
    settings: Settings,
    /// Episodes that have ended.
    episode: u32,
    alpha: f32,
    epsilon: f32,
    pub(crate) weights: &'w mut [[f32; A]; S],
    traces: Traces<T>,
    slots: [u16; T],
    action: usize,
}

impl<'w, F: Features<D, T>, const S: usize, const A: usize, const D: usize, const T: usize>
    Sarsa<'w, F, S, A, D, T>
{
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
        unit_interval("gamma", settings.gamma)?;
        unit_interval("lambda", settings.lambda)?;
        let Settings { alpha, epsilon, .. } = settings;
        alpha.check(["alpha", "alpha's end"])?;
        epsilon.check(["epsilon", "epsilon's end"])?;
        if alpha.at(0) == 0.0 {
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
            episode: 0,
            alpha: alpha.at(0),
            epsilon: epsilon.at(0),
            weights,
            traces: Traces::new(settings.gamma * settings.lambda),
            slots: [0; T],
            action: 0,
        })
    }

    /// Begins an episode in `state`, without traces. Returns the first action.
    pub fn start<R: Rng + ?Sized>(&mut self, state: &[f32; D], rng: &mut R) -> usize {
        let (state, side) = self.fold(state);
        self.slots = self.features.active(&state);
        (self.action, _) = self.choose(&self.at(&self.slots), rng);
        self.traces.clear();
        self.traces.push(&self.slots, self.action);
        side.action::<A>(self.action)
    }

    /// Learns from the last action's `reward` and the state that it led to, and returns the next
    /// action: δ = R + γ q(S′, A′) − q(S, A), and w ← w + αδz (Sutton & Barto 12.7).
    ///
    /// A truncated episode ends with this and then [`Sarsa::cut`].
    #[inline]
    pub fn step<R: Rng + ?Sized>(&mut self, reward: f32, state: &[f32; D], rng: &mut R) -> usize {
        let (state, side) = self.fold(state);
        let slots = self.features.active(&state);
        let (action, value) = self.choose(&self.at(&slots), rng);
        self.learn(reward + self.settings.gamma * value, Some((&slots, action)));
        self.traces.push(&slots, action);
        (self.slots, self.action) = (slots, action);
        side.action::<A>(action)
    }

    /// Learns from the `reward` of the action that ended the episode in a terminal state, whose
    /// value is 0: δ = R − q(S, A).
    pub fn end(&mut self, reward: f32) {
        self.learn(reward, None);
        self.cut();
    }

    /// Ends an episode that was truncated after the last [`Sarsa::step`]: the schedules advance.
    pub fn cut(&mut self) {
        self.episode = self.episode.saturating_add(1);
        self.alpha = self.settings.alpha.at(self.episode);
        self.epsilon = self.settings.epsilon.at(self.episode);
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

    /// The update towards `target`.
    #[inline]
    fn learn(&mut self, target: f32, next: Option<(&[u16; T], usize)>) {
        let delta = target - value_of(&self.at(&self.slots), self.action);
        let step = self.alpha / T as f32 * delta;
        self.traces.update(self.weights, step, next);
    }

    /// q̂(s, a, w) = Σ w of the active features.
    #[inline]
    fn at(&self, slots: &[u16; T]) -> [f32; A] {
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
    fn choose<R: Rng + ?Sized>(&self, values: &[f32; A], rng: &mut R) -> (usize, f32) {
        if self.epsilon > 0.0 && (rng.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0) < self.epsilon
        {
            let action = (u64::from(rng.next_u32()) * A as u64) >> 32;
            return (action as usize, value_of(values, action as usize));
        }
        best(values)
    }

    /// The state that the learner sees instead of this one.
    #[inline]
    fn fold(&self, state: &[f32; D]) -> ([f32; D], Side) {
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
enum Side {
    Same,
    Mirrored,
}

impl Side {
    /// The action that is `action` on the other side.
    #[inline]
    fn action<const A: usize>(self, action: usize) -> usize {
        match self {
            Self::Same => action,
            Self::Mirrored => A - 1 - action,
        }
    }
}

/// The first of the actions with the highest value, and that value.
#[inline]
fn best<const A: usize>(values: &[f32; A]) -> (usize, f32) {
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
fn value_of<const A: usize>(values: &[f32; A], action: usize) -> f32 {
    values.get(action).copied().unwrap_or_default()
}
