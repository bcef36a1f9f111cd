//! The first firmware of docs/embedded.md: SysTick steps an acrobot in a `static` until the episode
//! ends.

#![no_std]
#![no_main]

use core::cell::RefCell;

use acrobot::numpy::Pcg64;
use acrobot::task::{Gymnasium, Task as _};
use acrobot::{Acrobot, Action, Fast, TimeLimit};
use cortex_m::Peripherals;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::{entry, exception};
use critical_section::Mutex;
use semihosting::{println, process};

static ACROBOT: Mutex<RefCell<TimeLimit<Acrobot<Fast>>>> = Mutex::new(RefCell::new(
    TimeLimit::new(Acrobot::hanging(Pcg64::new(42)), Gymnasium::MAX_STEPS),
));

/// 0.2 s of the 25 MHz clock of QEMU's mps2-an386. SysTick counts to 2²⁴ at most.
const PERIOD: u32 = 5_000_000;

#[entry]
fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else { process::exit(1) };
    // From hanging at rest to the initial state of seed 42.
    critical_section::with(|cs| ACROBOT.borrow_ref_mut(cs).reset());
    let mut syst = peripherals.SYST;
    syst.set_clock_source(SystClkSource::Core);
    syst.set_reload(PERIOD - 1);
    syst.clear_current();
    syst.enable_interrupt();
    syst.enable_counter();
    loop {
        cortex_m::asm::wfi();
    }
}

#[exception]
fn SysTick() {
    critical_section::with(|cs| {
        let acrobot = &mut *ACROBOT.borrow_ref_mut(cs);
        // Torque against the velocity of link 1.
        let action = match acrobot.state().dtheta1 > 0.0 {
            true => Action::Negative,
            false => Action::Positive,
        };
        if acrobot.step(action).is_done() {
            println!("the episode ended after {} steps", acrobot.elapsed_steps());
            process::exit(0)
        }
    });
}
