//! Pictures in memory: RGB bytes and text.

use core::convert::Infallible;
use std::string::String;
use std::vec::Vec;

use embedded_graphics_core::Pixel;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{OriginDimensions, Point, Size};
use embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};

use super::{Figure, Theme};

/// A picture of RGB bytes: Gymnasium's `rgb_array`, and an embedded-graphics target. The crate
/// `png` writes [`bytes`](Self::bytes) as `ColorType::Rgb`: [an
/// example](crate::guide::rust#spaces-wrappers-rendering).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    width: u32,
    height: u32,
    bytes: Vec<u8>,
}

/// The width and height of Gymnasium's frames, pixels.
const SIZE: u32 = 500;

impl Frame {
    /// The figure in Gymnasium's size and colours: 500 × 500 pixels.
    #[must_use]
    pub fn of(figure: &Figure) -> Self {
        let mut frame = Self::black(SIZE, SIZE);
        let Ok(()) = figure.draw(&mut frame, &Theme::GYMNASIUM);
        frame
    }

    /// A black frame of this size in pixels. `None` if it does not fit into memory.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Option<Self> {
        let len = (width as usize).checked_mul(height as usize)?.checked_mul(3)?;
        let mut bytes = Vec::new();
        bytes.try_reserve_exact(len).ok()?;
        bytes.resize(len, 0);
        Some(Self { width, height, bytes })
    }

    /// As [`new`](Self::new), for a size that is known to be small.
    fn black(width: u32, height: u32) -> Self {
        Self { width, height, bytes: std::vec![0; 3 * (width * height) as usize] }
    }

    /// The width, pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// The height, pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Red, green and blue of each pixel, row by row from the top left: `height` × `width` × 3.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}

impl OriginDimensions for Frame {
    fn size(&self) -> Size {
        Size::new(self.width, self.height)
    }
}

impl DrawTarget for Frame {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        for Pixel(Point { x, y }, color) in pixels {
            if let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y))
                && x < self.width
                && y < self.height
            {
                let start = (y as usize * self.width as usize + x as usize) * 3;
                if let Some(pixel) = self.bytes.get_mut(start..start + 3) {
                    pixel.copy_from_slice(&[color.r(), color.g(), color.b()]);
                }
            }
        }
        Ok(())
    }
}

impl Figure {
    /// The figure in 20 lines of 40 braille characters, each of 2 × 4 dots.
    #[must_use]
    pub fn braille(&self) -> String {
        const COLUMNS: usize = 40;
        const LINES: usize = 20;
        /// The bit of each dot in a code point, by row and column within a character.
        const BITS: [[u32; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];

        let mut frame = Frame::black(2 * COLUMNS as u32, 4 * LINES as u32);
        let Ok(()) = self.draw(&mut frame, &Theme::MONOCHROME.map(Rgb888::from));
        let is_on = |x, y| frame.bytes.get(3 * (2 * COLUMNS * y + x)) == Some(&255);
        let character = |line, column| {
            let mut dots = 0;
            for (y, row) in (4 * line..).zip(BITS) {
                for (x, bit) in (2 * column..).zip(row) {
                    if is_on(x, y) {
                        dots |= bit;
                    }
                }
            }
            char::from_u32(0x2800 + dots)
        };
        let line = |line| (0..COLUMNS).filter_map(|column| character(line, column)).collect();
        core::array::from_fn::<String, LINES, _>(line).join("\n")
    }
}
