//! A drawing target in memory.

use std::convert::Infallible;

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Dimensions, Point, Size};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::primitives::Rectangle;

/// A target of any position and size. It counts the pixels that are written.
pub struct Canvas {
    pub area: Rectangle,
    pub pixels: Vec<Option<BinaryColor>>,
    pub written: usize,
}

impl Canvas {
    pub fn new(top_left: Point, size: Size) -> Self {
        let pixels = vec![None; (size.width * size.height) as usize];
        Self {
            area: Rectangle::new(top_left, size),
            pixels,
            written: 0,
        }
    }
}

impl Dimensions for Canvas {
    fn bounding_box(&self) -> Rectangle {
        self.area
    }
}

impl DrawTarget for Canvas {
    type Color = BinaryColor;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<BinaryColor>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        for Pixel(point, color) in pixels {
            assert!(
                self.area.contains(point),
                "{point} is outside {:?}",
                self.area
            );
            let Point { x, y } = point - self.area.top_left;
            self.pixels[y as usize * self.area.size.width as usize + x as usize] = Some(color);
            self.written += 1;
        }
        Ok(())
    }
}
