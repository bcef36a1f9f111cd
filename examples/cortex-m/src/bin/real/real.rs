//! What the interrupt does.

use acrobot::control::mpc::{Controller, Replanner, Settings};
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};
use machine::Shaker;
use wire::{Command, Decoder, LONGEST, Load, Message, Reason, SILENCE, encode};

use crate::board::{self, Board};

/// The time of a tick without a task, s.
const IDLE: f32 = 0.002;

#[expect(clippy::large_enum_variant, reason = "there is no heap")]
enum Task {
    None,
    Record(Shaker),
    Control(Controller<100>),
}

pub struct Real {
    board: Board,
    syst: SYST,
    decoder: Decoder,
    /// A command for the main loop.
    command: Option<Command>,
    task: Task,
    zeros: [i32; 2],
    /// Whether the desktop plays the machine, and what its encoders count before the first tick.
    is_played: bool,
    first: Option<[i32; 2]>,
    /// Ticks of the task, and those since the desktop sent something.
    ticks: u32,
    silent: u32,
    /// The time of a tick, s, and in counts of SysTick.
    dt: f32,
    period: u32,
    load: Load,
}

impl Real {
    pub fn new(board: Board, mut syst: SYST) -> Self {
        syst.set_clock_source(SystClkSource::Core);
        let mut real = Self {
            board,
            syst,
            decoder: Decoder::new(),
            command: None,
            task: Task::None,
            zeros: [0; 2],
            is_played: false,
            first: None,
            ticks: 0,
            silent: 0,
            dt: IDLE,
            period: 0,
            load: Load::default(),
        };
        real.set_period(IDLE);
        real.syst.enable_interrupt();
        real.syst.enable_counter();
        real
    }

    /// Sets the time of a tick, s. Returns whether SysTick can count it.
    fn set_period(&mut self, dt: f32) -> bool {
        let period = dt * board::COUNTS_PER_SECOND + 0.5;
        let is_possible = (1000.0..16_777_216.0).contains(&period);
        if is_possible {
            (self.dt, self.period) = (dt, period as u32);
            self.syst.set_reload(self.period - 1);
            self.syst.clear_current();
        }
        is_possible
    }

    /// Begins what the desktop asked for. Returns the settings if there is something to plan.
    pub fn start(&mut self) -> Option<Settings> {
        let (task, dt, zeros, played, settings) = match self.command.take()? {
            Command::Record { seed, dt, most, played } => {
                let shaker = Shaker::new(seed, most.into(), dt.into());
                (Task::Record(shaker), dt, [0; 2], played, None)
            }
            Command::Control { settings, zeros, played } => {
                let Ok(controller) = Controller::new(settings) else {
                    self.reject();
                    return None;
                };
                (Task::Control(controller), settings.params.dt, zeros, played, Some(settings))
            }
            _ => return None,
        };
        let has_machine = played.is_some() || self.board.counts().is_some();
        if !has_machine || !self.set_period(dt) {
            self.reject();
            return None;
        }
        (self.task, self.zeros, self.first) = (task, zeros, played);
        self.is_played = played.is_some();
        (self.ticks, self.silent, self.load) = (0, 0, Load::default());
        settings
    }

    pub fn reject(&mut self) {
        self.stop(Reason::Rejected);
    }

    fn stop(&mut self, reason: Reason) {
        self.board.set_torque(0.0);
        (self.task, self.is_played) = (Task::None, false);
        self.send(&Message::Stopped(reason));
    }

    pub fn tick(&mut self) {
        if let Err(reason) = self.try_tick() {
            self.stop(reason);
        }
    }

    fn try_tick(&mut self) -> Result<(), Reason> {
        let counts = self.counts()?;
        let torque = match &mut self.task {
            Task::None => return Ok(()),
            Task::Record(shaker) => shaker.torque(),
            Task::Control(controller) => {
                let angles = [0, 1].map(|i| counts[i].wrapping_sub(self.zeros[i]));
                let before = SYST::get_current();
                let torque = controller.tick(angles).map_err(|_| Reason::Failed)?;
                let now = SYST::get_current();
                let reloaded = if now > before { self.period } else { 0 };
                let spent = before + reloaded - now;
                self.load.slowest = self.load.slowest.max(spent * board::CYCLES_PER_COUNT);
                torque
            }
        };
        if !self.is_played {
            self.board.set_torque(torque);
        }
        self.send(&Message::Sample { tick: self.ticks, counts, torque });
        self.ticks += 1;
        if SCB::is_pendst_pending() { Err(Reason::Late) } else { Ok(()) }
    }

    /// What the encoders count. Listens to the desktop; if it plays the machine, time stands still
    /// until it has answered the last tick.
    fn counts(&mut self) -> Result<[i32; 2], Reason> {
        let counts = self.board.counts();
        if self.is_played {
            self.syst.disable_counter();
        }
        let found = self.listen(counts);
        self.syst.enable_counter();
        found
    }

    fn listen(&mut self, counts: Option<[i32; 2]>) -> Result<[i32; 2], Reason> {
        self.silent += 1;
        if let Some(counts) = self.first.take() {
            return Ok(counts);
        }
        loop {
            match self.receive() {
                Some(Command::Stop) => return Err(Reason::Asked),
                Some(Command::Counts(counts)) if self.is_played => return Ok(counts),
                Some(Command::Alive | Command::Counts(_)) => self.silent = 0,
                Some(command) => self.command = Some(command),
                None if self.is_played => {}
                None if self.silent as f32 * self.dt > SILENCE && self.is_busy() => {
                    return Err(Reason::Silent);
                }
                None => return Ok(counts.unwrap_or_default()),
            }
        }
    }

    fn is_busy(&self) -> bool {
        !matches!(self.task, Task::None)
    }

    /// The next command. The desktop notices a damaged one, because nothing follows.
    fn receive(&mut self) -> Option<Command> {
        while let Some(byte) = self.board.receive() {
            if let Some(Ok(command)) = self.decoder.push(byte) {
                return Some(command);
            }
        }
        None
    }

    pub fn send(&mut self, message: &Message) {
        self.board.send(encode(message, &mut [0; LONGEST]));
    }

    /// Between two slices of planning. Returns the tick, if there is something to plan.
    pub fn exchange(&mut self, replanner: &mut Replanner<100>) -> Option<u32> {
        let Task::Control(controller) = &mut self.task else { return None };
        replanner.exchange(controller);
        Some(self.ticks)
    }

    /// After a slice that began before this tick.
    pub fn estimate(&mut self, before: u32) -> Option<Message> {
        let Task::Control(controller) = &self.task else { return None };
        let slice_ticks = self.ticks - before;
        // Without work the main loop has waited for one tick.
        self.load.slices += u32::from(slice_ticks > 1);
        self.load.slice_ticks = self.load.slice_ticks.max(slice_ticks);
        self.load.ram = board::ram();
        let (report, state, load) = (controller.report(), controller.state(), self.load);
        let (misses, plan_age) = (report.misses, report.plan_age);
        Some(Message::Estimate { state: state.into(), misses, plan_age, load })
    }
}
