//! A closed loop at 100 Hz. SysTick's interrupt steps the acrobot, which stands for the machine, with the latest action;
//! the main loop decides on the next one.
//!
//! It fails if a tick comes before the work of the last one is done, and if the result differs from the same loop without
//! interrupts.

#![no_std]
#![no_main]

use core::cell::{Cell, RefCell};
use core::sync::atomic::{AtomicU32, Ordering};

use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Error, Fast, Params, Step};
use cortex_m::Peripherals;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};
use cortex_m_rt::{entry, exception};
use critical_section::Mutex;
use semihosting::{println, process};

/// SysTick counts per second: the core's clock, 25 MHz on QEMU's mps2-an386.
const CLOCK: u32 = 25_000_000;
/// Ticks per second.
const RATE: u32 = 100;
/// Counts from one tick to the next.
const PERIOD: u32 = CLOCK / RATE;
const TICKS: u32 = 6_000;

/// The machine. The compiler makes it, seed included.
static ACROBOT: Mutex<RefCell<Acrobot<Fast>>> =
    Mutex::new(RefCell::new(Acrobot::hanging(Pcg64::new(42))));
/// The main loop's last decision, which each tick applies.
static ACTION: Mutex<Cell<Action>> = Mutex::new(Cell::new(Action::Zero));
/// The last tick's result, until the main loop takes it.
static STEP: Mutex<Cell<Option<Step>>> = Mutex::new(Cell::new(None));
/// The most counts that a tick took.
static SLOWEST: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    let waiting = critical_section::with(|cs| {
        let step = ACROBOT.borrow_ref_mut(cs).step(ACTION.borrow(cs).get());
        STEP.borrow(cs).replace(Some(step)).is_some()
    });
    if waiting || SCB::is_pendst_pending() {
        println!("late: a tick came before the work of the last one was done");
        process::exit(1)
    }
    let took = PERIOD - 1 - SYST::get_current();
    SLOWEST.store(SLOWEST.load(Ordering::Relaxed).max(took), Ordering::Relaxed);
}

#[entry]
fn main() -> ! {
    let (Some(peripherals), Ok(mut replay)) = (Peripherals::take(), set_rate()) else {
        process::exit(1)
    };
    let mut syst = peripherals.SYST;
    syst.set_clock_source(SystClkSource::Core);
    syst.set_reload(PERIOD - 1);
    syst.clear_current();
    syst.enable_interrupt();
    syst.enable_counter();

    let (mut action, mut equal, mut above, mut goals) = (Action::Zero, true, false, 0);
    for _ in 0..TICKS {
        let step = next_step();
        equal &= replay.step(action) == step;
        action = decide(&step);
        critical_section::with(|cs| ACTION.borrow(cs).set(action));

        goals += u32::from(step.terminated && !above);
        above = step.terminated;
    }
    syst.disable_interrupt();

    let slowest = SLOWEST.load(Ordering::Relaxed);
    println!("{TICKS} ticks at {RATE} Hz; the tip rose above the target height {goals} times");
    println!("the slowest tick took {slowest} of {PERIOD} counts");
    if !equal {
        println!("differs from the same loop without interrupts");
    }
    process::exit(if equal && goals > 0 { 0 } else { 1 })
}

/// Makes a step of the acrobot as long as a tick, and returns a copy of the acrobot.
fn set_rate() -> Result<Acrobot<Fast>, Error> {
    critical_section::with(|cs| {
        let mut acrobot = ACROBOT.borrow_ref_mut(cs);
        acrobot.set_params(Params {
            dt: 1.0 / RATE as f32,
            ..Params::DEFAULT
        })?;
        Ok(acrobot.clone())
    })
}

/// Sleeps until a tick has stepped the acrobot.
fn next_step() -> Step {
    loop {
        let step = critical_section::with(|cs| {
            let step = STEP.borrow(cs).take();
            if step.is_none() {
                // In the critical section, so that no tick comes between looking and sleeping. It still wakes the core.
                cortex_m::asm::wfi();
            }
            step
        });
        if let Some(step) = step {
            return step;
        }
    }
}

/// Torque against the first link's velocity.
fn decide(step: &Step) -> Action {
    if step.observation.dtheta1() > 0.0 {
        Action::Negative
    } else {
        Action::Positive
    }
}
