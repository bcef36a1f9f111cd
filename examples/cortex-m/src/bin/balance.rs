//! Swings the acrobot up and holds it upright, at 100 Hz: SysTick's interrupt decides on the
//! torque, and steps the acrobot, which stands for the machine. A random torque disturbs each tick.
//! It begins in 5 initial states; 1,000 follow without waiting for the clock, and 100 with each
//! weaker motor, that of 1 N m at 50 Hz.
//!
//! For each motor it plans once, from hanging at rest, with less torque than the motor has. Each
//! acrobot follows the plan, and then a regulator holds it. One that falls swings up without a
//! plan. It fails if a tick misses its deadline, and if the first plan is not bit-identical to that
//! of a desktop.

#![no_std]
#![no_main]

use core::cell::RefCell;

use acrobot::control::{ControlError, Knot, Planner, difference};
use acrobot::physics::saturate;
use acrobot::{Acrobot, Error, Fast, Params, State};
use acrobot_cortex_m::ram;
use bits::plan;
use cortex_m::Peripherals;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};
use cortex_m_rt::{entry, exception};
use critical_section::Mutex;
use semihosting::{println, process};

/// Counts per second of SysTick: the clock of QEMU's mps2-an386.
const CLOCK: u32 = 25_000_000;
/// Ticks per second.
const RATE: u32 = plan::RATE;
const PERIOD: u32 = CLOCK / RATE;
/// Instructions per count under QEMU's `-icount shift=0`.
const PER_COUNT: u32 = 1_000_000_000 / CLOCK;

/// Each tick adds a random torque of at most this to the motor's, N m.
const DISTURBANCE: f32 = 0.5;
/// An episode ends after this time, or when the acrobot has been upright for the other, s.
const MOST: u32 = 100;
const HELD: u32 = 10;

/// A motor's largest torque and that of its plan, N m, and decisions per second.
#[derive(Clone, Copy)]
struct Motor {
    name: &'static str,
    limit: f32,
    planned: f32,
    rate: u32,
}

impl Motor {
    const fn new(name: &'static str, limit: f32, planned: f32) -> Self {
        let rate = if limit > 1.0 { RATE } else { RATE / 2 };
        Self { name, limit, planned, rate }
    }
}

const STRONG: Motor = Motor::new("10_Nm", 10.0, plan::LIMIT);
const WEAKER: [Motor; 4] = [
    Motor::new("7_Nm", 7.0, 5.5),
    Motor::new("5_Nm", 5.0, 4.0),
    Motor::new("2_Nm", 2.0, 1.5),
    Motor::new("1_Nm", 1.0, 0.8),
];

/// The memory of the plan, and its steps.
static PLAN: Mutex<RefCell<(plan::Memory, usize)>> = Mutex::new(RefCell::new((plan::empty(), 0)));
static EPISODE: Mutex<RefCell<Option<Episode>>> = Mutex::new(RefCell::new(None));

struct Episode {
    machine: Acrobot<Fast>,
    planner: Planner<Fast>,
    motor: Motor,
    ticks: u32,
    /// The ticks for which each angle has been within 0.1 rad of upright, and the largest of these
    /// deviations in the second half of them.
    held: u32,
    error: f32,
    /// Counts that the decisions took: in all, and at most in a tick.
    counts: u64,
    slowest: u32,
}

impl Episode {
    fn is_over(&self) -> bool {
        self.held == HELD * self.motor.rate || self.ticks == MOST * self.motor.rate
    }

    fn tick(&mut self, plan: &[Knot<f32>]) -> Result<(), Error> {
        let before = SYST::get_current();
        let state = self.machine.state();
        let torque = match plan.get(self.ticks as usize) {
            Some(step) => saturate(step.follow(state), self.motor.limit),
            None => self.planner.decide(state)?,
        };
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
        if self.held > HELD * self.motor.rate / 2 {
            self.error = self.error.max(deviation);
        }
        Ok(())
    }
}

#[exception]
fn SysTick() {
    let failed = critical_section::with(|cs| {
        let (memory, steps) = &*PLAN.borrow_ref(cs);
        let mut episode = EPISODE.borrow_ref_mut(cs);
        let running = episode.as_mut().filter(|episode| !episode.is_over());
        running.is_some_and(|episode| episode.tick(&memory[..*steps]).is_err())
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
    make_plan(STRONG);
    let digest = critical_section::with(|cs| {
        let (memory, steps) = &*PLAN.borrow_ref(cs);
        plan::digest(&memory[..*steps])
    });
    syst.clear_current();
    syst.enable_counter();
    syst.enable_interrupt();
    let in_time = run(cortex_m::asm::wfi, STRONG, "in_time", 5);
    // A tick follows the last one at once.
    syst.disable_interrupt();
    let caught = run(SCB::set_pendst, STRONG, STRONG.name, 1000);
    let mut passed = digest == plan::PLAN && in_time == Ok(0) && caught == Ok(0);
    for motor in WEAKER {
        make_plan(motor);
        passed &= run(SCB::set_pendst, motor, motor.name, 100).is_ok();
    }
    println!("10_Nm ram_bytes {}", ram::used());
    process::exit(if passed { 0 } else { 1 })
}

/// Prints the time that the plan takes, rounded up, and the instructions that planning took.
fn make_plan(motor: Motor) {
    /// The first timer of QEMU's mps2-an386: control and value. It counts the core's clock down.
    const TIMER: *mut u32 = 0x4000_0000 as *mut u32;
    let steps = critical_section::with(|cs| {
        let (memory, steps) = &mut *PLAN.borrow_ref_mut(cs);
        // SAFETY: nothing else uses the timer.
        unsafe {
            TIMER.add(1).write_volatile(u32::MAX);
            TIMER.write_volatile(1);
        }
        *steps = plan::plan(motor.planned, motor.rate, memory).map_or(0, |plan| plan.len());
        *steps as u32
    });
    // SAFETY: as above.
    let counts = u32::MAX - unsafe { TIMER.add(1).read_volatile() };
    println!("{} plan_s {}", motor.name, steps.div_ceil(motor.rate));
    let instructions = u64::from(counts) * u64::from(PER_COUNT);
    println!("{} plan_millions {}", motor.name, instructions / 1_000_000);
}

/// Prints the figures, times and errors rounded up, and returns how many acrobots were not caught.
fn run(next_tick: fn(), motor: Motor, name: &str, episodes: u32) -> Result<u32, ControlError> {
    let rate = motor.rate;
    let params = Params { torque_noise: DISTURBANCE, ..plan::params(rate) };
    let planner = Planner::new(params, motor.limit)?;
    let (mut uncaught, mut ticks, mut caught, mut longest) = (0, 0, 0, 0);
    let (mut error, mut counts, mut slowest) = (0_f32, 0, 0);
    for seed in 0..episodes {
        let mut machine = Acrobot::new(seed.into());
        machine.set_params(params)?;
        let episode = Episode {
            machine,
            planner: planner.clone(),
            motor,
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
        if episode.held < HELD * rate {
            uncaught += 1;
            continue;
        }
        let time = episode.ticks - HELD * rate;
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
        println!("{name} catch_mean_s {}", mean.div_ceil(rate));
        println!("{name} catch_longest_s {}", longest.div_ceil(rate));
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
