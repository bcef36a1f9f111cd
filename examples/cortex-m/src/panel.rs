//! A simulated SSD1306 and its bus. On a board the HAL's I²C replaces `Bus`.

use core::cell::RefCell;
use core::convert::Infallible;

use embedded_hal::i2c::{ErrorType, I2c, Operation};

/// An SSD1306's memory, and the window of it that received bytes are written to, from the left.
pub struct Panel {
    pub memory: [u8; 1024],
    /// First and last column, first and last group of eight rows.
    window: [u8; 4],
    /// The position of the next byte.
    column: u8,
    page: u8,
    /// Bytes on the bus, without addresses.
    pub received: u32,
    /// Whether the panel received something that it does not know.
    pub unknown: bool,
}

impl Default for Panel {
    fn default() -> Self {
        Self {
            memory: [0; 1024],
            window: [0, 127, 0, 7],
            column: 0,
            page: 0,
            received: 0,
            unknown: false,
        }
    }
}

impl Panel {
    fn receive(&mut self, bytes: &[u8]) {
        self.received += bytes.len() as u32;
        match bytes {
            // The window's columns, and its pages.
            &[0x00, 0x21, first, last] => {
                [self.window[0], self.window[1]] = [first, last];
                self.column = first;
            }
            &[0x00, 0x22, first, last] => {
                [self.window[2], self.window[3]] = [first, last];
                self.page = first;
            }
            // Settings, and power on.
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

pub struct Bus<'a>(pub &'a RefCell<Panel>);

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
