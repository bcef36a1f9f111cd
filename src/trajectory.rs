//! The last transitions of an episode, in fixed memory: [an
//! example](crate::guide::embedded_topics#limits-random-actions-the-last-steps).

use core::fmt;

use heapless::Deque;
use rand_core::Rng;

use crate::acrobot::{Acrobot, Step};
use crate::action::Action;
use crate::arithmetic::{Arithmetic, Real};
use crate::error::Error;
use crate::physics::State;
use crate::task::Task;
use crate::time_limit::TimeLimit;

/// One recorded step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Transition<S = f64> {
    /// The state before the step.
    pub state: State<S>,
    /// The requested torque, N m, without noise.
    pub torque: S,
    /// The task's reward.
    pub reward: f32,
    /// The state after the step.
    pub next: State<S>,
    /// Whether the task ended the episode.
    pub terminated: bool,
    /// Whether the time limit ended the episode.
    pub truncated: bool,
}

/// The last `N` transitions, oldest first. With `f32` each takes 44 bytes.
#[derive(Clone, Debug)]
pub struct Trajectory<S, const N: usize> {
    /// Not heapless's history buffer, whose indexing can panic.
    transitions: Deque<Transition<S>, N>,
    /// Transitions pushed since the last `clear`, including dropped ones.
    pushed: u32,
}

impl<S: Real, const N: usize> Trajectory<S, N> {
    /// An empty trajectory. `N` = 0 does not compile.
    #[must_use]
    pub const fn new() -> Self {
        const { assert!(N > 0, "a trajectory needs room for at least one transition") };
        Self { transitions: Deque::new(), pushed: 0 }
    }

    /// Steps an acrobot and adds the transition.
    pub fn step<A: Arithmetic<Scalar = S>, T: Task, R: Rng>(
        &mut self,
        acrobot: &mut TimeLimit<Acrobot<A, T, R>>,
        action: Action,
    ) -> Step<T::Observation> {
        let (state, torque) = (acrobot.state(), acrobot.params().torque(action));
        let step = acrobot.step(action);
        self.record(state, torque, &step, acrobot.state());
        step
    }

    /// As [`step`](Self::step), with a torque, N m. With an error, that of
    /// [`Acrobot::step_torque`], it adds nothing.
    pub fn step_torque<A: Arithmetic<Scalar = S>, T: Task, R: Rng>(
        &mut self,
        acrobot: &mut TimeLimit<Acrobot<A, T, R>>,
        torque: S,
    ) -> Result<Step<T::Observation>, Error> {
        let state = acrobot.state();
        let step = acrobot.step_torque(torque)?;
        self.record(state, torque, &step, acrobot.state());
        Ok(step)
    }

    #[inline]
    fn record<O>(&mut self, state: State<S>, torque: S, step: &Step<O>, next: State<S>) {
        self.push(Transition {
            state,
            torque,
            reward: step.reward,
            next,
            terminated: step.terminated,
            truncated: step.truncated,
        });
    }

    /// Adds a transition. Drops the oldest if there are `N`.
    #[inline]
    pub fn push(&mut self, transition: Transition<S>) {
        if self.transitions.is_full() {
            self.transitions.pop_front();
        }
        // Cannot fail: there is room for one.
        let _ = self.transitions.push_back(transition);
        self.pushed = self.pushed.saturating_add(1);
    }

    /// Removes all transitions, for a new episode.
    pub fn clear(&mut self) {
        self.transitions.clear();
        self.pushed = 0;
    }

    /// The number of transitions, at most `N`.
    #[must_use]
    pub fn len(&self) -> usize {
        self.transitions.len()
    }

    /// Whether there are no transitions.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.transitions.is_empty()
    }

    /// All transitions, oldest first.
    pub fn iter(&self) -> impl Iterator<Item = &Transition<S>> {
        self.transitions.iter()
    }

    /// All transitions as rows of CSV, oldest first, which `write!(line, "{row}")` writes without a
    /// heap. [`HEADER`] names their columns.
    ///
    /// `step` counts from 1 at the first push, including dropped ones. Numbers have the fewest
    /// digits that parse to the same bits: in `f32` about 150 bytes a row, and more near 0.
    pub fn rows(&self) -> impl Iterator<Item = impl fmt::Display> {
        let forgotten = self.pushed.saturating_sub(self.len() as u32);
        let steps = (1..).map(move |i| forgotten.saturating_add(i));
        steps.zip(self.iter()).map(|(step, row)| Row(step, row))
    }

    /// Writes [`HEADER`] and all [`rows`](Self::rows), one a line.
    ///
    /// # Errors
    ///
    /// Those of `out`.
    pub fn write_csv<W: fmt::Write + ?Sized>(&self, out: &mut W) -> fmt::Result {
        writeln!(out, "{HEADER}")?;
        self.rows().try_for_each(|row| writeln!(out, "{row}"))
    }
}

/// The names of the columns of the CSV, with units.
pub const HEADER: &str = "step,theta1 (rad),theta2 (rad),dtheta1 (rad/s),dtheta2 (rad/s),\
    torque (N m),reward,\
    next theta1 (rad),next theta2 (rad),next dtheta1 (rad/s),next dtheta2 (rad/s),\
    terminated,truncated";

/// A transition with the number of its step.
struct Row<'a, S>(u32, &'a Transition<S>);

impl<S: Real> fmt::Display for Row<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(step, row) = self;
        write!(f, "{step}")?;
        for x in <[S; 4]>::from(row.state) {
            write!(f, ",{x}")?;
        }
        write!(f, ",{},{}", row.torque, row.reward)?;
        for x in <[S; 4]>::from(row.next) {
            write!(f, ",{x}")?;
        }
        let [terminated, truncated] = [row.terminated, row.truncated].map(u8::from);
        write!(f, ",{terminated},{truncated}")
    }
}

impl<S: Real, const N: usize> Default for Trajectory<S, N> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(feature = "defmt")]
impl<S: Real + defmt::Format, const N: usize> defmt::Format for Trajectory<S, N> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "Trajectory [");
        for transition in self.iter() {
            defmt::write!(f, "{}, ", transition);
        }
        defmt::write!(f, "]");
    }
}
