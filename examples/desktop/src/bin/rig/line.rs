//! The line to a board: a serial port, or a program such as QEMU.

use std::io::{self, ErrorKind, Read, Write};
use std::process::{Child, Command as Program, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow, bail, ensure};
use wire::{Command, Decoder, Error, LONGEST, Message, Reason, VERSION, encode};

/// How long a board may say nothing. A program may have to be compiled first.
const PATIENCE: Duration = Duration::from_secs(2);
const COMPILING: Duration = Duration::from_secs(120);

pub struct Line {
    port: String,
    writer: Box<dyn Write + Send>,
    received: Receiver<io::Result<Vec<u8>>>,
    /// Bytes that were received and not decoded.
    bytes: std::vec::IntoIter<u8>,
    decoder: Decoder,
    program: Option<Child>,
    patience: Duration,
    /// Frames that were damaged.
    pub damaged: u32,
}

impl Line {
    /// Opens a serial port, or starts the program after `exec:`, and waits until the board answers.
    pub fn open(port: &str, baud: u32) -> anyhow::Result<Self> {
        let (reader, writer, program): (Box<dyn Read + Send>, Box<dyn Write + Send>, _) =
            if let Some(line) = port.strip_prefix("exec:") {
                let mut words = line.split_whitespace();
                let mut program = Program::new(words.next().unwrap_or_default());
                let program = program.args(words).stdin(Stdio::piped()).stdout(Stdio::piped());
                let mut child =
                    program.spawn().with_context(|| format!("cannot start {line:?}"))?;
                let (Some(output), Some(input)) = (child.stdout.take(), child.stdin.take()) else {
                    bail!("{line} has no input and output");
                };
                (Box::new(output), Box::new(input), Some(child))
            } else {
                let serial = serialport::new(port, baud).timeout(Duration::from_millis(100));
                let serial = serial.open().with_context(|| format!("cannot open {port}"))?;
                (Box::new(serial.try_clone()?), Box::new(serial), None)
            };
        let (sender, received) = sync_channel(16);
        thread::spawn(move || read(reader, &sender));
        let (bytes, decoder) = (Vec::new().into_iter(), Decoder::new());
        let port = port.to_string();
        let patience = if program.is_some() { COMPILING } else { PATIENCE };
        let mut line =
            Self { port, writer, received, bytes, decoder, program, patience, damaged: 0 };
        // The first ends a frame that another program has begun.
        line.send(&Command::Stop)?;
        line.send(&Command::Stop)?;
        let until = Instant::now() + line.patience;
        while line.receive()? != Message::Stopped(Reason::Asked) {
            ensure!(Instant::now() < until, "the board at {} does not stop", line.port);
        }
        (line.patience, line.damaged) = (PATIENCE, 0);
        Ok(line)
    }

    pub fn send(&mut self, command: &Command) -> anyhow::Result<()> {
        let frame = encode(command, &mut [0; LONGEST]).to_vec();
        let sent = self.writer.write_all(&frame).and_then(|()| self.writer.flush());
        sent.with_context(|| format!("cannot send to {}", self.port))
    }

    /// The next message of the board.
    pub fn receive(&mut self) -> anyhow::Result<Message> {
        let until = Instant::now() + self.patience;
        loop {
            match self.bytes.by_ref().find_map(|byte| self.decoder.push(byte)) {
                Some(Ok(message)) => return Ok(message),
                Some(Err(Error::Version(version))) => bail!(
                    "the firmware has version {version} of the messages, and this program \
                     {VERSION}: flash it again"
                ),
                Some(Err(Error::Damaged)) => self.damaged += 1,
                None => self.bytes = self.more(until)?.into_iter(),
            }
        }
    }

    fn more(&mut self, until: Instant) -> anyhow::Result<Vec<u8>> {
        let port = &self.port;
        // At another baud rate there are bytes, and no message.
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(self.silence());
        }
        match self.received.recv_timeout(left) {
            Ok(bytes) => bytes.with_context(|| format!("cannot receive from {port}")),
            Err(RecvTimeoutError::Timeout) => Err(self.silence()),
            Err(RecvTimeoutError::Disconnected) => Err(anyhow!("{port} has closed the line")),
        }
    }

    fn silence(&self) -> anyhow::Error {
        anyhow!(
            "no message comes from {} for {} s (damaged frames: {}): does the firmware `real` run \
             there, at this baud rate?",
            self.port,
            self.patience.as_secs(),
            self.damaged
        )
    }
}

/// Sends what comes, until the line ends.
fn read(mut reader: impl Read, sender: &SyncSender<io::Result<Vec<u8>>>) {
    let mut buffer = [0; 4096];
    loop {
        let bytes = match reader.read(&mut buffer) {
            Ok(0) => return,
            Ok(count) => Ok(buffer[..count].to_vec()),
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => {
                continue;
            }
            Err(error) => Err(error),
        };
        let is_error = bytes.is_err();
        if sender.send(bytes).is_err() || is_error {
            return;
        }
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        let _ = self.send(&Command::Stop);
        if let Some(program) = &mut self.program {
            let _ = program.kill();
            let _ = program.wait();
        }
    }
}
