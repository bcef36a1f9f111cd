//! Draws an episode on an SSD1306 through its driver and a bus that counts bytes, and compares the
//! display's memory with the host's drawing after each frame.
//!
//! On a board the HAL's I²C takes the place of `Bus`.

#![no_std]
#![no_main]

#[path = "../../../../tests/common/digest.rs"]
mod digest;
#[path = "../../../../tests/common/oled.rs"]
mod oled;

use core::cell::RefCell;
use core::convert::Infallible;

use cortex_m_rt::entry;
use digest::Digest;
use embedded_hal::i2c::{ErrorType, I2c, Operation};
use semihosting::{println, process};
use ssd1306::mode::DisplayConfig;
use ssd1306::prelude::{DisplayRotation, DisplaySize128x64};
use ssd1306::{I2CDisplayInterface, Ssd1306};

#[entry]
fn main() -> ! {
    let panel = RefCell::new(Panel::new());
    let interface = I2CDisplayInterface::new(Bus(&panel));
    let mut display = Ssd1306::new(interface, DisplaySize128x64, DisplayRotation::Rotate0)
        .into_buffered_graphics_mode();
    let mut digest = Digest::new();
    let (mut frames, mut first, mut refused) = (0, 0, display.init().is_err());

    let drawn = oled::play(&mut display, |display| {
        let before = panel.borrow().received;
        refused |= display.flush().is_err();
        let panel = panel.borrow();
        if frames == 0 {
            first = panel.received - before;
        }
        frames += 1;
        for word in panel.memory.chunks_exact(8) {
            digest.add(u64::from_le_bytes(word.try_into().unwrap_or_default()));
        }
        refused |= panel.unknown;
    });

    let all = panel.borrow().received;
    let equal = !refused && drawn.is_ok() && (frames, digest.0) == (oled::FRAMES, oled::DIGEST);
    println!(
        "{frames} frames; bytes on the bus: {first} for the first, {} on average",
        all / frames
    );
    if !equal {
        println!(
            "not the host's {} frames: digest {:#018x}",
            oled::FRAMES,
            digest.0
        );
    }
    process::exit(if equal { 0 } else { 1 })
}

/// What an SSD1306 makes of what it receives: windows of its memory, written from the left.
struct Panel {
    memory: [u8; 1024],
    /// First and last column, first and last group of eight rows.
    window: [u8; 4],
    /// Where the next byte goes.
    column: u8,
    page: u8,
    /// Bytes on the bus, without addresses.
    received: u32,
    /// Something that this panel does not know was received.
    unknown: bool,
}

impl Panel {
    fn new() -> Self {
        Self {
            memory: [0; 1024],
            window: [0, 127, 0, 7],
            column: 0,
            page: 0,
            received: 0,
            unknown: false,
        }
    }

    fn receive(&mut self, bytes: &[u8]) {
        self.received += bytes.len() as u32;
        match bytes {
            // A window of columns, and one of pages.
            &[0x00, 0x21, first, last] => {
                [self.window[0], self.window[1]] = [first, last];
                self.column = first;
            }
            &[0x00, 0x22, first, last] => {
                [self.window[2], self.window[3]] = [first, last];
                self.page = first;
            }
            // Settings, and switching on.
            [0x00, ..] => {}
            [0x40, data @ ..] => data.iter().for_each(|&byte| self.write(byte)),
            _ => self.unknown = true,
        }
    }

    fn write(&mut self, byte: u8) {
        let [left, right, top, bottom] = self.window;
        match self
            .memory
            .get_mut(usize::from(self.page) * 128 + usize::from(self.column))
        {
            Some(cell) => *cell = byte,
            None => self.unknown = true,
        }
        if self.column < right {
            self.column += 1;
        } else {
            self.column = left;
            self.page = if self.page < bottom {
                self.page + 1
            } else {
                top
            };
        }
    }
}

struct Bus<'a>(&'a RefCell<Panel>);

impl ErrorType for Bus<'_> {
    type Error = Infallible;
}

impl I2c for Bus<'_> {
    fn transaction(&mut self, _: u8, operations: &mut [Operation<'_>]) -> Result<(), Infallible> {
        for operation in operations {
            match operation {
                Operation::Write(bytes) => self.0.borrow_mut().receive(bytes),
                // The driver reads nothing.
                Operation::Read(_) => self.0.borrow_mut().unknown = true,
            }
        }
        Ok(())
    }
}
