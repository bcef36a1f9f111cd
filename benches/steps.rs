//! Steps per second: `cargo bench -p benches --bench steps`. The table includes the yardsticks, `bare` and
//! `batch_bare`. The program `throughput` prints ratios to them.

use std::time::Duration;

use acrobot::arithmetic::{Arithmetic, Host, Micro, Reference};
use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, Portable, TimeLimit};
use benches::Play;
use divan::counter::ItemsCount;
use divan::{Bencher, Divan, black_box};

fn main() {
    Divan::from_args()
        .max_time(Duration::from_millis(500))
        .main();
}

/// From one acrobot to a million.
const SIZES: [usize; 6] = [1, 16, 128, 1024, 32_768, 1 << 20];

/// Steps with and without the observation, which is not computed if it is not read.
#[divan::bench(types = [Host, Reference, Portable, Fast, Micro], args = ["observed", "unobserved"])]
fn alone<A: Arithmetic>(bencher: Bencher, how: &str) {
    let actions = actions();
    let mut acrobot = TimeLimit::v1(Acrobot::<A>::new(0));
    bencher
        .counter(ItemsCount::new(actions.len()))
        .bench_local(|| {
            for &action in &actions {
                let step = acrobot.step(action);
                if how == "observed" {
                    black_box(step.observation);
                }
                if step.done() {
                    acrobot.reset();
                }
            }
            black_box(acrobot.state());
        });
}

#[divan::bench(args = [32, 64])]
fn bare(bencher: Bencher, bits: u32) {
    let actions = actions();
    let bare = match bits {
        32 => benches::bare_f32,
        _ => benches::bare_f64,
    };
    bencher
        .counter(ItemsCount::new(actions.len()))
        .bench_local(|| bare(&actions));
}

#[divan::bench(types = [Host, Reference, Portable, Fast, Micro], args = SIZES)]
fn batch<A: Arithmetic>(bencher: Bencher, len: usize) {
    let mut play = Play::<A>::new(len);
    bencher
        .counter(ItemsCount::new(len))
        .bench_local(|| play.play(false));
}

#[divan::bench(types = [Host, Reference, Portable, Fast, Micro], args = SIZES)]
fn batch_with_observations<A: Arithmetic>(bencher: Bencher, len: usize) {
    let mut play = Play::<A>::new(len);
    bencher
        .counter(ItemsCount::new(len))
        .bench_local(|| play.play(true));
}

/// The actions stay the same, because only the step runs on all cores.
#[divan::bench(types = [Portable, Fast], args = SIZES)]
fn batch_on_all_cores<A: Arithmetic>(bencher: Bencher, len: usize) {
    let mut play = Play::<A>::new(len);
    bencher
        .counter(ItemsCount::new(len))
        .bench_local(|| play.step(false, true));
}

/// Handwritten AVX2 with eight lanes, with and without fused multiply-adds.
#[divan::bench(args = ["fma", "nofma"])]
fn batch_bare(bencher: Bencher, flavour: &str) {
    if let Some(mut bare) = benches::Lanes::new(flavour == "fma") {
        let steps = bare.run();
        bencher
            .counter(ItemsCount::new(steps))
            .bench_local(|| bare.run());
    }
}

#[divan::bench(types = [Host, Reference, Portable, Fast, Micro])]
fn reset<A: Arithmetic>(bencher: Bencher) {
    let mut acrobot = Acrobot::<A>::new(0);
    bencher
        .counter(ItemsCount::new(1_usize))
        .bench_local(|| acrobot.reset());
}

#[divan::bench(args = SIZES)]
fn seed_a_batch(bencher: Bencher, len: usize) {
    let mut batch = Play::<Fast>::new(len).batch;
    let mut seed = 0_u64;
    bencher.counter(ItemsCount::new(len)).bench_local(|| {
        seed += 1;
        batch.reset_with_seed(seed);
    });
}

fn actions() -> Vec<Action> {
    let mut rng = Pcg64::new(0);
    (0..4096).map(|_| Action::sample(&mut rng)).collect()
}
