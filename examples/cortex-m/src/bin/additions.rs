//! What a firmware adds to an acrobot: `ADDITION` chooses it when it is built, for example
//! `ADDITION=lqr cargo build --release --bin additions`. Its flash minus that of `ADDITION=none` is the flash of the addition.
//! Without `ADDITION` it prints the stack of `lqr`.

#![no_std]
#![no_main]

use core::cell::RefCell;
use core::fmt::{self, Write as _};
use core::hint::black_box;

use acrobot::physics::Pendulum;
use acrobot::physics::control::{discretize, lqr};
use acrobot::{Acrobot, Action, Error, Fast, Params};
use acrobot_cortex_m::stack;
use cortex_m_rt::entry;
use semihosting::{println, process};

#[entry]
fn main() -> ! {
    match option_env!("ADDITION") {
        Some("none") => with(|_| {}),
        Some("message") => with(|acrobot| {
            if let Err(error) = set_params(acrobot) {
                black_box(error.message());
            }
        }),
        Some("display") => with(|acrobot| {
            if let Err(error) = set_params(acrobot) {
                let _ = write!(Output, "{error}");
            }
        }),
        // It can panic, and then semihosting's panic handler prints.
        Some("cell") => with(|acrobot| {
            let cell = RefCell::new(acrobot.state());
            black_box(&cell).borrow_mut().theta1 = 0.0;
        }),
        Some("lqr") => with(regulate),
        #[cfg(feature = "serde")]
        Some("serde") => with(resume),
        _ => print_stack(),
    }
}

/// An acrobot, and something more after each step.
fn with(more: impl Fn(&mut Acrobot<Fast>)) -> ! {
    let mut acrobot = Acrobot::<Fast>::new(black_box(42));
    loop {
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
    if let Ok(model) = discretize(acrobot.pendulum(), 0.0)
        && let Ok(regulator) = lqr(&model, &black_box([[1.0; 4]; 4]), 1.0)
    {
        let x = acrobot.pendulum().deviation(acrobot.state());
        black_box(regulator.torque(x));
    }
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

fn print_stack() -> ! {
    let model = discretize(&Pendulum::<Fast>::hanging(), 0.0);
    let bytes = stack::depth(|| {
        let _ = black_box(model.map(|model| lqr(&model, &black_box([[1.0; 4]; 4]), 1.0)));
    });
    println!("fast lqr_stack {}", bytes.unwrap_or_default());
    process::exit(if bytes.is_some() { 0 } else { 1 })
}

/// Stands for a display or a serial port.
struct Output;

impl fmt::Write for Output {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        black_box(text);
        Ok(())
    }
}
