//! Counts instructions, the same in every run, and compares drawings with the crate's tests.

#![no_std]
#![no_main]

use core::hint::black_box;

use acrobot::arithmetic::{Arithmetic, Damped, Real, Reference};
use acrobot::control::estimate::{Estimator, Noise, ParameterEstimator, ParameterStd};
use acrobot::control::regulator::dlqr;
use acrobot::physics::Pendulum;
use acrobot::render::{Figure, Theme};
use acrobot::{Acrobot, Action, Error, Fast, Params, State};
use acrobot_cortex_m::counter::Counter;
use bits::oled::{self, Display};
use cortex_m_rt::entry;
use semihosting::{println, process};

#[entry]
fn main() -> ! {
    let mut counter = Counter::take();
    draw(&mut counter);
    let controlled = control::<Fast>("fast", &mut counter).is_ok()
        && control::<Reference>("reference", &mut counter).is_ok()
        && estimators::<Fast>("fast", &mut counter).is_ok()
        && estimators::<Reference>("reference", &mut counter).is_ok();
    let equal = oled::drawn() == oled::DRAWN;
    println!("drawings are bit-identical: {equal}");
    process::exit(if controlled && equal { 0 } else { 1 })
}

fn draw(counter: &mut Counter) {
    let mut acrobot = Acrobot::<Fast>::new(42);
    let mut display = Display::new();
    let count = counter.count(200, || {
        step(&mut acrobot);
        let Ok(()) = Figure::new(&acrobot).draw(&mut display, &Theme::MONOCHROME);
    });
    println!("fast draw {count}");
    let mut shown = Figure::new(&acrobot);
    let count = counter.count(200, || {
        step(&mut acrobot);
        let figure = Figure::new(&acrobot);
        let Ok(()) = figure.redraw(&shown, &mut display, &Theme::MONOCHROME);
        shown = figure;
    });
    println!("fast redraw {count}");
}

fn step(acrobot: &mut Acrobot<Fast>) {
    let action = Action::sample(acrobot.rng_mut());
    acrobot.step(action);
}

/// A controller at 100 Hz, about the upright position.
fn control<A: Arithmetic>(name: &str, counter: &mut Counter) -> Result<(), Error> {
    let params = Params { dt: A::Scalar::from_f64(0.01), ..Params::default() };
    let pendulum = Pendulum::<A>::new(params, State::UPRIGHT)?;
    let [zero, one] = [0.0, 1.0].map(A::Scalar::from_f64);
    let weights =
        core::array::from_fn(|i| core::array::from_fn(|j| if i == j { one } else { zero }));
    let model = pendulum.linearize_step(zero)?;
    let regulator = dlqr(&model, &weights, one)?;
    let mut print = |figure, run: &mut dyn FnMut()| {
        println!("{name} {figure} {}", counter.count(100, run));
    };
    print("linearize", &mut || {
        let _ = black_box(black_box(&pendulum).linearize(zero));
    });
    print("linearize_step", &mut || {
        let _ = black_box(black_box(&pendulum).linearize_step(zero));
    });
    print("dlqr", &mut || {
        let _ = black_box(dlqr(black_box(&model), &weights, one));
    });
    print("torque", &mut || {
        let x = black_box(pendulum.state()).deviation_from(State::UPRIGHT);
        black_box(regulator.torque(x));
    });
    print("inverse_dynamics", &mut || {
        let _ = black_box(black_box(&pendulum).inverse_dynamics([one, one]));
    });
    Ok(())
}

/// A measurement and a step of the same machine.
fn estimators<A: Arithmetic>(name: &str, counter: &mut Counter) -> Result<(), Error> {
    let params = Params { dt: A::Scalar::from_f64(0.01), ..Params::default() };
    let noise =
        Noise { angle_std: A::Scalar::from_f64(1e-3), torque_std: A::Scalar::from_f64(0.05) };
    let mut of_state = Estimator::<Damped<A>>::new(params, noise)?;
    let std = ParameterStd { mass1: params.mass1, ..ParameterStd::default() };
    let mut of_params = ParameterEstimator::<Damped<A>>::new(params, std, noise)?;
    let (angles, torque) = ([A::Scalar::PI, A::Scalar::ZERO], A::Scalar::ZERO);
    of_state.correct(angles)?;
    of_params.correct(angles)?;
    let count = counter.count(100, || {
        let _ = black_box((of_state.correct(black_box(angles)), of_state.predict(torque)));
    });
    println!("{name} estimator {count}");
    let count = counter.count(100, || {
        let _ = black_box((of_params.correct(black_box(angles)), of_params.predict(torque)));
    });
    println!("{name} estimator_params {count}");
    Ok(())
}
