//! Swings a simulated real acrobot up and holds it, in real time: SysTick's interrupt ticks every
//! 2 ms, and the main loop plans in between. The model has no friction, and a push throws the
//! acrobot down again. It fails if it does not stay upright, or if a tick misses its deadline.

#![no_std]
#![no_main]

use core::cell::RefCell;
use core::f32::consts::TAU;

use acrobot::arithmetic::Damped;
use acrobot::control::mpc::{Controller, Replanner, Settings};
use acrobot::physics::Pendulum;
use acrobot::{Error, Fast, Params, State};
use acrobot_cortex_m::ram;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{Peripherals, SCB, SYST};
use cortex_m_rt::{entry, exception};
use critical_section::Mutex;
use machine::Hardware;
use semihosting::{println, process};

/// Counts of SysTick from tick to tick, and instructions of a count under QEMU's `-icount shift=0`:
/// those of an STM32F4 at 168 MHz in 2 ms, with 1.9 cycles an instruction.
const PERIOD: u32 = 4_420;
const PER_COUNT: u32 = 40;
/// Ticks before the push, and after it.
const TICKS: u32 = 2500;
/// How much it changes both velocities, rad/s.
const PUSH: [f32; 2] = [1.0, -5.0];

struct Real {
    machine: Pendulum<Damped<Fast>>,
    controller: Controller<100>,
    ticks: u32,
    /// The tick after which the acrobot is upright: before the push, and after it.
    upright: [u32; 2],
    /// The most counts of a controller's tick.
    slowest: u32,
}

static REAL: Mutex<RefCell<Option<Real>>> = Mutex::new(RefCell::new(None));

fn start() -> Result<Replanner<100>, Error> {
    let Hardware { params, counts, .. } = Hardware::realaigym();
    let start = State { theta1: 0.05, ..State::HANGING };
    let machine = Pendulum::new(params.cast(), start)?;
    let (damping1, damping2, coulomb1, coulomb2) = (0.0, 0.0, 0.0, 0.0);
    let params = Params { damping1, damping2, coulomb1, coulomb2, ..params }.cast();
    let settings = Settings { params, limit: 6.0, counts, delay: 0.0, plan_timeout: 1.0 };
    let controller = Controller::new(settings)?;
    let real = Real { machine, controller, ticks: 0, upright: [0; 2], slowest: 0 };
    critical_section::with(|cs| REAL.replace(cs, Some(real)));
    Replanner::new(settings)
}

#[entry]
fn main() -> ! {
    let (Some(peripherals), Ok(mut replanner)) = (Peripherals::take(), start()) else {
        process::exit(1)
    };
    let mut syst = peripherals.SYST;
    syst.set_clock_source(SystClkSource::Core);
    syst.set_reload(PERIOD - 1);
    syst.clear_current();
    syst.enable_interrupt();
    syst.enable_counter();
    let (mut slices, mut longest, mut ticks) = (0, 0, 0);
    while ticks < 2 * TICKS {
        with(|real| replanner.exchange(&mut real.controller));
        let before = ticks;
        replanner.work();
        cortex_m::asm::wfi();
        ticks = with(|real| real.ticks);
        // Without work it has waited for one tick.
        slices += u32::from(ticks - before > 1);
        longest = longest.max(ticks - before);
    }
    syst.disable_counter();
    with(|real| {
        let [upright, again] = real.upright.map(|tick| 2 * tick);
        println!("real upright_ms {upright}\nreal again_ms {again}");
        println!("real tick_instructions {}", real.slowest * PER_COUNT);
        println!(
            "real slices {slices}\nreal slice_ticks {longest}\nreal ram_bytes {}",
            ram::used()
        );
        // A second before each end.
        process::exit(i32::from(real.upright.iter().any(|tick| tick + 500 > TICKS)))
    })
}

fn with<T>(run: impl FnOnce(&mut Real) -> T) -> T {
    critical_section::with(|cs| match REAL.borrow_ref_mut(cs).as_mut() {
        Some(real) => run(real),
        None => process::exit(1),
    })
}

#[exception]
fn SysTick() {
    if with(tick).is_err() || SCB::is_pendst_pending() {
        println!("the estimate overflows, or the next tick came before this one was done");
        process::exit(1)
    }
}

fn tick(real: &mut Real) -> Result<(), Error> {
    let State { theta1, theta2, .. } = real.machine.state();
    let counts = [theta1, theta2].map(|angle| {
        let count = angle / TAU * 4096.0;
        (count + 0.5_f32.copysign(count)) as i32
    });
    let before = SYST::get_current();
    let torque = real.controller.tick(counts)?;
    real.slowest = real.slowest.max((before + PERIOD - SYST::get_current()) % PERIOD);
    real.machine.step(torque)?;
    let mut state = real.machine.state();
    if real.ticks == TICKS {
        state.dtheta1 += PUSH[0];
        state.dtheta2 += PUSH[1];
        real.machine.set_state(state)?;
    }
    let upright = &mut real.upright[usize::from(real.ticks >= TICKS)];
    let [lean1, lean2, ..] = state.deviation_from(State::UPRIGHT);
    if lean1.abs() > 0.1 || lean2.abs() > 0.1 {
        *upright = real.ticks % TICKS + 1;
    }
    real.ticks += 1;
    Ok(())
}
