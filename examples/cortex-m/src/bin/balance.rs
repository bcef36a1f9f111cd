//! Swings the acrobot up and holds it upright, at 100 Hz: SysTick's interrupt decides on the torque, and steps the acrobot,
//! which stands for the machine. A random torque disturbs each tick. It begins with 5 initial states; 1,000 follow without
//! waiting for the clock, and 100 with each weaker motor.
//!
//! The controller computes its gains when the program starts. Prints one figure a line: the largest torque, the figure's
//! name and unit, and its value.

#![no_std]
#![no_main]

use core::cell::RefCell;

use acrobot::physics::control::{ControlError, difference};
use acrobot::{Acrobot, Error, Fast, Params, State};
use acrobot_cortex_m::ram;
use controller::Controller;
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
/// Instructions per count under QEMU's `-icount shift=0`.
const PER_COUNT: u32 = 1_000_000_000 / CLOCK;

/// Each tick adds a random torque of at most this to the motor's, N m.
const DISTURBANCE: f32 = 0.5;
/// An episode ends after this many ticks, or when the acrobot has been upright for `HELD` ticks.
const MOST: u32 = 200 * RATE;
const HELD: u32 = 10 * RATE;

static EPISODE: Mutex<RefCell<Option<Episode>>> = Mutex::new(RefCell::new(None));

struct Episode {
    machine: Acrobot<Fast>,
    controller: Controller,
    ticks: u32,
    /// The ticks for which each angle has been within 0.1 rad of upright, and the largest of these deviations since 5 s.
    held: u32,
    error: f32,
    /// Counts that the controller took: in all, and at most in a tick.
    counts: u64,
    slowest: u32,
}

impl Episode {
    fn is_over(&self) -> bool {
        self.held == HELD || self.ticks == MOST
    }

    fn tick(&mut self) -> Result<(), Error> {
        let before = SYST::get_current();
        let torque = self.controller.decide(self.machine.state())?;
        // The counter counts down, and begins again from the period.
        let took = (before + PERIOD - SYST::get_current()) % PERIOD;
        self.counts += u64::from(took);
        self.slowest = self.slowest.max(took);

        self.machine.step_torque(torque)?;
        self.ticks += 1;
        let [theta1, theta2, ..] = difference(self.machine.state(), State::UPRIGHT);
        let deviation = theta1.abs().max(theta2.abs());
        if deviation > 0.1 {
            (self.held, self.error) = (0, 0.0);
            return Ok(());
        }
        self.held += 1;
        if self.held > HELD / 2 {
            self.error = self.error.max(deviation);
        }
        Ok(())
    }
}

#[exception]
fn SysTick() {
    let failed = critical_section::with(|cs| {
        let mut episode = EPISODE.borrow_ref_mut(cs);
        let running = episode.as_mut().filter(|episode| !episode.is_over());
        running.is_some_and(|episode| episode.tick().is_err())
    });
    if failed || SCB::is_pendst_pending() {
        println!("a number is not finite, or a tick came before the work of the last one was done");
        process::exit(1)
    }
}

#[entry]
fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else { process::exit(1) };
    let mut syst = peripherals.SYST;
    syst.set_clock_source(SystClkSource::Core);
    syst.set_reload(PERIOD - 1);
    syst.clear_current();
    syst.enable_interrupt();
    syst.enable_counter();
    // At 100 Hz.
    let in_time = run(cortex_m::asm::wfi, 10.0, "in_time", 5);
    // A tick follows the last one at once.
    syst.disable_interrupt();
    let caught = run(SCB::set_pendst, 10.0, "10_Nm", 1000);
    for (limit, name) in [(7.0, "7_Nm"), (5.0, "5_Nm"), (2.0, "2_Nm"), (1.0, "1_Nm")] {
        if run(SCB::set_pendst, limit, name, 100).is_err() {
            process::exit(1)
        }
    }
    println!("10_Nm ram_bytes {}", ram::used());
    let passed = in_time == Ok(0) && caught == Ok(0);
    process::exit(if passed { 0 } else { 1 })
}

/// Plays episodes with a largest torque, N m. Prints the figures, times and errors rounded up, and returns how many acrobots
/// were not caught.
fn run(next_tick: fn(), limit: f32, name: &str, episodes: u32) -> Result<u32, ControlError> {
    let params = Params { dt: 1.0 / RATE as f32, torque_noise: DISTURBANCE, ..Params::DEFAULT };
    let (mut uncaught, mut ticks, mut caught, mut longest) = (0, 0, 0, 0);
    let (mut error, mut counts, mut slowest) = (0_f32, 0, 0);
    for seed in 0..episodes {
        let mut machine = Acrobot::new(seed.into());
        machine.set_params(params)?;
        let episode = Episode {
            machine,
            controller: Controller::new(params, limit)?,
            ticks: 0,
            held: 0,
            error: 0.0,
            counts: 0,
            slowest: 0,
        };
        let episode = play(episode, next_tick);
        ticks += episode.ticks;
        counts += episode.counts;
        slowest = slowest.max(episode.slowest);
        if episode.held < HELD {
            uncaught += 1;
            continue;
        }
        let time = episode.ticks - HELD;
        caught += time;
        longest = longest.max(time);
        error = error.max(episode.error);
    }
    println!("{name} uncaught {uncaught}");
    let mean = counts * u64::from(PER_COUNT) / u64::from(ticks);
    println!("{name} instructions_mean {mean}");
    println!("{name} instructions_most {}", slowest * PER_COUNT);
    if uncaught < episodes {
        let mean = caught / (episodes - uncaught);
        println!("{name} catch_mean_s {}", mean.div_ceil(RATE));
        println!("{name} catch_longest_s {}", longest.div_ceil(RATE));
        println!("{name} error_mrad {}", (error * 1000.0) as u32 + 1);
    }
    Ok(uncaught)
}

/// Waits until the interrupt has played an episode.
fn play(episode: Episode, next_tick: fn()) -> Episode {
    critical_section::with(|cs| EPISODE.replace(cs, Some(episode)));
    loop {
        next_tick();
        let over = critical_section::with(|cs| {
            let mut episode = EPISODE.borrow_ref_mut(cs);
            episode.take_if(|episode| episode.is_over())
        });
        if let Some(episode) = over {
            return episode;
        }
    }
}
