//! A controller at a machine.

use acrobot::Error;
use acrobot::control::mpc::{Controller, Replanner, Settings};

use crate::Machine;

/// A machine, the controller that a timer's interrupt would call, and the replanner of the main
/// loop.
#[derive(Clone, Debug)]
pub struct Rehearsal {
    /// The machine.
    pub machine: Machine,
    /// Its controller.
    pub controller: Controller<100>,
    /// The most misses of its [report](acrobot::control::mpc::Report) so far.
    pub misses: f32,
    /// What broken encoders count.
    pub stuck: [Option<i32>; 2],
    replanner: Replanner<100>,
    /// The time of a slice of planning in ticks, and the ticks so far.
    slice: u32,
    ticks: u32,
}

impl Rehearsal {
    /// A machine with a controller that believes in these settings. A slice of planning takes so
    /// many ticks.
    ///
    /// # Errors
    ///
    /// The errors of [`Controller::new`] and [`Replanner::new`].
    pub fn new(machine: Machine, settings: Settings, slice: u32) -> Result<Self, Error> {
        let controller = Controller::new(settings)?;
        let replanner = Replanner::new(settings)?;
        let (misses, stuck) = (0.0, [None; 2]);
        Ok(Self { machine, controller, misses, stuck, replanner, slice, ticks: 0 })
    }

    /// Takes a tick, and returns the torque, N m.
    ///
    /// # Errors
    ///
    /// The error of [`Controller::tick`].
    pub fn tick(&mut self) -> Result<f32, Error> {
        let [count1, count2] = self.machine.counts();
        let [stuck1, stuck2] = self.stuck;
        let counts = [stuck1.unwrap_or(count1), stuck2.unwrap_or(count2)];
        let torque = self.controller.tick(counts)?;
        self.misses = self.misses.max(self.controller.report().misses);
        if self.ticks.is_multiple_of(self.slice.max(1)) {
            self.replanner.exchange(&mut self.controller);
            self.replanner.work();
        }
        self.ticks = self.ticks.wrapping_add(1);
        self.machine.step(torque);
        Ok(torque)
    }

    /// The time of all ticks so far, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        f64::from(self.ticks) * self.machine.hardware().params.dt
    }

    /// Takes the ticks of so many seconds. Returns after how many seconds both angles are within
    /// `within` rad of upright for good, or `None` if they are not for the last `held` seconds.
    ///
    /// # Errors
    ///
    /// The error of [`Controller::tick`].
    pub fn run(&mut self, seconds: f64, within: f64, held: f64) -> Result<Option<f64>, Error> {
        let dt = self.machine.hardware().params.dt;
        let ticks = (seconds / dt) as u32;
        let mut upright = 0;
        for tick in 0..ticks {
            self.tick()?;
            if self.machine.lean() > within {
                upright = tick + 1;
            }
        }
        let time = f64::from(upright) * dt;
        Ok((time + held <= seconds).then_some(time))
    }
}
