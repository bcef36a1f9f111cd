//! The last transitions of an episode, in fixed memory.
//!
//! ```
//! use acrobot::trajectory::Trajectory;
//! use acrobot::{Acrobot, Action, Fast};
//!
//! let mut acrobot = Acrobot::<Fast>::new(42);
//! let mut trajectory = Trajectory::<f32, 100>::new();
//! for action in Action::ALL {
//!     trajectory.step(&mut acrobot, action); // acrobot.step(action), recorded
//! }
//!
//! let mut csv = String::new();
//! trajectory.write_csv(&mut csv)?;
//! assert_eq!(csv.lines().count(), 1 + 3);
//! # Ok::<(), core::fmt::Error>(())
//! ```
//!
//! # On a microcontroller
//!
//! Formatting floats as CSV costs 28 KB of flash, and the linker cannot prove it free of panics, because `core`'s code
//! for it slices with bounds checks. The alternative is binary: with the `serde` feature, postcard writes a
//! `Transition<f32>` into 42 bytes. If you need CSV, [`Trajectory::write_row`] takes a buffer for one row:
//!
//! ```
//! # use acrobot::trajectory::Trajectory;
//! # use acrobot::{Acrobot, Action, Fast};
//! # let mut acrobot = Acrobot::<Fast>::new(42);
//! # let mut trajectory = Trajectory::<f32, 100>::new();
//! # trajectory.step(&mut acrobot, Action::Zero);
//! let mut buffer = [0; 200];
//! # let mut sent = String::new();
//! # let mut send = |text: &str| sent.push_str(text);
//! send(trajectory.write_header(&mut buffer)?);
//! for index in 0..trajectory.len() {
//!     send(trajectory.write_row(index, &mut buffer)?);
//! }
//! # let mut csv = String::new();
//! # trajectory.write_csv(&mut csv).unwrap();
//! # assert_eq!(sent, csv);
//! # Ok::<(), acrobot::Error>(())
//! ```

use core::fmt::{self, Write as _};
use core::str;

use heapless::Deque;
use rand_core::Rng;

use crate::acrobot::{Acrobot, Step};
use crate::action::Action;
use crate::arithmetic::{Arithmetic, Real};
use crate::error::Error;
use crate::physics::State;
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
    /// −1, or 0 if `terminated`.
    pub reward: f32,
    /// The state after the step.
    pub next: State<S>,
    /// Whether `next` is a goal state.
    pub terminated: bool,
    /// Whether the time limit ended the episode.
    pub truncated: bool,
}

/// An environment whose steps a [`Trajectory`] records.
mod sealed {
    use super::{Acrobot, Action, Arithmetic, Error, Rng, State, Step, TimeLimit};

    pub trait Recorded<S> {
        fn state(&self) -> State<S>;
        fn torque(&self, action: Action) -> S;
        fn step(&mut self, action: Action) -> Step;
        fn step_torque(&mut self, torque: S) -> Result<Step, Error>;
    }

    macro_rules! recorded {
        ($environment:ty, $self:ident, $acrobot:expr) => {
            impl<A: Arithmetic, R: Rng> Recorded<A::Scalar> for $environment {
                fn state(&$self) -> State<A::Scalar> {
                    $acrobot.state()
                }

                fn torque(&$self, action: Action) -> A::Scalar {
                    $acrobot.params().torque(action)
                }

                #[inline]
                fn step(&mut $self, action: Action) -> Step {
                    $self.step(action)
                }

                #[inline]
                fn step_torque(&mut $self, torque: A::Scalar) -> Result<Step, Error> {
                    $self.step_torque(torque)
                }
            }
        };
    }

    recorded!(Acrobot<A, R>, self, self);
    recorded!(TimeLimit<Acrobot<A, R>>, self, self.inner());
}

/// The last `N` transitions, oldest first. Older ones are dropped.
///
/// With `f32` it takes about 44 bytes for each transition, and no heap. See [the example](self).
#[derive(Clone, Debug)]
pub struct Trajectory<S, const N: usize> {
    /// Not heapless's history buffer, whose indexing has a bounds check that can panic.
    transitions: Deque<Transition<S>, N>,
    /// Transitions pushed since the last `clear`, including dropped ones.
    pushed: u32,
}

impl<S: Real, const N: usize> Trajectory<S, N> {
    /// An empty trajectory. `N` = 0 does not compile.
    #[must_use]
    pub const fn new() -> Self {
        const { assert!(N > 0, "a trajectory needs room for at least one transition") };
        Self {
            transitions: Deque::new(),
            pushed: 0,
        }
    }

    /// Steps an [`Acrobot`], or a [`TimeLimit`] around one, and adds the transition.
    pub fn step(&mut self, environment: &mut impl sealed::Recorded<S>, action: Action) -> Step {
        let (state, torque) = (environment.state(), environment.torque(action));
        let step = environment.step(action);
        self.record(state, torque, &step, environment.state());
        step
    }

