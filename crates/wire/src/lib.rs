//! What a board with an acrobot and a desktop tell each other over a serial line: a version and a
//! message in postcard's format, with a CRC of 16 bits, in a COBS frame that a 0 ends.
//!
//! ```
//! use wire::{Command, Decoder, encode};
//!
//! let mut buffer = [0; wire::LONGEST];
//! let frame = encode(&Command::Counts([-20, 4095]), &mut buffer);
//! assert_eq!(frame.len(), 9);
//! let mut decoder = Decoder::new();
//! let received = frame.iter().find_map(|&byte| decoder.push(byte));
//! assert!(matches!(received, Some(Ok(Command::Counts([-20, 4095])))));
//! ```
#![no_std]
#![forbid(unsafe_code)]

use acrobot::Params;
use acrobot::control::mpc::Settings;
use crc::{CRC_16_IBM_3740, Crc, NoTable};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// The version of these messages, which each frame has.
pub const VERSION: u8 = 1;
/// Longer than the longest frame, that of [`Command::Control`], and so short that COBS adds two
/// bytes.
pub const LONGEST: usize = 192;
/// The board switches its motor off when it has received nothing for so long, s.
pub const SILENCE: f32 = 0.5;

/// Without a table, which has 512 bytes of flash.
const CRC: Crc<u16, NoTable> = Crc::<u16, NoTable>::new(&CRC_16_IBM_3740);

/// What the desktop sends.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub enum Command {
    /// Switch the motor off.
    Stop,
    /// I am still here.
    Alive,
    /// Shake the machine: random torques of up to `most`, N m, each held for 0.05 to 0.4 s. A tick
    /// takes `dt`, s.
    Record {
        /// Draws the torques.
        seed: u64,
        /// The time of a tick.
        dt: f32,
        /// The largest torque.
        most: f32,
        /// The first counts, if the desktop plays the machine.
        played: Option<[i32; 2]>,
    },
    /// Swing the machine up and hold it.
    Control {
        /// The machine.
        #[serde(with = "SettingsFields")]
        settings: Settings,
        /// What the encoders count where the angles are 0.
        zeros: [i32; 2],
        /// The first counts, if the desktop plays the machine.
        played: Option<[i32; 2]>,
    },
    /// What the encoders of the machine that the desktop plays count after the last torque.
    Counts([i32; 2]),
}

/// The fields of the crate's type, for serde.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Settings")]
struct SettingsFields {
    params: Params<f32>,
    limit: f32,
    counts: [i32; 2],
    delay: f32,
    plan_timeout: f32,
}

/// What the board sends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Message {
    /// A tick.
    Sample {
        /// Its number, from 0.
        tick: u32,
        /// What both encoders count.
        counts: [i32; 2],
        /// The torque from then to the next tick, N m.
        torque: f32,
    },
    /// What the controller knows, a few times a second.
    Estimate {
        /// θ1, θ2, rad, and their velocities, rad/s.
        state: [f32; 4],
        /// [`misses`](acrobot::control::mpc::Report::misses).
        misses: f32,
        /// [`plan_age`](acrobot::control::mpc::Report::plan_age), s.
        plan_age: f32,
        /// What the processor does.
        load: Load,
    },
    /// The motor is off.
    Stopped(Reason),
}

/// What the processor did since the command.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// The slowest tick of the controller, in cycles; in instructions in QEMU.
    pub slowest: u32,
    /// Slices of planning, and the most ticks during one.
    pub slices: u32,
    /// The most ticks during a slice.
    pub slice_ticks: u32,
    /// Bytes of RAM in use; 0 where the board does not measure it.
    pub ram: u32,
}

/// Why the motor is off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reason {
    /// [`Command::Stop`].
    Asked,
    /// The controller rejects its settings, or the board cannot count ticks of this time.
    Rejected,
    /// The controller returns an error: of an encoder, or of a number that is not finite.
    Failed,
    /// A tick was not done before the next one.
    Late,
    /// Nothing came from the desktop for [`SILENCE`].
    Silent,
}

/// Why there is no message in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// A byte was lost or changed.
    Damaged,
    /// The sender has another [`VERSION`].
    Version(u8),
}

/// The frame of a message.
pub fn encode<'a>(message: &impl Serialize, buffer: &'a mut [u8; LONGEST]) -> &'a [u8] {
    *buffer = [0; LONGEST];
    // No message is longer than this.
    let body = postcard::to_slice(&(VERSION, message), &mut buffer[1..LONGEST - 3]);
    let len = body.map_or(0, |body| body.len());
    let (frame, _) = buffer.split_at_mut((len + 4).min(LONGEST));
    if let [_, body @ .., crc1, crc2, _] = frame {
        [*crc1, *crc2] = CRC.checksum(body).to_le_bytes();
    }
    // Each 0 becomes the distance to the next one, except the last.
    let mut distance = 0;
    for byte in frame.iter_mut().rev() {
        if *byte == 0 {
            (*byte, distance) = (distance, 0);
        }
        distance += 1;
    }
    frame
}

/// Finds messages in bytes.
#[derive(Clone, Debug)]
pub struct Decoder {
    bytes: [u8; LONGEST],
    len: usize,
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}

impl Decoder {
    /// A decoder that waits for a frame.
    #[must_use]
    pub const fn new() -> Self {
        Self { bytes: [0; LONGEST], len: 0 }
    }

    /// Takes a byte. Returns the message of the frame that it ends.
    pub fn push<T: DeserializeOwned>(&mut self, byte: u8) -> Option<Result<T, Error>> {
        if byte != 0 {
            if let Some(place) = self.bytes.get_mut(self.len) {
                *place = byte;
            }
            self.len = self.len.saturating_add(1);
            return None;
        }
        let len = core::mem::take(&mut self.len);
        (len > 0).then(|| self.bytes.get_mut(..len).ok_or(Error::Damaged).and_then(decode))
    }
}

fn decode<T: DeserializeOwned>(frame: &mut [u8]) -> Result<T, Error> {
    let mut distance = 0;
    for byte in frame.iter_mut() {
        if distance == 0 {
            distance = core::mem::take(byte);
        }
        distance -= 1;
    }
    let [_, body @ .., crc1, crc2] = frame else { return Err(Error::Damaged) };
    if distance > 0 || CRC.checksum(body) != u16::from_le_bytes([*crc1, *crc2]) {
        return Err(Error::Damaged);
    }
    match body {
        [VERSION, message @ ..] => postcard::from_bytes(message).map_err(|_| Error::Damaged),
        [version, ..] => Err(Error::Version(*version)),
        [] => Err(Error::Damaged),
    }
}
