//! A board at a machine, or at one that this program plays.

use std::time::{Duration, Instant};

use anyhow::bail;
use machine::Machine;
use wire::{Command, Message, Reason};

use crate::line::Line;

/// How often this program says that it is still there.
const ALIVE: Duration = Duration::from_millis(100);

pub struct Bench {
    line: Line,
    pub machine: Option<Machine>,
    /// The tick that comes next.
    tick: u32,
    /// Ticks that were lost on the line.
    pub lost: u32,
    said: Instant,
}

impl Bench {
    pub fn new(line: Line, machine: Option<Machine>) -> Self {
        Self { line, machine, tick: 0, lost: 0, said: Instant::now() }
    }

    /// Begins what the command says.
    pub fn start(&mut self, command: &Command) -> anyhow::Result<()> {
        self.line.send(command)
    }

    /// What the encoders of the machine count that this program plays.
    pub fn played(&self) -> Option<[i32; 2]> {
        self.machine.as_ref().map(Machine::counts)
    }

    /// The next message, after a step of the machine that is played.
    pub fn receive(&mut self) -> anyhow::Result<Message> {
        let message = self.line.receive()?;
        match message {
            Message::Sample { tick, torque, .. } => {
                self.lost += tick.wrapping_sub(self.tick);
                self.tick = tick + 1;
                if let Some(machine) = &mut self.machine {
                    machine.step(torque);
                    self.line.send(&Command::Counts(machine.counts()))?;
                } else if self.said.elapsed() > ALIVE {
                    self.said = Instant::now();
                    self.line.send(&Command::Alive)?;
                }
            }
            // The answer to one of several requests before the command.
            Message::Stopped(Reason::Asked) | Message::Estimate { .. } => {}
            Message::Stopped(reason) => bail!("the motor is off: {}", why(reason)),
        }
        Ok(message)
    }
}

fn why(reason: Reason) -> &'static str {
    match reason {
        Reason::Asked => "the board was asked to",
        Reason::Rejected => {
            "the board rejects `dt`, or has no encoders: `--play` plays the machine for it"
        }
        Reason::Failed => {
            "no motion of the machine explains what the encoders count: is one dead or stuck, or \
             is the sign of a count or of the torque wrong?"
        }
        Reason::Late => "a tick was not done before the next one: take a longer `dt`",
        Reason::Silent => "the board received nothing for half a second",
    }
}
