//! The mean returns of policies from the same initial states.

use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, State, TimeLimit};
use anyhow::Context;
use desktop::{bang_bang, train};
use learners::{Budget, Memory, Memory16, Memory64, QLambda};

use crate::{SEEDS, bound, initial, mean_return};

/// The seed of learning and of random actions.
const SEED: u64 = 42;
const BUDGET: Budget = Budget::Steps(1_000_000);

pub fn print(best: &[Vec<Action>]) -> anyhow::Result<()> {
    println!("| policy | mean return |\n|---|---|");
    let row = |name: &str, mean: f64| println!("| {name} | −{:.2} |", -mean);
    let mut actions = Pcg64::new(SEED);
    row("random", mean(|_| Action::sample(&mut actions)));
    row("torque against θ̇1", mean(|state| bang_bang(state.dtheta1)));

    row("learnt, 16 KiB", learnt(Memory16::EMPTY));
    row("learnt, 64 KiB", learnt(Memory64::EMPTY));

    let steps: usize = best.iter().map(Vec::len).sum();
    row("best known", mean_return(steps as f64));
    let least = (0..SEEDS).map(|seed| bound::least_steps(initial(seed.into())));
    let least: Option<u32> = least.sum();
    let highest = mean_return(least.context("an initial state is in the target")?.into());
    // Rounded up, so that an upper bound stays one.
    row("bound", (highest * 100.0).ceil() / 100.0);
    Ok(())
}

fn learnt<const S: usize, const T: usize, const N: usize>(mut memory: Memory<S, T, N>) -> f64 {
    let mut learner = QLambda::new(BUDGET, &mut memory);
    train(&mut learner, BUDGET, SEED.into());
    mean(|state| learner.greedy(state))
}

/// The mean return of a policy in `Fast`, with at most 500 steps per episode.
fn mean(mut policy: impl FnMut(&State<f32>) -> Action) -> f64 {
    let mut env = TimeLimit::with_task_limit(Acrobot::<Fast>::new(0));
    let mut sum = 0.0;
    for seed in 0..SEEDS {
        env.reset_with_seed(u64::from(seed));
        loop {
            let step = env.step(policy(&env.state()));
            sum += f64::from(step.reward);
            if step.is_done() {
                break;
            }
        }
    }
    sum / f64::from(SEEDS)
}
