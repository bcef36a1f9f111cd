//! Pictures of any acrobot on a target of any position and size.

use acrobot::arithmetic::Portable;
use acrobot::render::{Figure, Theme};
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::primitives::Rectangle;
use proptest::prelude::*;

use crate::given::{Range, Tested, acrobot, holds, params, state};
use common::canvas::Canvas;
use common::in_every_arithmetic;

fn figure<A: Tested>() -> impl Strategy<Value = Figure> {
    let given = (params::<A>(Range::Any), state(Range::Any), prop::num::f32::ANY);
    given.prop_map(|(params, state, torque)| {
        Figure::new(&acrobot::<A>(params, state, 0)).with_torque(torque)
    })
}

/// The canvas rejects pixels outside it.
#[test]
fn every_pixel_is_drawn_once_and_a_redraw_writes_those_that_change() {
    fn check<A: Tested>() {
        let sides = prop_oneof![
            4 => (0..70_u32, 0..70_u32),
            1 => (0..3_u32, 900..1000_u32),
            1 => (900..1000_u32, 0..3_u32),
        ];
        let corner = (-500..500, -500..500);
        let given = (figure::<A>(), figure::<A>(), sides, corner);
        holds(200, given, |(before, after, (width, height), (x, y))| {
            let canvas = || Canvas::new(Point::new(x, y), Size::new(width, height));
            let theme = &Theme::MONOCHROME;
            let (mut redrawn, mut drawn) = (canvas(), canvas());
            before.draw(&mut redrawn, theme).unwrap();
            assert_eq!(redrawn.written, (width * height) as usize);
            redrawn.written = 0;
            let shown = redrawn.pixels.clone();
            after.redraw(&before, &mut redrawn, theme).unwrap();
            after.draw(&mut drawn, theme).unwrap();
            assert!(redrawn.pixels == drawn.pixels);
            let changed = shown.iter().zip(&drawn.pixels).filter(|(x, y)| x != y);
            assert_eq!(redrawn.written, changed.count());
        });
    }
    in_every_arithmetic!(check);
}

/// No overflow for any bounding box. A box beyond `i32` stays empty.
#[test]
fn targets_at_the_ends_of_the_grid_do_not_overflow() {
    let coordinate = || {
        const ENDS: &[i32] = &[i32::MIN, -1 << 30, -1 << 23, 0, 1 << 23, 1 << 30, i32::MAX];
        let near = (prop::sample::select(ENDS), -600..=600)
            .prop_map(|(end, offset)| end.saturating_add(offset));
        prop_oneof![2 => near, 1 => any::<i32>()]
    };
    let side = || {
        const ENDS: &[u32] = &[0, 1, 10, 1 << 30, i32::MAX as u32, 1 << 31, u32::MAX];
        prop_oneof![2 => prop::sample::select(ENDS), 2 => 0..600_u32, 1 => any::<u32>()]
    };
    let place = (coordinate(), coordinate(), side(), side());
    let given = (figure::<Portable>(), figure::<Portable>(), place);
    holds(2000, given, |(before, after, (x, y, width, height))| {
        let area = Rectangle::new(Point::new(x, y), Size::new(width, height));
        let mut target = Canvas::of_first(1000, area);
        before.draw(&mut target, &Theme::MONOCHROME).unwrap();
        let fits = |start: i32, side: u32| {
            let end = i64::from(start) + i64::from(side);
            i64::from(side) <= i32::MAX.into() && end <= i32::MAX.into()
        };
        let pixels = u64::from(width) * u64::from(height);
        let drawn = if fits(x, width) && fits(y, height) { pixels.min(1000) } else { 0 };
        assert_eq!(target.written as u64, drawn);
        // A redraw compares all pixels, which takes too long on a large target.
        if drawn == 1000 {
            target.most = 0;
        }
        after.redraw(&before, &mut target, &Theme::MONOCHROME).unwrap();
    });
}
