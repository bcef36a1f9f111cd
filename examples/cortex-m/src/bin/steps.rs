//! Prints the instructions per environment step with each arithmetic, one a line: `arithmetic step value`. It builds for each
//! target of the table of cores in `docs/embedded.md`.

#![no_std]
#![no_main]

use core::hint::black_box;

use acrobot::arithmetic::{Arithmetic, Micro, Reference};
use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, Portable, Step, TimeLimit};
use acrobot_cortex_m::counter::Counter;
use acrobot_cortex_m::entry;
use acrobot_cortex_m::micromath::Micromath;
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
    process::exit(0)
}

fn measure<A: Arithmetic>(name: &str, counter: &mut Counter) {
    let mut acrobot = TimeLimit::v1(Acrobot::<A>::new(42));
    let mut action_space = Pcg64::new(42);
    let actions = [(); 64].map(|()| Action::sample(&mut action_space));
    let mut actions = actions.iter().copied().cycle();
    let count = counter.count(4000, || {
        let action = actions.next().unwrap_or(Action::Zero);
        if black_box(&step(&mut acrobot, action)).done() {
            black_box(acrobot.reset());
        }
    });
    println!("{name} step {count}");
}

#[inline(never)]
fn step<A: Arithmetic>(acrobot: &mut TimeLimit<Acrobot<A>>, action: Action) -> Step {
    acrobot.step(action)
}
