//! What encoders make of angles: whole counts, and velocities from their differences.

use crate::error::{Error, Range};
use crate::math::{Numbers, Real};
use crate::physics::{State, wrap_each};

/// The encoders of a real machine, whose counts give the readings of [`Measured`](super::Measured)
/// with `encoder_counts` and `velocity_filter`, bit for bit: what a policy that was trained with
/// these sees on the machine.
///
/// ```
/// use acrobot::task::{Balance, Encoders, Pose, Task};
/// use acrobot::Fast;
///
/// let mut encoders = Encoders::new(4096, 0.02_f32, 0.005, [0, 0])?; // a turn, s, s, hanging
/// let state = encoders.read([2048, -10]); // each 5 ms
/// assert!(state.theta1 > 3.14 && (state.theta2 + 0.0153).abs() < 1e-4); // rad
/// let observation = Balance.observe::<Fast, f32>(&Pose::of::<Fast>(state));
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Encoders<S = f32> {
    of_a_turn: i32,
    velocity_filter: S,
    dt: S,
    newest: [S; 4],
}

impl<S: Real> Encoders<S> {
    /// Encoders with so many counts for a turn, which count this at rest. The velocities pass a
    /// low-pass filter with this time constant, s, and `dt` is the time from a reading to the next,
    /// s.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for counts of a turn that are not from 1 to 2²², for a time constant
    /// below 0, and for a `dt` that is not above 0.
    pub fn new(of_a_turn: i32, velocity_filter: S, dt: S, counts: [i32; 2]) -> Result<Self, Error> {
        Range::AtLeastZero.check("velocity_filter", velocity_filter.to_f64(), "s")?;
        Range::AboveZero.check("dt", dt.to_f64(), "s")?;
        if !(1..=1 << 22).contains(&of_a_turn) {
            let (name, value, unit) = ("encoder_counts", of_a_turn.into(), "a turn");
            return Err(Error::OutOfRange { name, value, unit, rule: "from 1 to 2²²" });
        }
        let mut encoders = Self { of_a_turn, velocity_filter, dt, newest: [S::ZERO; 4] };
        let [theta1, theta2] = encoders.angles(counts);
        encoders.newest = [theta1, theta2, S::ZERO, S::ZERO];
        Ok(encoders)
    }

    /// The state that an agent sees now, from what both encoders count, zeros included.
    pub fn read(&mut self, counts: [i32; 2]) -> State<S> {
        let (before, [theta1, theta2]) = (self.newest, self.angles(counts));
        self.newest = [theta1, theta2, S::ZERO, S::ZERO];
        differentiate::<S, S>(&mut self.newest, before, self.velocity_filter, self.dt);
        self.newest.into()
    }

    /// Within half a turn, as the angles that a simulation counts.
    fn angles(&self, counts: [i32; 2]) -> [S; 2] {
        let turn = self.of_a_turn;
        let (_, resolution) = scale::<S, S>(S::from_f64(turn.into()));
        counts.map(|count| {
            let count = count.checked_rem(turn).unwrap_or_default();
            let turns = i32::from(2 * count > turn) - i32::from(2 * count < -turn);
            S::from_f64((count - turns * turn).into()) * resolution
        })
    }
}

/// How many counts a radian has, and how many radians a count.
#[inline(always)]
pub(super) fn scale<S: Real, V: Numbers<S>>(of_a_turn: V) -> (V, V) {
    let of_a_radian = of_a_turn * V::splat(S::from_f64(1.0 / core::f64::consts::TAU));
    (of_a_radian, V::splat(S::from_f64(1.0)) / of_a_radian)
}

/// Replaces the velocities of a reading by filtered differences from the one before, `dt` earlier.
#[inline(always)]
pub(super) fn differentiate<S: Real, V: Numbers<S>>(
    newest: &mut [V; 4],
    before: [V; 4],
    filter: V,
    dt: V,
) {
    let rate = V::splat(S::from_f64(1.0)) / dt;
    let [theta1, theta2, dtheta1, dtheta2] = newest;
    let [before1, before2, slow1, slow2] = before;
    for (dtheta, turned, slow) in
        [(dtheta1, *theta1 - before1, slow1), (dtheta2, *theta2 - before2, slow2)]
    {
        *dtheta = approach(slow, wrap_each::<S, V>(turned) * rate, filter, dt);
    }
}

/// One step of a low-pass filter with this time constant, s: implicit Euler.
#[inline(always)]
pub(super) fn approach<S: Real, V: Numbers<S>>(slow: V, target: V, time_constant: V, dt: V) -> V {
    slow + dt / (dt + time_constant) * (target - slow)
}
