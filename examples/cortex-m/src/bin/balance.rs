//! Swings the acrobot up and holds it upright, 100 times a second. The acrobot stands for the
//! machine, and a random torque disturbs each tick. It begins in 5 initial states; 1,000 follow
//! without waiting for the clock, and 100 with each weaker motor, that of 1 N m at 50 Hz.
//!
//! For each motor it plans once, from hanging at rest, with less torque than the motor has. Each
//! acrobot follows the plan, and then a regulator holds it. One that falls swings up without a
//! plan. It fails if a tick misses its deadline, and if the first plan is not bit-identical to that
//! of a desktop.

#![no_std]
#![no_main]

use acrobot::control::plan::{Knot, SwingUp};
use acrobot::physics::saturate;
use acrobot::{Acrobot, Error, Fast, Params, State};
use acrobot_cortex_m::ram;
use bits::plan;
use cortex_m::Peripherals;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};
use cortex_m_rt::entry;
use semihosting::{println, process};

/// Counts per second of SysTick: the clock of QEMU's mps2-an386.
const CLOCK: u32 = 25_000_000;
/// Counts per tick.
const PERIOD: u32 = CLOCK / plan::RATE;
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

const STRONG: Motor = Motor { name: "10_Nm", limit: 10.0, planned: plan::LIMIT, rate: plan::RATE };
const WEAKER: [Motor; 2] = [
    Motor { name: "2_Nm", limit: 2.0, planned: 1.5, rate: plan::RATE },
    Motor { name: "1_Nm", limit: 1.0, planned: 0.8, rate: plan::RATE / 2 },
];

#[derive(Default)]
struct Episode {
    ticks: u32,
    /// The ticks for which each angle has been within 0.1 rad of upright, and the largest of these
    /// deviations in the second half of them.
    held: u32,
    error: f32,
    /// Counts that the decisions took: in all, and at most in a tick.
    counts: u64,
    slowest: u32,
}

#[entry]
fn main() -> ! {
    static mut MEMORY: plan::Memory = plan::empty();
    let Some(peripherals) = Peripherals::take() else { process::exit(1) };
    // SysTick stays pending, and only ends the wait for the next tick.
    cortex_m::interrupt::disable();
    let mut syst = peripherals.SYST;
    syst.set_clock_source(SystClkSource::Core);
    syst.set_reload(PERIOD - 1);
    syst.clear_current();
    syst.enable_counter();
    syst.enable_interrupt();
    let plan = make_plan(STRONG, MEMORY);
    let mut passed = plan::digest(plan) == plan::PLAN;
    passed &= run("in_time", STRONG, plan, 5, true) == Ok(0);
    passed &= run(STRONG.name, STRONG, plan, 1000, false) == Ok(0);
    for motor in WEAKER {
        passed &= run(motor.name, motor, make_plan(motor, MEMORY), 100, false).is_ok();
    }
    println!("10_Nm ram_bytes {}", ram::used());
    process::exit(if passed { 0 } else { 1 })
}

/// Prints the time that the plan takes, rounded up, and the instructions that planning took.
fn make_plan(motor: Motor, memory: &mut plan::Memory) -> &[Knot<f32>] {
    /// The first timer of QEMU's mps2-an386: control and value. It counts the core's clock down.
    const TIMER: *mut u32 = 0x4000_0000 as *mut u32;
    // SAFETY: nothing else uses the timer.
    unsafe {
        TIMER.add(1).write_volatile(u32::MAX);
        TIMER.write_volatile(1);
    }
    let plan = plan::plan(motor.planned, motor.rate, memory).map_or(&[][..], |plan| plan.knots);
    // SAFETY: as above.
    let counts = u32::MAX - unsafe { TIMER.add(1).read_volatile() };
    println!("{} plan_s {}", motor.name, (plan.len() as u32).div_ceil(motor.rate));
    let instructions = u64::from(counts) * u64::from(PER_COUNT);
    println!("{} plan_millions {}", motor.name, instructions / 1_000_000);
    plan
}

/// Prints the figures, times and errors rounded up, and returns how many acrobots were not caught.
fn run(
    name: &str,
    motor: Motor,
    plan: &[Knot<f32>],
    episodes: u32,
    in_time: bool,
) -> Result<u32, Error> {
    let rate = motor.rate;
    let params = Params { torque_noise: DISTURBANCE, ..plan::params(rate) };
    let swing_up = SwingUp::new(params, motor.limit)?;
    let (mut uncaught, mut ticks, mut caught, mut longest) = (0, 0, 0, 0);
    let (mut error, mut counts, mut slowest) = (0_f32, 0, 0);
    for seed in 0..episodes {
        let machine = Acrobot::with_params(u64::from(seed), params)?;
        let episode = play(machine, swing_up.clone(), motor, plan, in_time)?;
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

fn play(
    mut machine: Acrobot<Fast>,
    mut swing_up: SwingUp<Fast>,
    motor: Motor,
    plan: &[Knot<f32>],
    in_time: bool,
) -> Result<Episode, Error> {
    let mut episode = Episode::default();
    while episode.held < HELD * motor.rate && episode.ticks < MOST * motor.rate {
        if in_time {
            cortex_m::asm::wfi();
            SCB::clear_pendst();
        }
        let before = SYST::get_current();
        let state = machine.state();
        let torque = match plan.get(episode.ticks as usize) {
            Some(step) => saturate(step.follow(state), motor.limit),
            None => swing_up.torque(state)?,
        };
        // The counter counts down, and begins again from the period.
        let took = (before + PERIOD - SYST::get_current()) % PERIOD;
        episode.counts += u64::from(took);
        episode.slowest = episode.slowest.max(took);

        machine.step_torque(torque)?;
        episode.ticks += 1;
        let [theta1, theta2, ..] = machine.state().deviation_from(State::UPRIGHT);
        let deviation = theta1.abs().max(theta2.abs());
        if deviation > 0.1 {
            (episode.held, episode.error) = (0, 0.0);
        } else {
            episode.held += 1;
            if episode.held > HELD * motor.rate / 2 {
                episode.error = episode.error.max(deviation);
            }
        }
        if in_time && SCB::is_pendst_pending() {
            println!("the next tick came before the work of this one was done");
            process::exit(1)
        }
    }
    Ok(episode)
}
