//! An Embassy task owns the acrobot and steps it at a fixed rate; another task decides on each
//! action. It fails if the ticks come at another rate on average, and if the episode does not end
//! as in a plain loop.

#![no_std]
#![no_main]

use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, TimeLimit};
use acrobot_cortex_m::episode::{decide, finish};
use cortex_m::Peripherals;
use cortex_m_rt::exception;
use embassy_executor::Spawner;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use embassy_time::{Duration, Instant, Ticker};
use semihosting::{println, process};
use systick_timer::SystickDriver;

/// With 0.2 s, the time of a step, QEMU would run for minutes: its WFE does not sleep.
const PERIOD: Duration = Duration::from_millis(2);

// Embassy's clock, for one ticker, from the core's 25 MHz on QEMU's mps2-an386. On a board the HAL
// has one.
embassy_time_driver::time_driver_impl!(
    static CLOCK: SystickDriver<1> = SystickDriver::new_default(25_000_000)
);

static OBSERVATION: Signal<CriticalSectionRawMutex, [f32; 6]> = Signal::new();
static ACTION: Signal<CriticalSectionRawMutex, Action> = Signal::new();

#[exception]
fn SysTick() {
    CLOCK.systick_interrupt();
}

/// Steps the acrobot, which stands for the machine.
#[embassy_executor::task]
async fn machine(mut acrobot: TimeLimit<Acrobot<Fast>>) {
    let mut action = Action::Positive;
    let mut ticker = Ticker::every(PERIOD);
    loop {
        ticker.next().await;
        let step = acrobot.step(action);
        if step.done() {
            // Since the clock started.
            if Instant::MIN.elapsed() / acrobot.elapsed_steps() != PERIOD {
                println!("the ticks came at another rate");
                process::exit(1)
            }
            finish(&acrobot, step)
        }
        OBSERVATION.signal(step.observation);
        action = ACTION.wait().await;
    }
}

#[embassy_executor::task]
async fn controller() {
    loop {
        let observation = OBSERVATION.wait().await;
        ACTION.signal(decide(observation));
    }
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let (Some(mut core), Ok(machine), Ok(controller)) = (
        Peripherals::take(),
        machine(TimeLimit::of(Acrobot::hanging(Pcg64::new(42)))),
        controller(),
    ) else {
        process::exit(1)
    };
    CLOCK.start(&mut core.SYST);
    spawner.spawn(machine);
    spawner.spawn(controller);
}
