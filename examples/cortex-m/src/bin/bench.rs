//! Counts instructions, the same in every run. Then it compares the bits of `Reference` and
//! `Portable` with the crate's tests.

#![no_std]
#![no_main]

use core::hint::black_box;

use acrobot::arithmetic::{Arithmetic, Micro, Real, Reference};
use acrobot::control::{
    ControlError, difference, inverse_dynamics, linearize, linearize_step, lqr, velocities,
};
use acrobot::numpy::Pcg64;
use acrobot::physics::Pendulum;
use acrobot::render::{Figure, Theme};
use acrobot::{Acrobot, Action, Fast, Params, Portable, State, Step, TimeLimit};
use acrobot_cortex_m::counter::Counter;
use bits::episodes;
use cortex_m_rt::entry;
use embedded_graphics::framebuffer::{Framebuffer, buffer_size};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::pixelcolor::raw::{BigEndian, RawU1};
use semihosting::{println, process};

#[entry]
fn main() -> ! {
    let mut counter = Counter::take();
    measure::<Fast>("fast", &mut counter);
    measure::<Micro>("micro", &mut counter);
    measure::<Reference>("reference", &mut counter);
    measure::<Portable>("portable", &mut counter);
    // The bits must also be the same with libgcc's routines.
    let equal = episodes::sixteen::<Reference>() == episodes::REFERENCE
        && episodes::sixteen::<Portable>() == episodes::PORTABLE;
    println!("episodes in doubles are bit-identical: {equal}");
    process::exit(if equal { 0 } else { 1 })
}

type Display =
    Framebuffer<BinaryColor, RawU1, BigEndian, 128, 64, { buffer_size::<BinaryColor>(128, 64) }>;

fn measure<A: Arithmetic>(name: &str, counter: &mut Counter) {
    let mut acrobot = TimeLimit::of(Acrobot::<A>::new(42));
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
    if control::<A>(name, counter).is_err() {
        process::exit(1)
    }
}

/// A controller at 100 Hz, about the upright position.
fn control<A: Arithmetic>(name: &str, counter: &mut Counter) -> Result<(), ControlError> {
    let params = Params { dt: A::Scalar::from_f64(0.01), ..Params::default() };
    let pendulum = Pendulum::<A>::new(params, State::UPRIGHT)?;
    let [zero, one] = [0.0, 1.0].map(A::Scalar::from_f64);
    let weights =
        core::array::from_fn(|i| core::array::from_fn(|j| if i == j { one } else { zero }));
    let model = linearize_step(&pendulum, zero)?;
    let regulator = lqr(&model, &weights, one)?;
    let mut print = |figure, run: &mut dyn FnMut()| {
        println!("{name} {figure} {}", counter.count(100, run));
    };
    print("linearize", &mut || {
        let _ = black_box(linearize(black_box(&pendulum), zero));
    });
    print("linearize_step", &mut || {
        let _ = black_box(linearize_step(black_box(&pendulum), zero));
    });
    print("lqr", &mut || {
        let _ = black_box(lqr(black_box(&model), &weights, one));
    });
    print("torque", &mut || {
        let x = difference(black_box(pendulum.state()), State::UPRIGHT);
        black_box(regulator.torque(x));
    });
    print("inverse_dynamics", &mut || {
        let _ = black_box(inverse_dynamics(black_box(&pendulum), [one, one]));
    });
    print("velocities", &mut || {
        let _ = black_box(velocities(black_box(&pendulum)));
    });
    Ok(())
}

#[inline(never)]
fn step<A: Arithmetic>(acrobot: &mut TimeLimit<Acrobot<A>>, action: Action) -> Step {
    acrobot.step(action)
}
