//! Firmware whose flash `figures.py` measures: an acrobot that is seeded, then stepped and reset
//! forever. `MINIMAL` chooses its arithmetic, or what else is in it, when it is built. Without it
//! there is no acrobot.

#![no_std]
#![no_main]

use core::fmt::{self, Write as _};
use core::hint::black_box;

use acrobot::arithmetic::{Arithmetic, Micro, Reference};
use acrobot::control::regulator::dlqr;
use acrobot::physics::Pendulum;
use acrobot::{Acrobot, Action, Error, Fast, Params, Portable};
use acrobot_cortex_m::{nop, stack};
use semihosting::{println, process};

#[acrobot_cortex_m::entry]
fn main() -> ! {
    match option_env!("MINIMAL") {
        Some("fast") => acrobot::<Fast>(|_| {}),
        Some("micro") => acrobot::<Micro>(|_| {}),
        Some("reference") => acrobot::<Reference>(|_| {}),
        Some("portable") => acrobot::<Portable>(|_| {}),
        Some("physics") => pendulum(),
        Some("message") => acrobot(|acrobot| {
            if let Err(error) = set_params(acrobot) {
                black_box(error.message());
            }
        }),
        Some("display") => acrobot(|acrobot| {
            if let Err(error) = set_params(acrobot) {
                let _ = write!(Output, "{error}");
            }
        }),
        Some("lqr") => acrobot(regulate),
        Some("lqr_stack") => print_stack(),
        #[cfg(feature = "serde")]
        Some("serde") => acrobot(resume),
        _ => loop {
            nop();
            black_box(black_box(Action::Zero));
        },
    }
}

/// An acrobot, and something more after each step.
fn acrobot<A: Arithmetic>(more: impl Fn(&mut Acrobot<A>)) -> ! {
    let mut acrobot = Acrobot::<A>::new(black_box(42));
    loop {
        // `cycles.py` counts a step here.
        nop();
        // The compiler must not know the action, and must compute the whole result.
        if black_box(acrobot.step(black_box(Action::Zero))).terminated {
            black_box(acrobot.reset());
        }
        more(&mut acrobot);
    }
}

fn set_params(acrobot: &mut Acrobot<Fast>) -> Result<(), Error> {
    acrobot.set_params(black_box(Params::DEFAULT))
}

/// Computes a gain, and the torque.
fn regulate(acrobot: &mut Acrobot<Fast>) {
    if let Ok(model) = acrobot.pendulum().linearize_step(0.0)
        && let Ok(regulator) = dlqr(&model, &black_box([[1.0; 4]; 4]), 1.0)
    {
        let x = acrobot.pendulum().state().deviation_from(acrobot.state());
        black_box(regulator.torque(x));
    }
}

fn print_stack() -> ! {
    let model = Pendulum::<Fast>::hanging().linearize_step(0.0);
    let bytes = stack::depth(|| {
        let _ = black_box(model.map(|model| dlqr(&model, &black_box([[1.0; 4]; 4]), 1.0)));
    });
    println!("fast lqr_stack {}", bytes.unwrap_or_default());
    process::exit(if bytes.is_some() { 0 } else { 1 })
}

/// Saves the acrobot with a checksum, and loads it.
#[cfg(feature = "serde")]
fn resume(acrobot: &mut Acrobot<Fast>) {
    static CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISCSI);
    let mut page = [0; Acrobot::<Fast>::MAX_SNAPSHOT_SIZE + 4];
    let _ = black_box(postcard::to_slice_crc32(acrobot, &mut page, CRC.digest()));
    if let Ok(loaded) = postcard::from_bytes_crc32(black_box(&page), CRC.digest()) {
        *acrobot = loaded;
    }
}

/// Stands for a display or a serial port.
struct Output;

impl fmt::Write for Output {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        black_box(text);
        Ok(())
    }
}

/// A pendulum alone. In a `static` it needs no code that makes or copies it.
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
