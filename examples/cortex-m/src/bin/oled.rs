//! Draws an episode on a simulated SSD1306 through its driver and a bus that counts bytes. Compares
//! the display's memory after each frame with the digest of the crate's tests.

#![no_std]
#![no_main]

use core::cell::RefCell;
use core::convert::Infallible;

use bits::{Digest, oled};
use cortex_m_rt::entry;
use embedded_hal::i2c::{ErrorType, I2c, Operation};
use semihosting::{println, process};
use ssd1306::mode::DisplayConfig;
use ssd1306::prelude::{DisplayRotation, DisplaySize128x64};
use ssd1306::{I2CDisplayInterface, Ssd1306};

#[entry]
fn main() -> ! {
    let panel = RefCell::new(Panel {
        memory: [[0; 128]; 8],
        columns: [0; 2],
        column: 0,
        page: 0,
        received: 0,
    });
    let interface = I2CDisplayInterface::new(Bus(&panel));
    let mut display = Ssd1306::new(interface, DisplaySize128x64, DisplayRotation::Rotate0)
        .into_buffered_graphics_mode();
    let mut digest = Digest::default();
    let (mut frames, mut first, mut failed) = (0, 0, display.init().is_err());

    let drawn = oled::play(&mut display, |display| {
        let before = panel.borrow().received;
        failed |= display.flush().is_err();
        let panel = panel.borrow();
        if frames == 0 {
            first = panel.received - before;
        }
        frames += 1;
        for word in panel.memory.as_flattened().as_chunks().0 {
            digest.add(u64::from_le_bytes(*word));
        }
    });

    let mean = panel.borrow().received / frames;
    let equal = !failed && drawn.is_ok() && (frames, digest.0) == (oled::FRAMES, oled::DIGEST);
    println!("{frames} frames; bytes on the bus: {first} for the first, {mean} on average");
    println!("as on a desktop: {equal}");
    process::exit(if equal { 0 } else { 1 })
}

/// An SSD1306's memory, eight rows at a time.
struct Panel {
    memory: [[u8; 128]; 8],
    /// First and last column of the window that received bytes fill.
    columns: [u8; 2],
    /// The position of the next byte.
    column: u8,
    page: u8,
    /// Bytes, without addresses.
    received: u32,
}

impl Panel {
    fn receive(&mut self, bytes: &[u8]) {
        self.received += bytes.len() as u32;
        match *bytes {
            [0x00, 0x21, first, last] => {
                self.columns = [first, last];
                self.column = first;
            }
            // The driver fills the window, so the last group of rows does not matter.
            [0x00, 0x22, first, _] => self.page = first,
            [0x00, ..] => {} // settings, and power on
            [0x40, ref data @ ..] => data.iter().for_each(|&byte| self.write(byte)),
            _ => panic!("an SSD1306 does not know these bytes: {bytes:x?}"),
        }
    }

    fn write(&mut self, byte: u8) {
        self.memory[usize::from(self.page)][usize::from(self.column)] = byte;
        let [first, last] = self.columns;
        if self.column < last {
            self.column += 1;
        } else {
            self.column = first;
            self.page += 1;
        }
    }
}

/// On a board the HAL's I²C replaces this.
struct Bus<'a>(&'a RefCell<Panel>);

impl ErrorType for Bus<'_> {
    type Error = Infallible;
}

impl I2c for Bus<'_> {
    fn transaction(&mut self, _: u8, operations: &mut [Operation<'_>]) -> Result<(), Infallible> {
        for operation in operations {
            match operation {
                Operation::Write(bytes) => self.0.borrow_mut().receive(bytes),
                Operation::Read(_) => panic!("the driver must read nothing"),
            }
        }
        Ok(())
    }
}
