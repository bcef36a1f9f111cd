//! Instructions of a step, which callgrind counts alike in every run: a gate.
//!
//! ```text
//! cargo install --locked gungraun-runner@0.20.0    # and valgrind, of the system
//! cargo bench --bench instructions
//! ```
//!
//! It fails where a count exceeds its limit: what was measured, and a twentieth that a new compiler may cost.
//! On x86-64 with AVX2; valgrind knows no AVX-512. `Host` has no limit, for it calls the platform's library.

#[path = "../examples/throughput/main.rs"]
#[allow(dead_code, reason = "what it prints")]
mod throughput;

use std::hint::black_box;

use acrobot::{
    Acrobot, Action, Arithmetic, Batch, Fast, Host, Micro, Portable, TimeLimit, Vectors,
};
use gungraun::{
    Callgrind, EventKind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main,
};
use throughput::Play;

/// Two episodes by a random policy, and their resets.
const STEPS: usize = 1000;
const ACROBOTS: usize = 64;

/// So many instructions for each step of each acrobot.
fn limit(instructions: f64, acrobots: usize) -> LibraryBenchmarkConfig {
    let limit = (instructions * 1.05 * (acrobots * STEPS) as f64) as u64;
    let mut callgrind = Callgrind::with_args(["cache-sim=no"]);
    callgrind.hard_limits([(EventKind::Ir, limit)]);
    let mut config = LibraryBenchmarkConfig::default();
    config.tool(callgrind);
    config
}

fn alone<A: Arithmetic>() -> (TimeLimit<Acrobot<A>>, Vec<Action>) {
    let mut rng = acrobot::Pcg64::new(0);
    let actions = (0..STEPS).map(|_| Action::sample(&mut rng)).collect();
    (TimeLimit::v1(Acrobot::new(0)), actions)
}

fn batch<A: Arithmetic>(vectors: Vectors) -> Play<A> {
    assert!(vectors.is_available(), "this machine has no {vectors:?}");
    let mut play = Play::new(ACROBOTS);
    play.batch.set_vectors(vectors);
    play
}

type Alone<A> = (TimeLimit<Acrobot<A>>, Vec<Action>);

#[inline(always)]
fn play_alone<A: Arithmetic>((mut acrobot, actions): Alone<A>) -> Alone<A> {
    for &action in &actions {
        if black_box(acrobot.step(action)).ended() {
            acrobot.reset();
        }
    }
    (acrobot, actions)
}

#[inline(always)]
fn play_batch<A: Arithmetic>(mut play: Play<A>, observe: bool) -> Play<A> {
    for _ in 0..STEPS {
        play.draw_actions();
        play.step(observe, Batch::step);
    }
    play
}

#[library_benchmark(setup = alone::<Host>)]
fn host(alone: Alone<Host>) -> Alone<Host> {
    play_alone(alone)
}

#[library_benchmark(config = limit(1162.0, 1), setup = alone::<Portable>)]
fn portable(alone: Alone<Portable>) -> Alone<Portable> {
    play_alone(alone)
}

#[library_benchmark(config = limit(647.0, 1), setup = alone::<Fast>)]
fn fast(alone: Alone<Fast>) -> Alone<Fast> {
    play_alone(alone)
}

#[library_benchmark(config = limit(491.0, 1), setup = alone::<Micro>)]
fn micro(alone: Alone<Micro>) -> Alone<Micro> {
    play_alone(alone)
}

#[library_benchmark(setup = batch::<Fast>)]
#[bench::baseline(args = (Vectors::Baseline), config = limit(243.0, ACROBOTS))]
#[bench::avx2(args = (Vectors::Avx2), config = limit(116.0, ACROBOTS))]
fn batch_fast(play: Play<Fast>) -> Play<Fast> {
    play_batch(play, false)
}

#[library_benchmark(setup = batch::<Fast>)]
#[bench::baseline(args = (Vectors::Baseline), config = limit(259.0, ACROBOTS))]
#[bench::avx2(args = (Vectors::Avx2), config = limit(132.0, ACROBOTS))]
fn batch_fast_with_observations(play: Play<Fast>) -> Play<Fast> {
    play_batch(play, true)
}

#[library_benchmark(setup = batch::<Portable>)]
#[bench::baseline(args = (Vectors::Baseline), config = limit(1322.0, ACROBOTS))]
fn batch_portable(play: Play<Portable>) -> Play<Portable> {
    play_batch(play, false)
}

library_benchmark_group!(
    name = steps,
    benchmarks = [
        host,
        portable,
        fast,
        micro,
        batch_fast,
        batch_fast_with_observations,
        batch_portable
    ]
);
main!(library_benchmark_groups = steps);
