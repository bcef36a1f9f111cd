//! Drawings equal Gymnasium's, and frames stay within their target. `cargo test -p properties`
//! redraws.

use acrobot::physics::Pendulum;
use acrobot::render::{Figure, Frame, Theme};
use acrobot::{Acrobot, Params, Portable, State};
use bits::oled;
use common::canvas::Canvas;
use common::numbers;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::pixelcolor::BinaryColor;

fn figure(theta1: f64, theta2: f64) -> Figure {
    figure_of([theta1, theta2, 1.0, 1.0])
}

fn figure_of([theta1, theta2, length1, length2]: [f64; 4]) -> Figure {
    let params = Params { length1, length2, ..Params::DEFAULT };
    let state = State::from([theta1, theta2, 0.0, 0.0]);
    let pendulum = Pendulum::<Portable>::new(params, state).unwrap();
    Figure::new(&Acrobot::<Portable, acrobot::task::Gymnasium, _>::from_pendulum(pendulum, ()))
}

const SIDE: usize = 500;

/// The angles and lengths of `data/frames.txt`, and each row's frame of `data/frames.png`.
fn recorded_frames() -> Vec<([f64; 4], Vec<u8>)> {
    let file = std::io::Cursor::new(include_bytes!("data/frames.png"));
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut grid = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut grid).unwrap();
    assert_eq!((info.width, info.height), (4000, 4000));
    let channels = grid.len() / (4000 * 4000);
    let states = include_str!("data/frames.txt").lines().filter(|line| !line.starts_with('#'));
    let frames = states.enumerate().map(|(number, line)| {
        let (row, column) = (number / 8 * SIDE, number % 8 * SIDE);
        let pixels = (0..SIDE * SIDE).flat_map(|i| {
            let start = ((row + i / SIDE) * 4000 + column + i % SIDE) * channels;
            grid[start..start + 3].to_vec()
        });
        (numbers(line).try_into().unwrap(), pixels.collect())
    });
    frames.collect()
}

/// The share of close pixels in the worst frame, as in docs/rust.md.
const LEAST_SHARE: f64 = 0.998;

#[test]
fn frames_equal_gymnasiums() {
    let frames = recorded_frames();
    assert_eq!(frames.len(), 64, "rows in tests/data/frames.txt: edit this count");
    let mut worst = 1.0_f64;
    for (row, theirs) in &frames {
        let ours = Frame::of(&figure_of(*row));
        let [ours_pixels, their_pixels] =
            [ours.bytes(), theirs].map(|bytes| bytes.as_chunks::<3>().0);
        let close = ours_pixels
            .iter()
            .zip(their_pixels)
            .filter(|(x, y)| x.iter().zip(*y).all(|(x, y)| x.abs_diff(*y) <= 32))
            .count();
        worst = worst.min(close as f64 / (SIDE * SIDE) as f64);
    }
    assert!(worst >= LEAST_SHARE, "{worst}");
}

/// Whether each pixel of a display is lit.
fn drawn(figure: Figure, top_left: Point, [width, height]: [u32; 2]) -> Vec<bool> {
    let mut canvas = Canvas::new(top_left, Size::new(width, height));
    figure.draw(&mut canvas, &Theme::MONOCHROME).unwrap();
    canvas.pixels.into_iter().map(|pixel| pixel == Some(BinaryColor::On)).collect()
}

#[test]
fn the_drawing_in_braille_equals_its_snapshot() {
    common::assert_snapshot("ansi.txt", &(figure(0.6, -1.5).braille() + "\n"));
}

/// Promise 2 for pictures: the firmware `bench` draws the same.
#[test]
fn the_oled_episode_equals_its_digest() {
    assert_eq!(oled::drawn(), oled::DRAWN);
}

#[test]
fn a_torque_is_drawn_if_it_is_not_0_and_there_is_room() {
    for (height, torque, is_drawn) in
        [(48, 1.0, true), (47, 1.0, false), (48, 0.0, false), (48, f32::NAN, false)]
    {
        let [still, pushed] = [figure(0.6, -1.5), figure(0.6, -1.5).with_torque(torque)]
            .map(|figure| drawn(figure, Point::zero(), [200, height]));
        assert_eq!(still != pushed, is_drawn);
    }
}

/// A link too short to see has no direction: only the other link and the joints are drawn.
#[test]
fn a_link_of_almost_no_length_is_not_drawn() {
    // Around the origin floats are dense enough to distinguish the two ends of such a link.
    let columns = |figure: Figure| {
        let pixels = drawn(figure, Point::new(-64, -32), [128, 64]);
        let rows = pixels.chunks(128).skip(32);
        let lit = rows.flat_map(|row| (0..128).filter(|&x| row[x]));
        lit.fold((128, 0), |(first, last), x| (first.min(x), last.max(x)))
    };
    let hanging = columns(figure_of([0.0, 0.0, 1e-300, 1.0]));
    assert_eq!(hanging, (61, 66));
    for length in [1e-40, 1e-30, 1e-20, 1e-17] {
        assert_eq!(columns(figure_of([0.6, -0.6, length, 1.0])), hanging);
    }
}

#[test]
fn a_frame_ignores_pixels_outside_it() {
    let mut frame = Frame::new(3, 2).unwrap();
    let white = Theme::GYMNASIUM.background;
    let around = [(-1, 0), (3, 0), (0, -1), (0, 2)].map(|(x, y)| Pixel(Point::new(x, y), white));
    frame.draw_iter(around).unwrap();
    assert!(frame.bytes().iter().all(|&byte| byte == 0));
    frame.draw_iter([Pixel(Point::new(2, 1), white)]).unwrap();
    assert_eq!(frame.bytes()[15..], [255; 3]);
    assert_eq!((frame.width(), frame.height()), (3, 2));
}

#[test]
fn frames_can_be_empty_and_must_fit_into_memory() {
    for (width, height) in [(0, 10), (u32::MAX, 0)] {
        let mut frame = Frame::new(width, height).unwrap();
        assert_eq!(frame.size(), Size::new(width, height));
        assert!(frame.bytes().is_empty());
        frame.draw_iter([Pixel(Point::zero(), Theme::GYMNASIUM.target)]).unwrap();
        figure(0.6, -1.5).draw(&mut frame, &Theme::GYMNASIUM).unwrap();
    }
    // Slightly more than 2⁶⁴ bytes, and then less than 2⁶³, which no machine has.
    for height in [1_431_655_766, 500_000_000] {
        assert_eq!(Frame::new(u32::MAX, height), None);
    }
}
