//! Plays a policy that was trained in Python. Compares its actions on 10,000 observations with
//! those that torch computed.

#![no_std]
#![no_main]

use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::{Acrobot, Action, Fast, TimeLimit};
use acrobot_cortex_m::counter::Counter;
use acrobot_cortex_m::ram;
use cortex_m_rt::entry;
use policy::Policy;
use semihosting::{println, process};

/// The compiler checks the file.
static POLICY: Policy<64> =
    match Policy::new(include_bytes!("../../../../crates/policy/policy.bin")) {
        Ok(policy) => policy,
        Err(error) => panic!("{}", error.message()),
    };
/// Four actions a byte, 3 for a tie: `record.py` in `crates/policy`.
static ACTIONS: [u8; 2500] = *include_bytes!("../../../../crates/policy/actions.bin");

const EPISODES: u32 = 100;

#[entry]
fn main() -> ! {
    let mut counter = Counter::take();
    let (equal, ties) = compare();
    let total = 4 * ACTIONS.len();
    println!("{equal} of {total} actions are equal, {ties} ties");

    let mut env = env();
    let observation = env.observation();
    let count = counter.count(1, || {
        core::hint::black_box(POLICY.action(&observation));
    });
    println!("fast decision {count}");
    let mut gained = 0.0;
    for _ in 0..EPISODES {
        loop {
            let step = env.step(POLICY.action(&env.observation()));
            gained += step.reward;
            if step.is_done() {
                break;
            }
        }
        env.reset();
    }
    let mean = gained as i32 / EPISODES as i32;
    println!("mean return of {EPISODES} episodes: {mean}");
    println!("fast decision_ram {}", ram::used());
    process::exit(if equal + ties == total { 0 } else { 1 })
}

/// The first acrobot of a batch with seed 1.
fn env() -> TimeLimit<Acrobot<Fast>> {
    let mut env = TimeLimit::with_task_limit(Acrobot::new(0));
    env.reset_with_seed(SeedSequence::new(1).child(0));
    env
}

/// Of the observations under random actions: on how many the action is torch's, and how many ties
/// there are.
fn compare() -> (usize, usize) {
    let mut env = env();
    let mut random = Pcg64::new(1);
    let (mut equal, mut ties) = (0, 0);
    for four in ACTIONS {
        for shift in [0, 2, 4, 6] {
            match Action::try_from(four >> shift & 3) {
                Ok(expected) => equal += usize::from(POLICY.action(&env.observation()) == expected),
                Err(_) => ties += 1,
            }
            if env.step(Action::sample(&mut random)).is_done() {
                env.reset();
            }
        }
    }
    (equal, ties)
}
