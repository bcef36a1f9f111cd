//! A drawing target in memory.

use std::convert::Infallible;

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Dimensions, Point, Size};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::primitives::Rectangle;

/// A target of any position and size, which takes the first pixels of each drawing and counts them.
pub struct Canvas {
    pub area: Rectangle,
    pub pixels: Vec<Option<BinaryColor>>,
    pub written: usize,
    pub most: usize,
}

impl Canvas {
    pub fn new(top_left: Point, size: Size) -> Self {
        Self::of_first(usize::MAX, Rectangle::new(top_left, size))
    }

    pub fn of_first(most: usize, area: Rectangle) -> Self {
        let len = u64::from(area.size.width) * u64::from(area.size.height);
        Self { area, pixels: vec![None; most.min(len as usize)], written: 0, most }
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
        let Rectangle { top_left, size } = self.area;
        for Pixel(Point { x, y }, color) in pixels.into_iter().take(self.most) {
            let column = i64::from(x) - i64::from(top_left.x);
            let row = i64::from(y) - i64::from(top_left.y);
            assert!((0..size.width.into()).contains(&column), "{x}");
            assert!((0..size.height.into()).contains(&row), "{y}");
            self.pixels[row as usize * size.width as usize + column as usize] = Some(color);
            self.written += 1;
        }
        Ok(())
    }
}
