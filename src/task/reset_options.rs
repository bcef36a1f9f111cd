//! What a reset may choose.

use super::reset_bounds::ResetBounds;
use crate::numpy::SeedSequence;

/// The arguments of Gymnasium's `reset(seed=…, options=…)`: `42.into()` has a seed, `bounds.into()`
/// bounds, and `ResetOptions { bounds: Some(bounds), ..42.into() }` both.
///
/// ```
/// use acrobot::task::ResetBounds;
/// use acrobot::{Acrobot, Fast, ResetOptions};
///
/// let mut acrobot = Acrobot::<Fast>::new(0);
/// // env.reset(seed=42, options={"low": 0.3, "high": 0.4})
/// let bounds = Some(ResetBounds::new(0.3, 0.4)?); // rad and rad/s
/// acrobot.reset_with(ResetOptions { bounds, ..42.into() });
/// assert!((0.3..=0.4).contains(&acrobot.state().theta1));
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ResetOptions {
    /// Seeds the generator. With `None` it continues its stream.
    pub seed: Option<SeedSequence>,
    /// The bounds of the initial state. `None`: those of the
    /// [task](crate::task::Task::RESET_BOUNDS) or of the
    /// [batch](crate::batch::Batch::reset_bounds).
    pub bounds: Option<ResetBounds>,
}

impl From<u64> for ResetOptions {
    fn from(seed: u64) -> Self {
        SeedSequence::new(seed).into()
    }
}

impl From<SeedSequence> for ResetOptions {
    fn from(seed: SeedSequence) -> Self {
        Self { seed: Some(seed), bounds: None }
    }
}

impl From<ResetBounds> for ResetOptions {
    fn from(bounds: ResetBounds) -> Self {
        Self { seed: None, bounds: Some(bounds) }
    }
}
