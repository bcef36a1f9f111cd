//! Pictures of any acrobot on a target of any position and size.

use acrobot::arithmetic::Arithmetic;
use acrobot::render::{Figure, Theme};
use embedded_graphics::geometry::{Point, Size};
use proptest::prelude::*;

use crate::common::canvas::Canvas;
use crate::given::{Number, Range, acrobot, holds, params, state};

fn figure<A: Arithmetic<Scalar: Number>>() -> impl Strategy<Value = Figure> {
    let given = (params(Range::Any), state(Range::Any), prop::num::f32::ANY);
    given.prop_map(|(params, state, torque)| {
        Figure::new(&acrobot::<A>(params, state, 0)).with_torque(torque)
    })
}

/// The canvas rejects pixels outside it.
#[test]
fn every_pixel_is_drawn_once_and_a_redraw_makes_it_another_figures() {
    fn check<A: Arithmetic<Scalar: Number>>() {
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
            after.redraw(&before, &mut redrawn, theme).unwrap();
            after.draw(&mut drawn, theme).unwrap();
            assert!(redrawn.pixels == drawn.pixels);
        });
    }
    in_every_arithmetic!(check);
}
