//! A closed loop at 100 Hz: SysTick's interrupt takes the latest action and steps the acrobot, which
//! stands for the machine; the main loop takes each observation from a queue and decides.
//!
//! It fails where a tick comes before the last one's work is done, there or here, and where the
//! result differs from the same loop without interrupts.

#![no_std]
#![no_main]

use core::cell::{Cell, RefCell};
use core::sync::atomic::{AtomicU32, Ordering};

use acrobot::{Acrobot, Action, Error, Fast, Params, Step};
use cortex_m::Peripherals;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};
use cortex_m_rt::{entry, exception};
use critical_section::Mutex;
use heapless::spsc::{Producer, Queue};
use semihosting::{println, process};

/// SysTick counts per second: those of the core's clock, 25 MHz on QEMU's mps2-an386.
const CLOCK: u32 = 25_000_000;
/// Ticks per second.
const RATE: u32 = 100;
/// Counts between two ticks: the work of one has to be done in so many.
const PERIOD: u32 = CLOCK / RATE;
const TICKS: u32 = 6_000;

/// From the main loop to the interrupt: the action, from the next tick on.
static ACTION: Mutex<Cell<Action>> = Mutex::new(Cell::new(Action::Zero));
/// From the main loop to the first interrupt, which keeps it.
static MACHINE: Mutex<RefCell<Option<Machine>>> = Mutex::new(RefCell::new(None));
/// From the interrupt to the main loop: the most counts that a tick took.
static SLOWEST: AtomicU32 = AtomicU32::new(0);

struct Machine {
    acrobot: Acrobot<Fast>,
    /// One observation waits at most; the next would be late.
    observations: Producer<'static, Step>,
}

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Step, 2> = Queue::new();
    let (observations, mut seen) = QUEUE.split();
    let (Some(peripherals), Ok(acrobot)) = (Peripherals::take(), at_rate()) else {
        process::exit(1)
    };
    let mut replay = acrobot.clone();
    let machine = Machine {
        acrobot,
        observations,
    };
    critical_section::with(|cs| MACHINE.borrow_ref_mut(cs).replace(machine));

    let mut syst = peripherals.SYST;
    syst.set_clock_source(SystClkSource::Core);
    syst.set_reload(PERIOD - 1);
    syst.clear_current();
    syst.enable_interrupt();
    syst.enable_counter();

    let (mut ticks, mut goals, mut last, mut next) = (0, 0, None, Action::Zero);
    let mut equal = true;
    while ticks < TICKS {
        let Some(step) = seen.dequeue() else {
            cortex_m::asm::wfi();
            continue;
        };
        let action = decide(&step);
        critical_section::with(|cs| ACTION.borrow(cs).set(action));

        ticks += 1;
        goals += u32::from(step.terminated && last == Some(false));
        last = Some(step.terminated);
        equal &= replay.step(next) == step;
        next = action;
    }
    syst.disable_interrupt();

    let slowest = SLOWEST.load(Ordering::Relaxed);
    println!("{ticks} ticks at {RATE} Hz, the tip {goals} times above the line");
    println!("the slowest tick took {slowest} of {PERIOD} counts");
    if !equal {
        println!("not as the same loop without interrupts");
    }
    process::exit(if equal && goals > 0 { 0 } else { 1 })
}

/// Steps as long as a tick.
fn at_rate() -> Result<Acrobot<Fast>, Error> {
    let mut acrobot = Acrobot::new(42);
    let dt = 1.0 / RATE as f32;
    acrobot.set_params(Params {
        dt,
        ..*acrobot.params()
    })?;
    Ok(acrobot)
}

/// Torque against the first link's velocity.
fn decide(step: &Step) -> Action {
    let [.., dtheta1, _] = *step.observation;
    if dtheta1 > 0.0 {
        Action::Negative
    } else {
        Action::Positive
    }
}

#[exception]
fn SysTick() {
    static mut OWN: Option<Machine> = None;
    let Some(machine) = OWN else {
        *OWN = critical_section::with(|cs| MACHINE.borrow_ref_mut(cs).take());
        return;
    };
    let action = critical_section::with(|cs| ACTION.borrow(cs).get());
    let step = machine.acrobot.step(action);
    let waiting = machine.observations.enqueue(step).is_err();
    if waiting || SCB::is_pendst_pending() {
        println!("late: a tick came before the work of the last was done");
        process::exit(1)
    }
    let took = PERIOD - 1 - SYST::get_current();
    SLOWEST.store(SLOWEST.load(Ordering::Relaxed).max(took), Ordering::Relaxed);
}
