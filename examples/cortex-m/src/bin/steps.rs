//! Prints the instructions and the stack of a step and the size of an acrobot, with each
//! arithmetic. It builds for each core of `figures.py`.

#![no_std]
#![no_main]

use core::hint::black_box;

use acrobot::arithmetic::{Arithmetic, Micro, Real, Reference};
use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, Params, Portable, Step, TimeLimit};
use acrobot_cortex_m::counter::Counter;
use acrobot_cortex_m::entry;
use acrobot_cortex_m::stack;
use semihosting::{println, process};

// The same on each core.
const _: () = {
    let (single, double) = (size_of::<Acrobot<Fast>>(), size_of::<Acrobot<Reference>>());
    assert!(single == size_of::<Acrobot<Micro>>() && double == size_of::<Acrobot<Portable>>());
    assert!(single == 216 && double == 392, "docs/embedded-figures.md says 216 and 392 bytes");
};

#[entry]
fn main() -> ! {
    let mut counter = Counter::take();
    measure::<Fast>("fast", &mut counter);
    measure::<Micro>("micro", &mut counter);
    measure::<Reference>("reference", &mut counter);
    measure::<Portable>("portable", &mut counter);
    process::exit(0)
}

fn measure<A: Arithmetic>(name: &str, counter: &mut Counter) {
    let mut acrobot = TimeLimit::with_task_limit(Acrobot::<A>::new(42));
    let mut action_space = Pcg64::new(42);
    let actions = [(); 64].map(|()| Action::sample(&mut action_space));
    let mut actions = actions.iter().copied().cycle();
    let count = counter.count(4000, || {
        let action = actions.next().unwrap_or(Action::Zero);
        if black_box(&step(&mut acrobot, action)).is_done() {
            black_box(acrobot.reset());
        }
    });
    println!("{name} step {count}");
    println!("{name} size {}", size_of::<Acrobot<A>>());
    let Some(bytes) = stack_of_a_step::<A>() else { process::exit(1) };
    println!("{name} stack {bytes}");
}

#[inline(never)] // otherwise the loop above takes more instructions
fn stack_of_a_step<A: Arithmetic>() -> Option<usize> {
    // With noise this large the steps take every branch: noise, bounds and goal.
    let mut acrobot = TimeLimit::with_task_limit(Acrobot::<A>::new(42));
    let params = Params { torque_noise: A::Scalar::from_f64(20.0), ..*acrobot.params() };
    acrobot.inner_mut().set_params(params).ok()?;
    let mut action_space = Pcg64::new(42);
    let mut deepest = 0;
    for _ in 0..1000 {
        let action = Action::sample(&mut action_space);
        let depth = stack::depth(|| {
            black_box(step(&mut acrobot, action));
        });
        deepest = deepest.max(depth?);
    }
    Some(deepest)
}

#[inline(never)]
fn step<A: Arithmetic>(acrobot: &mut TimeLimit<Acrobot<A>>, action: Action) -> Step {
    acrobot.step(action)
}
