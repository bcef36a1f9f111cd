//! Figures of any acrobot on targets of any size and position.

#![no_main]

use acrobot::arithmetic::Arithmetic;
use acrobot::render::{Figure, Theme};
use acrobot::{Acrobot, Fast, Portable};
use acrobot_fuzz::{number, params, state};
use embedded_graphics_core::Pixel;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Dimensions, Point, Size};
use embedded_graphics_core::pixelcolor::Gray8;
use embedded_graphics_core::primitives::Rectangle;
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;

const THEME: Theme<Gray8> = Theme {
    background: Gray8::new(0),
    target: Gray8::new(1),
    link: Gray8::new(2),
    joint: Gray8::new(3),
    torque: Gray8::new(4),
};

/// The pixels of the largest target that is drawn completely.
const MOST: u64 = 1 << 12;

/// A target that takes only pixels within its area, each once per drawing, and at most [`MOST`].
struct Canvas {
    area: Rectangle,
    pixels: Vec<Option<Gray8>>,
    writes: u64,
}

#[derive(Debug, PartialEq)]
struct Full;

impl Canvas {
    fn new(area: Rectangle) -> Self {
        let pixels = u64::from(area.size.width) * u64::from(area.size.height);
        Self {
            area,
            pixels: vec![None; pixels.min(MOST) as usize],
            writes: 0,
        }
    }

    fn is_whole(&self) -> bool {
        self.pixels.len() as u64
            == u64::from(self.area.size.width) * u64::from(self.area.size.height)
    }
}

impl Dimensions for Canvas {
    fn bounding_box(&self) -> Rectangle {
        self.area
    }
}

impl DrawTarget for Canvas {
    type Color = Gray8;
    type Error = Full;

    fn draw_iter<I: IntoIterator<Item = Pixel<Gray8>>>(
        &mut self,
        pixels: I,
    ) -> std::result::Result<(), Full> {
        for Pixel(point, color) in pixels {
            let column = i64::from(point.x) - i64::from(self.area.top_left.x);
            let row = i64::from(point.y) - i64::from(self.area.top_left.y);
            let Size { width, height } = self.area.size;
            assert!(
                (0..width.into()).contains(&column) && (0..height.into()).contains(&row),
                "{point}"
            );
            self.writes += 1;
            let index = row * i64::from(width) + column;
            let pixel = self.pixels.get_mut(index as usize).ok_or(Full)?;
            assert_ne!(*pixel, Some(color), "{point} was written again");
            *pixel = Some(color);
        }
        Ok(())
    }
}

fuzz_target!(|bytes: &[u8]| {
    let mut u = Unstructured::new(bytes);
    let _ = draw(&mut u);
});

fn draw(u: &mut Unstructured<'_>) -> Result<()> {
    let area = area(u)?;
    let (old, new) = (figure(u)?, figure(u)?);
    let (mut drawn, mut redrawn) = (Canvas::new(area), Canvas::new(area));
    let result = new.draw(&mut drawn, &THEME);
    if !is_in_i32(area) {
        assert_eq!((result, drawn.writes), (Ok(()), 0), "{area:?}");
        assert_eq!(new.redraw(&old, &mut redrawn, &THEME), Ok(()));
        assert_eq!(redrawn.writes, 0);
        return Ok(());
    }
    if !drawn.is_whole() {
        assert_eq!(result, Err(Full));
        return Ok(());
    }
    assert_eq!(
        (result, drawn.writes),
        (Ok(()), drawn.pixels.len() as u64),
        "{area:?}"
    );
    assert_eq!(old.draw(&mut redrawn, &THEME), Ok(()));
    redrawn.writes = 0;
    assert_eq!(new.redraw(&old, &mut redrawn, &THEME), Ok(()));
    assert!(redrawn.pixels == drawn.pixels, "{old:?} {new:?} {area:?}");
    assert!(redrawn.writes <= drawn.writes);
    redrawn.writes = 0;
    assert_eq!(new.redraw(&new, &mut redrawn, &THEME), Ok(()));
    assert_eq!(redrawn.writes, 0);
    Ok(())
}

fn area(u: &mut Unstructured<'_>) -> Result<Rectangle> {
    let size = match u.int_in_range(0..=3)? {
        0 => Size::new(u.int_in_range(0..=MOST as u32)?, u.int_in_range(0..=1)?),
        1 => Size::new(u.int_in_range(0..=1)?, u.int_in_range(0..=MOST as u32)?),
        2 => Size::new(u.arbitrary()?, u.arbitrary()?),
        _ => Size::new(u.int_in_range(0..=64)?, u.int_in_range(0..=64)?),
    };
    let top_left = match u.int_in_range(0..=2)? {
        0 => Point::new(u.arbitrary()?, u.arbitrary()?),
        1 => Point::new(u.arbitrary::<i8>()?.into(), u.arbitrary::<i8>()?.into()),
        _ => Point::zero(),
    };
    Ok(Rectangle::new(top_left, size))
}

/// Whether embedded-graphics can compute with this area. Others stay empty.
fn is_in_i32(Rectangle { top_left, size }: Rectangle) -> bool {
    [(top_left.x, size.width), (top_left.y, size.height)]
        .into_iter()
        .all(|(start, side)| {
            i32::try_from(side).is_ok_and(|side| start.checked_add(side).is_some())
        })
}

fn figure(u: &mut Unstructured<'_>) -> Result<Figure> {
    if u.arbitrary()? {
        figure_in::<Fast>(u)
    } else {
        figure_in::<Portable>(u)
    }
}

fn figure_in<A: Arithmetic>(u: &mut Unstructured<'_>) -> Result<Figure> {
    let mut acrobot = Acrobot::<A>::new(0);
    // A rejected state leaves the old one, which is drawn then.
    let _ = acrobot.set_state(state(u)?.cast());
    if u.arbitrary()? {
        let _ = acrobot.set_params(params(u)?.cast());
    }
    Ok(Figure::new(&acrobot).with_torque(number(u, 1.0)? as f32))
}
