//! Steps a second of one core, and their ratio to a bare loop: `name steps_per_second ratio`, a line each.
//!
//! A batch plays a random policy with its actions drawn and its episodes reset in the loop. Its yardstick
//! is a loop over eight lanes of AVX2 by hand that does neither, with FMA (`batch_…`) and without
//! (`batch_…_nofma`). `scalar_fast`'s is the same equations for one acrobot in f32; that of
//! `scalar_portable` and `scalar_host` is Gymnasium's order in f64 with the platform's sines. Both play
//! the actions that ours plays. Each figure is the best of several runs, a run of ours and one of the yardstick in turn.
//!
//! ```text
//! cargo run --release --example throughput
//! ```

mod yardsticks;

use std::hint::black_box;
use std::time::Instant;

use acrobot::{
    Acrobot, Action, Arithmetic, Batch, Block, Fast, Host, Micro, Observations, Output, Pcg64,
    Portable, TimeLimit,
};
use yardsticks::{bare_f32, bare_f64};

fn main() {
    scalar::<Host>("scalar_host", bare_f64);
    scalar::<Portable>("scalar_portable", bare_f64);
    scalar::<Fast>("scalar_fast", bare_f32);
    scalar::<Micro>("scalar_micro", bare_f32);
    for len in [1024, 1 << 20] {
        batch::<Fast>("fast", len);
    }
    batch::<Portable>("portable", 1024);
    threads(1 << 20);
}

const LANES: usize = Block::<f32>::LANES;
const ROUNDS: usize = 7;

/// The best rates of `ours` and `yardstick`, run in turn; each returns how many steps it took.
fn compare(mut ours: impl FnMut() -> usize, mut yardstick: impl FnMut() -> usize) -> (f64, f64) {
    let rate = |run: &mut dyn FnMut() -> usize| {
        let start = Instant::now();
        let steps = run();
        steps as f64 / start.elapsed().as_secs_f64()
    };
    (0..ROUNDS).fold((0.0, 0.0), |(best, bare), _| {
        (
            f64::max(best, rate(&mut ours)),
            f64::max(bare, rate(&mut yardstick)),
        )
    })
}

fn report(name: &str, (rate, yardstick): (f64, f64)) {
    println!("{name} {rate:.0} {:.2}", rate / yardstick);
}

fn scalar<A: Arithmetic>(name: &str, yardstick: fn(&[Action])) {
    const STEPS: usize = 200_000;
    let mut rng = Pcg64::new(0);
    let actions: Vec<Action> = (0..STEPS).map(|_| Action::sample(&mut rng)).collect();
    let mut acrobot = TimeLimit::v1(Acrobot::<A>::new(0));
    let ours = || {
        for &action in &actions {
            if black_box(acrobot.step(action)).ended() {
                acrobot.reset();
            }
        }
        STEPS
    };
    let bare = || {
        yardstick(&actions);
        STEPS
    };
    report(name, compare(ours, bare));
}

fn batch<A: Arithmetic>(arithmetic: &str, len: usize) {
    let steps = (2_000_000 / len).max(2);
    let blocks = vec![Block::EMPTY; len.div_ceil(LANES)];
    let generators = vec![Pcg64::UNSEEDED; len];
    let mut batch = Batch::<A, _, _>::new(0, blocks, generators).expect("memory of its size");
    let mut streams: Vec<u32> = (0..len as u32)
        .map(|i| i.wrapping_mul(2_654_435_769))
        .collect();
    let mut actions = vec![0_u8; len];
    let (mut rewards, mut terminated, mut truncated) =
        (vec![0.0; len], vec![false; len], vec![false; len]);
    let mut rows = vec![[0.0; 6]; len];
    for (suffix, observe) in [("", false), ("_observations", true)] {
        let mut ours = || {
            for _ in 0..steps {
                for (stream, action) in streams.iter_mut().zip(&mut actions) {
                    *stream = stream.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    *action = (((*stream >> 16) * 3) >> 16) as u8;
                }
                let output = Output {
                    rewards: &mut rewards,
                    terminated: &mut terminated,
                    truncated: &mut truncated,
                    observations: match observe {
                        true => Observations::Rows(&mut rows),
                        false => Observations::None,
                    },
                    final_observations: Observations::None,
                };
                batch.step(&actions, output).expect("slices of its size");
            }
            steps * len
        };
        let name = format!("batch_{arithmetic}_{len}{suffix}");
        for (fma, flavour) in [(true, ""), (false, "_nofma")] {
            let name = format!("{name}{flavour}");
            match yardsticks::Lanes::new(fma) {
                Some(mut bare) => report(&name, compare(&mut ours, || bare.run())),
                None => println!("{name} has no yardstick here, which is AVX2 and FMA"),
            }
        }
    }
}

/// One call on all cores, beside the same on one: the ratio is that of the two.
fn threads(len: usize) {
    let blocks = vec![Block::EMPTY; len.div_ceil(LANES)];
    let generators = vec![Pcg64::UNSEEDED; len];
    let mut one = Batch::<Fast, _, _>::new(0, blocks, generators).expect("memory of its size");
    let mut many = one.clone();
    let actions: Vec<u8> = (0..len).map(|i| (i * 7 % 3) as u8).collect();
    let (mut rewards, mut terminated, mut truncated) =
        (vec![0.0; len], vec![false; len], vec![false; len]);
    let (mut rewards1, mut terminated1, mut truncated1) =
        (rewards.clone(), terminated.clone(), truncated.clone());
    let on_all = || {
        let output = Output {
            rewards: &mut rewards,
            terminated: &mut terminated,
            truncated: &mut truncated,
            observations: Observations::None,
            final_observations: Observations::None,
        };
        many.par_step(&actions, output).expect("slices of its size");
        len
    };
    let on_one = || {
        let output = Output {
            rewards: &mut rewards1,
            terminated: &mut terminated1,
            truncated: &mut truncated1,
            observations: Observations::None,
            final_observations: Observations::None,
        };
        one.step(&actions, output).expect("slices of its size");
        len
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    report(
        &format!("batch_fast_{len}_threads_{threads}"),
        compare(on_all, on_one),
    );
}
