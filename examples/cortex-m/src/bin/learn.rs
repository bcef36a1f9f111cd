//! Learns to swing up until the mean return of 100 episodes is at least −100. It fails if its
//! weights are not bit-identical to those of a desktop.

#![no_std]
#![no_main]

use acrobot::{REWARD_THRESHOLD, State};
use acrobot_cortex_m::counter::Counter;
use acrobot_cortex_m::ram;
use bits::training::{self, EPISODES, Learner};
use cortex_m_rt::entry;
use heapless::HistoryBuf;
use learners::{Memory16, play};
use semihosting::{println, process};

#[entry]
fn main() -> ! {
    static mut MEMORY: Memory16 = Memory16::EMPTY;
    let mut counter = Counter::take();
    let mut learner = training::learner(MEMORY);
    let solved = train(&mut learner, &mut counter);
    let mut env = training::evaluation();
    let policy = |state: &State<f32>| learner.greedy(state);
    let sum: f32 = (0..100).map(|_| play(&mut env, policy).0).sum();
    println!("mean return of 100 greedy episodes: {}", sum as i32 / 100);
    println!("fast ram {}", ram::used());
    let solved = solved && sum >= REWARD_THRESHOLD * 100.0;
    process::exit(if solved { 0 } else { 1 })
}

/// Returns whether the task was solved with the expected weights on the way.
#[inline(never)] // inlined it needs 4 % more instructions
fn train(learner: &mut Learner, counter: &mut Counter) -> bool {
    let mut env = training::env();
    let mut returns = HistoryBuf::<f32, 100>::new();
    let (mut steps, mut instructions) = (0, 0);
    let mut equal = false;
    for episode in 1..=EPISODES {
        let mut gained = 0.0;
        instructions += u64::from(counter.count(1, || {
            gained = learner.learn(&mut env);
        }));
        steps += env.elapsed_steps();
        returns.write(gained);
        if episode % 10 == 0 {
            let mean = returns.oldest_ordered().rev().take(10).sum::<f32>() as i32 / 10;
            println!("{episode:>4} {mean:>5} {:*<1$}", "", (-mean / 5) as usize);
        }
        if episode == training::COMPARED {
            equal = training::digest(learner) == training::WEIGHTS;
            println!("the weights are bit-identical: {equal}");
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