    /// As [`step`](Self::step), with a torque in N m.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a torque that is not finite; nothing is added.
    pub fn step_torque(
        &mut self,
        environment: &mut impl sealed::Recorded<S>,
        torque: S,
    ) -> Result<Step, Error> {
        let state = environment.state();
        let step = environment.step_torque(torque)?;
        self.record(state, torque, &step, environment.state());
        Ok(step)
    }

    #[inline]
    fn record(&mut self, state: State<S>, torque: S, step: &Step, next: State<S>) {
        self.push(Transition {
            state,
            torque,
            reward: step.reward,
            next,
            terminated: step.terminated,
            truncated: step.truncated,
        });
    }

    /// Adds a transition. If there are already `N`, drops the oldest.
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

    /// Writes all transitions as CSV, oldest first, below a line of column names with units.
    ///
    /// `step` counts from 1 at the first push, including dropped ones. Numbers have the fewest digits that parse to the
    /// same bits. On a microcontroller [this costs flash](self#on-a-microcontroller).
    ///
    /// # Errors
    ///
    /// Those of `out`.
    pub fn write_csv<W: fmt::Write + ?Sized>(&self, out: &mut W) -> fmt::Result {
        out.write_str(HEADER)?;
        for (number, transition) in self.numbered() {
            row(out, number, transition)?;
        }
        Ok(())
    }

    /// Writes the line of column names of [`write_csv`](Self::write_csv), 182 bytes, into `buffer` and returns it.
    ///
    /// # Errors
    ///
    /// [`Error::BufferTooSmall`] with the length needed.
    pub fn write_header<'a>(&self, buffer: &'a mut [u8]) -> Result<&'a str, Error> {
        Buffer::write(buffer, |out| out.write_str(HEADER))
    }

    /// Writes one row of [`write_csv`](Self::write_csv) into `buffer` and returns it; index 0 is the oldest. With
    /// `f32` and Gymnasium's parameters 150 bytes are usually enough; numbers near 0 have more digits.
    ///
    /// # Errors
    ///
    /// [`Error::NoSuchIndex`] for an index of at least [`len`](Self::len), and [`Error::BufferTooSmall`] with the
    /// length needed.
    pub fn write_row<'a>(&self, index: usize, buffer: &'a mut [u8]) -> Result<&'a str, Error> {
        let Some((number, transition)) = self.numbered().nth(index) else {
            let len = self.len();
            return Err(Error::NoSuchIndex {
                name: "row",
                index,
                len,
            });
        };
        Buffer::write(buffer, |out| row(out, number, transition))
    }

    /// All transitions, each with the number of its step.
    fn numbered(&self) -> impl Iterator<Item = (u32, &Transition<S>)> {
        let forgotten = self.pushed.saturating_sub(self.len() as u32);
        let number = move |i| forgotten.saturating_add(i);
        (1..).map(number).zip(self.iter())
    }
}

const HEADER: &str = "step,theta1 (rad),theta2 (rad),dtheta1 (rad/s),dtheta2 (rad/s),torque (N m),reward,\
    next theta1 (rad),next theta2 (rad),next dtheta1 (rad/s),next dtheta2 (rad/s),\
    terminated,truncated\n";

fn row<S: Real, W: fmt::Write + ?Sized>(
    out: &mut W,
    number: u32,
    transition: &Transition<S>,
) -> fmt::Result {
    let Transition {
        state,
        torque,
        reward,
        next,
        terminated,
        truncated,
    } = transition;
    write!(out, "{number}")?;
    for x in <[S; 4]>::from(*state) {
        write!(out, ",{x}")?;
    }
    write!(out, ",{torque},{reward}")?;
    for x in <[S; 4]>::from(*next) {
        write!(out, ",{x}")?;
    }
    writeln!(out, ",{},{}", u8::from(*terminated), u8::from(*truncated))
}

/// Keeps the text that fits and counts the bytes of all.
struct Buffer<'a> {
    bytes: &'a mut [u8],
    needed: usize,
}

impl<'a> Buffer<'a> {
    /// Returns the text that `text` writes.
    fn write(
        bytes: &'a mut [u8],
        text: impl FnOnce(&mut Self) -> fmt::Result,
    ) -> Result<&'a str, Error> {
        let mut buffer = Self { bytes, needed: 0 };
        // `write_str` cannot fail, and it keeps whole strings only, which are UTF-8.
        let _ = text(&mut buffer);
        let Self { bytes, needed } = buffer;
        let len = bytes.len();
        let text = bytes
            .get(..needed)
            .and_then(|text| str::from_utf8(text).ok());
        text.ok_or(Error::BufferTooSmall { len, needed })
    }
}

impl fmt::Write for Buffer<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let end = self.needed + text.len();
        if let Some(room) = self.bytes.get_mut(self.needed..end) {
            let each = room.iter_mut().zip(text.bytes());
            each.for_each(|(to, byte)| *to = byte);
        }
        self.needed = end;
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
