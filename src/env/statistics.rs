//! The lengths and returns of episodes.

use std::collections::VecDeque;
use std::time::Instant;
use std::vec::Vec;

use super::Env;
use super::info::{EpisodeStatistics, Info};
use crate::acrobot::Step;
use crate::action::Action;
use crate::task::ResetOptions;

/// Gymnasium's `RecordEpisodeStatistics`: the step that ends an episode reports its statistics in
/// [`Info`].
///
/// ```
/// use acrobot::Action;
/// use acrobot::env::{Env, EpisodeStatistics, RecordEpisodeStatistics, make};
///
/// let mut env = RecordEpisodeStatistics::new(make("Acrobot-v1")?);
/// env.reset_with_seed(42);
/// let EpisodeStatistics { length, episode_return, .. } = loop {
///     if let Some(episode) = env.step(Action::Zero).info.episode {
///         break episode;
///     }
/// };
/// assert_eq!((length, episode_return), (500, -500.0));
/// assert_eq!(env.mean_return(), Some(-500.0));
/// # Ok::<(), acrobot::env::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct RecordEpisodeStatistics<E> {
    inner: E,
    started: Instant,
    episode_return: f32,
    length: u32,
    episodes: VecDeque<EpisodeStatistics>,
}

const KEPT: usize = 100;

impl<E> RecordEpisodeStatistics<E> {
    /// Records the episodes of `inner`.
    #[must_use]
    pub fn new(inner: E) -> Self {
        Self {
            inner,
            started: Instant::now(),
            episode_return: 0.0,
            length: 0,
            episodes: VecDeque::with_capacity(KEPT),
        }
    }

    /// The last 100 episodes, oldest first.
    pub fn episodes(&self) -> impl Iterator<Item = &EpisodeStatistics> {
        self.episodes.iter()
    }

    /// The mean return of these episodes. `None` before the first has ended.
    #[must_use]
    pub fn mean_return(&self) -> Option<f32> {
        let sum: f32 = self.episodes().map(|episode| episode.episode_return).sum();
        (!self.episodes.is_empty()).then(|| sum / self.episodes.len() as f32)
    }

    /// The wrapped environment.
    #[must_use]
    pub fn inner(&self) -> &E {
        &self.inner
    }

    /// The wrapped environment, to change it. Steps through this reference are not recorded.
    #[must_use]
    pub fn inner_mut(&mut self) -> &mut E {
        &mut self.inner
    }

    /// Returns the wrapped environment and drops the statistics.
    #[must_use]
    pub fn into_inner(self) -> E {
        self.inner
    }
}

impl<E: Env> Env for RecordEpisodeStatistics<E> {
    fn inner(&self) -> &dyn Env {
        &self.inner
    }

    fn inner_mut(&mut self) -> &mut dyn Env {
        &mut self.inner
    }

    fn reset_with(&mut self, options: ResetOptions) -> Vec<f32> {
        self.started = Instant::now();
        self.episode_return = 0.0;
        self.length = 0;
        self.inner.reset_with(options)
    }

    fn step(&mut self, action: Action) -> Step<Vec<f32>, Info> {
        let mut step = self.inner.step(action);
        self.episode_return += step.reward;
        self.length = self.length.saturating_add(1);
        if step.done() {
            let episode = EpisodeStatistics {
                episode_return: self.episode_return,
                length: self.length,
                elapsed: self.started.elapsed(),
            };
            if self.episodes.len() == KEPT {
                self.episodes.pop_front();
            }
            self.episodes.push_back(episode);
            step.info.episode = Some(episode);
        }
        step
    }
}
