//! Learns to swing up on the microcontroller until the mean return of 100 episodes is at least −100. It needs 19,872
//! bytes of RAM, and the learner has 16 KiB of them. Its weights are bit-identical to those of a desktop. Then it plays an episode on an OLED.
//!
//! It prints figures in the format of `bench`: `fast figure value`.

#![no_std]
#![no_main]

use core::cell::RefCell;

use acrobot::{Action, REWARD_THRESHOLD, State};
use acrobot_cortex_m::counter::Counter;
use acrobot_cortex_m::panel::{Bus, Panel};
use acrobot_cortex_m::ram;
use bits::training::{EPISODES, Learner};
use bits::{oled, training};
use cortex_m_rt::entry;
use heapless::HistoryBuf;
use learners::{Env, Memory16, play};
use semihosting::{println, process};
use ssd1306::mode::DisplayConfig;
use ssd1306::prelude::{DisplayRotation, DisplaySize128x64};
use ssd1306::{I2CDisplayInterface, Ssd1306};

#[entry]
fn main() -> ! {
    static mut MEMORY: Memory16 = Memory16::EMPTY;
    let Some(mut counter) = Counter::take() else {
        process::exit(1)
    };
    let mut learner = training::learner(MEMORY);
    let solved = train(&mut learner, &mut counter);
    let mut env = training::evaluation();
    let policy = |state: &State<f32>| learner.greedy(state);
    let sum: f32 = (0..100).map(|_| play(&mut env, policy).0).sum();
    println!("mean return of 100 greedy episodes: {}", sum as i32 / 100);
    env.reset();
    let swung_up = draw(env, policy);
    println!("fast ram {}", ram::used());
    process::exit(if solved && swung_up { 0 } else { 1 })
}

/// Returns whether the task was solved with the expected weights on the way.
fn train(learner: &mut Learner, counter: &mut Counter) -> bool {
    let mut env = training::env();
    let mut returns = HistoryBuf::<f32, 100>::new();
    let (mut steps, mut instructions) = (0, 0);
    let mut equal = false;
    for episode in 1..=EPISODES {
        // `cycles.py` begins to count here.
        cortex_m::asm::nop();
        let mut gained = 0.0;
        instructions += u64::from(counter.count(1, || {
            gained = learner.learn(&mut env);
        }));
        steps += env.elapsed();
        returns.write(gained);
        if episode % 10 == 0 {
            let mean = returns.oldest_ordered().rev().take(10).sum::<f32>() as i32 / 10;
            println!("{episode:>4} {mean:>5} {:*<1$}", "", (-mean / 5) as usize);
        }
        if episode == training::COMPARED {
            let found = training::digest(learner);
            equal = found == training::WEIGHTS;
            if !equal {
                println!("the weights differ: digest {found:#018x}");
            }
        }
        if returns.is_full() && returns.iter().sum::<f32>() >= REWARD_THRESHOLD * 100.0 {
            println!("solved at episode {episode}");
            println!("fast learn {}", instructions / u64::from(steps));
            println!("fast training {}", instructions / 1_000_000);
            return equal;
        }
    }
    println!("not solved in {EPISODES} episodes");
    false
}

/// Plays an episode on a display. Returns whether it reached the goal.
fn draw(env: Env, policy: impl Fn(&State<f32>) -> Action) -> bool {
    let panel = RefCell::new(Panel::default());
    let interface = I2CDisplayInterface::new(Bus(&panel));
    let mut display = Ssd1306::new(interface, DisplaySize128x64, DisplayRotation::Rotate0)
        .into_buffered_graphics_mode();
    let mut failed = display.init().is_err();
    let mut frames = 0;
    let drawn = oled::play(
        &mut display,
        env,
        |acrobot| policy(&acrobot.state()),
        |display| {
            frames += 1;
            failed |= display.flush().is_err();
        },
    );
    // The first frame shows the initial state.
    let steps = frames - 1;
    println!("swings up in {steps} steps");
    !failed && !panel.borrow().unknown && drawn.is_ok() && steps < 500
}
