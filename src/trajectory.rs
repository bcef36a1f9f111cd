//! The last transitions, in fixed memory.

use core::fmt;

use heapless::Deque;
use rand_core::Rng;

use crate::acrobot::Acrobot;
use crate::action::Action;
use crate::arithmetic::{Arithmetic, Real};
use crate::state::State;
use crate::time_limit::{LimitedStep, TimeLimit};

/// One step as it happened.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Transition<S = f64> {
    /// The state before the step.
    pub state: State<S>,
    /// The torque that was asked for, N m, without noise.
    pub torque: S,
    /// −1, or 0 for the step that reached the goal.
    pub reward: f32,
    /// The state after the step.
    pub next: State<S>,
    /// Whether `next` is in the goal.
    pub terminated: bool,
    /// Whether the time limit ended the episode.
    pub truncated: bool,
}

/// The last `N` transitions, oldest first; what is older is forgotten.
///
/// It holds some 44 `N` bytes for `f32`, and no heap.
///
/// ```
/// use acrobot::{Acrobot, Action, Fast, TimeLimit, Trajectory};
///
/// let mut acrobot = TimeLimit::v1(Acrobot::<Fast>::new(42));
/// let mut trajectory = Trajectory::<f32, 100>::new();
/// for action in Action::ALL {
///     let step = trajectory.step(&mut acrobot, action); // acrobot.step(action), recorded
/// #   assert!(!step.ended());
/// }
///
/// let mut csv = String::new();
/// trajectory.write_csv(&mut csv)?;
/// assert_eq!(csv.lines().count(), 1 + 3);
/// # Ok::<(), core::fmt::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Trajectory<S, const N: usize> {
    /// A deque and not heapless's history buffer, which indexes with a checked branch.
    transitions: Deque<Transition<S>, N>,
    /// How many were pushed since the last `clear`, kept or not.
    pushed: u32,
}

impl<S: Real, const N: usize> Trajectory<S, N> {
    /// An empty one. `N` = 0 does not compile.
    #[must_use]
    pub const fn new() -> Self {
        const { assert!(N > 0, "a trajectory needs room for at least one transition") };
        Self {
            transitions: Deque::new(),
            pushed: 0,
        }
    }

    /// Steps `acrobot` with `action` and adds the transition.
    pub fn step<A, R>(
        &mut self,
        acrobot: &mut TimeLimit<Acrobot<A, R>>,
        action: Action,
    ) -> LimitedStep
    where
        A: Arithmetic<Scalar = S>,
        R: Rng,
    {
        let (state, torque) = (
            acrobot.inner().state(),
            acrobot.inner().params().torque(action),
        );
        let step = acrobot.step(action);
        let LimitedStep {
            reward,
            terminated,
            truncated,
            ..
        } = step;
        let next = acrobot.inner().state();
        self.push(Transition {
            state,
            torque,
            reward,
            next,
            terminated,
            truncated,
        });
        step
    }

    /// Adds the newest, in place of the oldest where all `N` are taken.
    #[inline]
    pub fn push(&mut self, transition: Transition<S>) {
        if self.transitions.is_full() {
            self.transitions.pop_front();
        }
        // There is room for one now.
        let _ = self.transitions.push_back(transition);
        self.pushed = self.pushed.saturating_add(1);
    }

    /// Forgets all, as at the start of an episode.
    pub fn clear(&mut self) {
        self.transitions.clear();
        self.pushed = 0;
    }

    /// How many there are, `N` at the most.
    #[must_use]
    pub fn len(&self) -> usize {
        self.transitions.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.transitions.is_empty()
    }

    /// All that there are, oldest first.
    pub fn iter(&self) -> impl Iterator<Item = &Transition<S>> {
        self.transitions.iter()
    }

    /// Writes them as CSV, oldest first, below a line of column names with units.
    ///
    /// `step` counts from 1 at the first push, forgotten ones included. Numbers are the shortest
    /// that read back to the same bits. To format them is the one thing in the crate that a linker
    /// cannot prove free of panics: core's own code for it has checked slices.
    ///
    /// # Errors
    ///
    /// Those of `out`.
    pub fn write_csv<W: fmt::Write + ?Sized>(&self, out: &mut W) -> fmt::Result {
        out.write_str(
            "step,theta1 (rad),theta2 (rad),dtheta1 (rad/s),dtheta2 (rad/s),torque (N m),reward,\
             next theta1 (rad),next theta2 (rad),next dtheta1 (rad/s),next dtheta2 (rad/s),\
             terminated,truncated\n",
        )?;
        let forgotten = self.pushed.saturating_sub(self.len() as u32);
        for (number, transition) in (1_u32..).zip(self.iter()) {
            let Transition {
                state,
                torque,
                reward,
                next,
                terminated,
                truncated,
            } = transition;
            write!(out, "{}", forgotten.saturating_add(number))?;
            for x in <[S; 4]>::from(*state) {
                write!(out, ",{x}")?;
            }
            write!(out, ",{torque},{reward}")?;
            for x in <[S; 4]>::from(*next) {
                write!(out, ",{x}")?;
            }
            writeln!(out, ",{},{}", u8::from(*terminated), u8::from(*truncated))?;
        }
        Ok(())
    }
}

impl<S: Real, const N: usize> Default for Trajectory<S, N> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(feature = "defmt")]
impl<S: Real + defmt::Format, const N: usize> defmt::Format for Trajectory<S, N> {
    /// All transitions, oldest first.
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "Trajectory [");
        for transition in self.iter() {
            defmt::write!(f, "{}, ", transition);
        }
        defmt::write!(f, "]");
    }
}
