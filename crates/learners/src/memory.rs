//! The memory that a learner borrows, and its sizes.

use crate::QLambda;

/// Memory of a learner with `T` tilings: 8 bytes for each of `S` slots, and 24 for each of the
/// latest `N` steps. It should hold more steps than an episode has.
#[derive(Clone, Debug)]
pub struct Memory<const S: usize, const T: usize, const N: usize> {
    /// In each slot a weight for each torque.
    pub(crate) weights: [[f32; 2]; S],
    pub(crate) steps: [Transition; N],
}

impl<const S: usize, const T: usize, const N: usize> Memory<S, T, N> {
    /// Unused memory. It is zeros, which a program need not contain.
    pub const EMPTY: Self = Self { weights: [[0.0; 2]; S], steps: [Transition::EMPTY; N] };
}

/// All that the learner keeps fits in 16 KiB.
pub type Memory16 = Memory<1408, 16, 160>;

/// All that the learner keeps fits in 32 KiB.
pub type Memory32 = Memory<2944, 52, 300>;

/// All that the learner keeps fits in 64 KiB.
pub type Memory64 = Memory<6144, 52, 600>;

const fn fits<const S: usize, const T: usize, const N: usize>(kib: usize) -> bool {
    size_of::<Memory<S, T, N>>() + size_of::<QLambda<S, T>>() <= kib * 1024
}

const _: () =
    assert!(fits::<1408, 16, 160>(16) && fits::<2944, 52, 300>(32) && fits::<6144, 52, 600>(64));

/// A step of an episode, as the learner sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Transition {
    pub state: [f32; 4],
    pub reward: f32,
    /// Whether the torque was positive.
    pub positive: bool,
    pub next: Next,
}

/// What follows a step.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Next {
    /// Nothing that is known: the episode was truncated before this step. It is first, so that
    /// unused memory is zeros.
    Unknown,
    /// The next transition.
    Step,
    /// The goal, whose value is 0.
    Goal,
}

impl Transition {
    pub const EMPTY: Self =
        Self { state: [0.0; 4], reward: 0.0, positive: false, next: Next::Unknown };
}
