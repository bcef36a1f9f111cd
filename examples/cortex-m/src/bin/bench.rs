//! Counts instructions, and bytes of stack and RAM. Prints one figure a line, `arithmetic figure value`, the same in every run.
//! Then it compares the bits of `Reference` and `Portable` with the crate's tests.

#![no_std]
#![no_main]

use core::hint::black_box;

use acrobot::arithmetic::{Arithmetic, Micro, Real, Reference};
use acrobot::numpy::Pcg64;
use acrobot::render::{Figure, Theme};
use acrobot::{Acrobot, Action, Fast, Params, Portable, Step, TimeLimit};
use acrobot_cortex_m::counter::Counter;
use acrobot_cortex_m::micromath::Micromath;
use bits::episodes;
use cortex_m::register::msp;
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

    // With noise this large the steps take every branch: noise, bounds and goal.
    let params = *acrobot.inner().params();
    let noise = A::Scalar::from_f64(20.0);
    let changed = acrobot.inner_mut().set_params(Params {
        torque_noise: noise,
        ..params
    });
    let mut deepest = 0;
    for _ in 0..1000 {
        let action = action();
        deepest = deepest.max(stack(|| {
            black_box(step(&mut acrobot, action));
        }));
    }
    println!("{name} stack {deepest}");
    println!("{name} size {}", size_of::<Acrobot<A>>());
    if changed.is_err() {
        process::exit(1);
    }
}

#[inline(never)]
fn step<A: Arithmetic>(acrobot: &mut TimeLimit<Acrobot<A>>, action: Action) -> Step {
    acrobot.step(action)
}

/// The bytes of stack that `run` takes. Paints the stack below, calls `run`, and finds the deepest word that changed.
#[inline(never)]
fn stack(run: impl FnOnce()) -> usize {
    const PAINT: u32 = 0xa5c3_9617;
    const WORDS: usize = 512;
    // The paint begins below this function's own frame.
    let end = msp::read() as usize as *mut u32;
    for i in 1..=WORDS {
        // SAFETY: the 2 KiB below the stack pointer are unused stack, because no interrupt is enabled.
        unsafe { end.sub(i).write_volatile(PAINT) };
    }
    run();
    (1..=WORDS)
        .rev()
        // SAFETY: as above.
        .find(|&i| unsafe { end.sub(i).read_volatile() } != PAINT)
        .map_or(0, |deepest| deepest * size_of::<u32>())
}
