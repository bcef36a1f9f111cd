//! The smallest firmware with the crate: it seeds an acrobot, and steps and resets it forever. `MINIMAL` chooses the arithmetic when it is
//! built: `MINIMAL=reference cargo build --release --bin minimal`. Its flash minus that of the firmware without an acrobot, which
//! is built without `MINIMAL`, is the flash of the crate.

#![no_std]
#![no_main]

use core::hint::black_box;

use acrobot::arithmetic::{Arithmetic, Micro, Reference};
use acrobot::physics::Pendulum;
use acrobot::{Acrobot, Action, Fast, Portable};
use acrobot_cortex_m::nop;
use panic_halt as _;

#[acrobot_cortex_m::entry]
fn main() -> ! {
    match option_env!("MINIMAL") {
        Some("fast") => acrobot::<Fast>(),
        Some("micro") => acrobot::<Micro>(),
        Some("reference") => acrobot::<Reference>(),
        Some("portable") => acrobot::<Portable>(),
        Some("physics") => pendulum(),
        _ => without(),
    }
}

fn acrobot<A: Arithmetic>() -> ! {
    let mut acrobot = Acrobot::<A>::new(black_box(42));
    loop {
        // `cycles.py` counts a step here.
        nop();
        // The compiler must not know the action, and must compute the whole result.
        if black_box(acrobot.step(black_box(Action::Zero))).terminated {
            black_box(acrobot.reset());
        }
    }
}

/// A pendulum alone, without random numbers. In a `static` it needs no code that makes or copies it.
fn pendulum() -> ! {
    static mut PENDULUM: Pendulum<Fast> = Pendulum::hanging();
    let pendulum = &raw mut PENDULUM;
    // SAFETY: `main` calls this once, so there is no other reference.
    let pendulum = unsafe { &mut *pendulum };
    loop {
        if pendulum.step(black_box(0.0)).is_ok() {
            black_box(pendulum.state());
        }
    }
}

fn without() -> ! {
    loop {
        nop();
        black_box(black_box(Action::Zero));
    }
}
