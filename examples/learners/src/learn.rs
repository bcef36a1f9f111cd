//! The loop between a learner and its task.

use rand_core::Rng;

/// Learns from states of `D` numbers.
pub trait Learn<const D: usize> {
    /// Begins an episode in `state`. Returns the first action.
    fn start<R: Rng + ?Sized>(&mut self, state: &[f32; D], rng: &mut R) -> usize;

    /// Takes the last action's `reward` and the state that it led to, and returns the next action.
    ///
    /// A truncated episode ends with this and then [`Learn::cut`].
    fn step<R: Rng + ?Sized>(&mut self, reward: f32, state: &[f32; D], rng: &mut R) -> usize;

    /// Takes the `reward` of the action that ended the episode in a terminal state, whose value is 0.
    fn end(&mut self, reward: f32);

    /// Ends an episode that was truncated after the last [`Learn::step`]. Schedules advance.
    fn cut(&mut self);
}
