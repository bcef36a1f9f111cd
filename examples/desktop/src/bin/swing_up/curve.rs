//! The running mean of the learning curve.

use acrobot::REWARD_THRESHOLD;

/// Gymnasium's reward threshold applies to the mean of this many episodes.
const LATEST: usize = 100;

/// The mean of the latest 100 returns, or of all if there are fewer. Returns are integers, so the
/// sum is exact.
pub fn running_mean(returns: &[f32]) -> f32 {
    let latest = &returns[returns.len().saturating_sub(LATEST)..];
    latest.iter().sum::<f32>() / latest.len() as f32
}

/// The first episode after which Gymnasium calls the task solved.
pub fn solved_at(returns: &[f32]) -> Option<usize> {
    (LATEST..=returns.len()).find(|&n| running_mean(&returns[..n]) >= REWARD_THRESHOLD)
}
