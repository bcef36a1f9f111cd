//! What a step says about an episode.

use std::time::Duration;

/// Further information from a step: Gymnasium's `info`. Acrobot itself adds none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Info {
    /// Statistics of the episode that this step ended, if
    /// [`RecordEpisodeStatistics`](super::RecordEpisodeStatistics) records them.
    pub episode: Option<EpisodeStatistics>,
}

/// Statistics of one episode.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EpisodeStatistics {
    /// The sum of its rewards.
    pub episode_return: f32,
    /// The number of its steps.
    pub length: u32,
    /// The time from its reset to its end.
    pub elapsed: Duration,
}
