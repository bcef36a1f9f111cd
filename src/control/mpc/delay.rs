//! The time from a torque that is sent until it acts.

use crate::arithmetic::{Damped, Fast};
use crate::error::{Error, Range};
use crate::physics::{Params, Pendulum, State};

/// The arithmetic of the estimator and of plans.
pub(super) type Arithmetic = Damped<Fast>;

/// A machine in a state. What is generic over the length of plans would compile this again.
pub(super) fn model(params: Params<f32>, state: State<f32>) -> Result<Pendulum<Arithmetic>, Error> {
    Pendulum::new(params, state)
}

/// The decisions whose torques may still wait, and the one that acts.
const SENT: usize = 16;

/// The torques on their way to the motor.
#[derive(Clone, Debug)]
pub(super) struct Delay {
    /// The torques of the last decisions, N m, from the latest.
    sent: [f32; SENT],
    /// The ticks of a decision.
    ticks: u32,
    /// How many ticks a torque is late: whole ones, and the part of one.
    late: u32,
    part: f32,
}

impl Delay {
    /// A delay, s, with ticks of `dt`, s, and decisions of so many ticks.
    pub(super) fn new(delay: f32, dt: f32, ticks: u32) -> Result<Self, Error> {
        let (name, value, unit, late) = ("delay", delay.into(), "s", delay / dt);
        Range::AtLeastZero.check(name, value, unit)?;
        if late > (SENT - 2) as f32 * ticks as f32 {
            let rule = "at most 14/22 of the machine's time, in";
            return Err(Error::OutOfRange { name, value, unit, rule });
        }
        Ok(Self { sent: [0.0; SENT], ticks, late: late as u32, part: late - late as u32 as f32 })
    }

    /// Sends the torque of a decision.
    pub(super) fn send(&mut self, torque: f32) {
        self.sent.rotate_right(1);
        self.sent[0] = torque;
    }

    /// The torque that acts from now to the next tick, so many ticks after the last decision.
    pub(super) fn acting(&self, tick: u32) -> f32 {
        let sent = |late: u32| {
            let decisions = late.saturating_sub(tick).div_ceil(self.ticks.max(1));
            self.sent.get(decisions as usize).copied().unwrap_or(0.0)
        };
        let (later, earlier) = (sent(self.late), sent(self.late.saturating_add(1)));
        later + self.part * (earlier - later)
    }

    /// The state in which the torque of a decision that is taken now begins to act, if all torques
    /// act by the same factor.
    pub(super) fn predict(
        &self,
        params: &Params<f32>,
        factor: f32,
        mut state: State<f32>,
    ) -> Result<State<f32>, Error> {
        let ticks = self.ticks.max(1);
        let (decisions, rest) = (self.late / ticks, (self.late % ticks) as f32 + self.part);
        let mut waiting = self.sent.iter().take(decisions as usize + 1).rev();
        // The earliest acts for a part of its time only.
        for (steps, ticks) in [(1, rest), (decisions as usize, ticks as f32)] {
            let torques = waiting.by_ref().take(steps);
            if ticks == 0.0 || steps == 0 {
                torques.for_each(drop);
                continue;
            }
            let params = Params { dt: ticks * params.dt, ..*params };
            let mut model = model(params, state)?;
            for torque in torques {
                model.step(factor * torque)?;
            }
            state = model.state();
        }
        Ok(state)
    }
}
