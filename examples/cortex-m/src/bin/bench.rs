//! Counts instructions. Prints one figure a line, `arithmetic figure value`, the same in every run.
//! Then it compares the bits of `Reference` and `Portable` with the crate's tests.

#![no_std]
#![no_main]

use core::hint::black_box;

use acrobot::arithmetic::{Arithmetic, Micro, Real, Reference};
use acrobot::numpy::Pcg64;
use acrobot::render::{Figure, Theme};
use acrobot::{Acrobot, Action, Fast, Portable, Step, TimeLimit};
use acrobot_cortex_m::counter::Counter;
use acrobot_cortex_m::micromath::Micromath;
use bits::episodes;
use cortex_m_rt::entry;
use embedded_graphics::framebuffer::{Framebuffer, buffer_size};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::pixelcolor::raw::{BigEndian, RawU1};
use semihosting::{println, process};

#[entry]
fn main() -> ! {
    let Some(mut counter) = Counter::take() else {
        process::exit(1)
    };
    measure::<Fast>("fast", &mut counter);
    measure::<Micro>("micro", &mut counter);
    measure::<Micromath>("micromath", &mut counter);
    measure::<Reference>("reference", &mut counter);
    measure::<Portable>("portable", &mut counter);
    // The bits must also be the same with libgcc's routines.
    let equal = episodes::equal::<Reference>(&episodes::REFERENCE)
        + episodes::equal::<Portable>(&episodes::PORTABLE);
    println!("{equal} of 32 episodes in doubles are bit-identical");
    process::exit(if equal == 32 { 0 } else { 1 })
}

type Display =
    Framebuffer<BinaryColor, RawU1, BigEndian, 128, 64, { buffer_size::<BinaryColor>(128, 64) }>;

fn measure<A: Arithmetic>(name: &str, counter: &mut Counter) {
    let mut acrobot = TimeLimit::v1(Acrobot::<A>::new(42));
    let mut action_space = Pcg64::new(42);
    let actions = [(); 64].map(|()| Action::sample(&mut action_space));
    let mut actions = actions.iter().copied().cycle();
    let mut action = || actions.next().unwrap_or(Action::Zero);

    // From −8 to 8 rad: more than a turn in either direction.
    let angles: [A::Scalar; 64] =
        core::array::from_fn(|i| A::Scalar::from_f64(i as f64 * 0.25 - 8.0));
    let mut angles = angles.iter().copied().cycle();
    let count = counter.count(6400, || {
        black_box(A::sin_cos(angles.next().unwrap_or_default()));
    });
    println!("{name} sin_cos {count}");

    let count = counter.count(1000, || {
        black_box(acrobot.reset());
    });
    println!("{name} reset {count}");

    let mut display = Display::new();
    let count = counter.count(200, || {
        step(&mut acrobot, action());
        let _ = Figure::new(acrobot.inner()).draw(&mut display, &Theme::MONOCHROME);
    });
    println!("{name} draw {count}");

    let mut shown = Figure::new(acrobot.inner());
    let count = counter.count(200, || {
        step(&mut acrobot, action());
        let figure = Figure::new(acrobot.inner());
        let _ = figure.redraw(&shown, &mut display, &Theme::MONOCHROME);
        shown = figure;
    });
    println!("{name} redraw {count}");
}

#[inline(never)]
fn step<A: Arithmetic>(acrobot: &mut TimeLimit<Acrobot<A>>, action: Action) -> Step {
    acrobot.step(action)
}
