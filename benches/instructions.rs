//! Counts the instructions of a step for CI. callgrind gives the same count in every run.
//!
//! ```text
//! cargo install --locked gungraun-runner@0.20.0    # and the system's valgrind
//! cargo bench -p benches --bench instructions
//! ```
//!
//! It fails if a count exceeds its limit: the measured count plus 5 % for new compilers. It needs
//! x86-64 with AVX2; valgrind does not support AVX-512.

use std::hint::black_box;

use acrobot::arithmetic::{Arithmetic, Micro, Reference};
use acrobot::batch::SimdLevel;
use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Fast, Portable, TimeLimit};
use benches::Play;
use gungraun::{
    Callgrind, EventKind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main,
};

/// About two episodes of a random policy, with their resets.
const STEPS: usize = 1000;
const ACROBOTS: usize = 64;

/// Limits each step of each acrobot to this many instructions.
fn limit(instructions: f64, acrobots: usize) -> LibraryBenchmarkConfig {
    let limit = (instructions * 1.05 * (acrobots * STEPS) as f64) as u64;
    let mut callgrind = Callgrind::with_args(["cache-sim=no"]);
    callgrind.hard_limits([(EventKind::Ir, limit)]);
    let mut config = LibraryBenchmarkConfig::default();
    config.tool(callgrind);
    config
}

type Alone<A> = (TimeLimit<Acrobot<A>>, Vec<Action>);

fn alone<A: Arithmetic>() -> Alone<A> {
    let mut rng = Pcg64::new(0);
    let actions = (0..STEPS).map(|_| Action::sample(&mut rng)).collect();
    (TimeLimit::of(Acrobot::new(0)), actions)
}

fn batch<A: Arithmetic>(level: SimdLevel) -> Play<A> {
    assert!(level.is_available(), "this machine has no {level:?}");
    let mut play = Play::new(ACROBOTS);
    play.batch.set_simd_level(level);
    play
}

#[inline(always)]
fn play_alone<A: Arithmetic>((mut acrobot, actions): Alone<A>) -> Alone<A> {
    for &action in &actions {
        if black_box(acrobot.step(action)).done() {
            acrobot.reset();
        }
    }
    (acrobot, actions)
}

#[inline(always)]
fn play_batch<A: Arithmetic>(mut play: Play<A>, observe: bool) -> Play<A> {
    for _ in 0..STEPS {
        play.play(observe);
    }
    play
}

#[library_benchmark(config = limit(1888.0, 1), setup = alone::<Reference>)]
fn reference(alone: Alone<Reference>) -> Alone<Reference> {
    play_alone(alone)
}

#[library_benchmark(config = limit(936.0, 1), setup = alone::<Portable>)]
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
#[bench::baseline(args = (SimdLevel::Baseline), config = limit(248.0, ACROBOTS))]
#[bench::avx2(args = (SimdLevel::Avx2), config = limit(113.0, ACROBOTS))]
fn batch_fast(play: Play<Fast>) -> Play<Fast> {
    play_batch(play, false)
}

#[library_benchmark(setup = batch::<Fast>)]
#[bench::baseline(args = (SimdLevel::Baseline), config = limit(265.0, ACROBOTS))]
#[bench::avx2(args = (SimdLevel::Avx2), config = limit(123.0, ACROBOTS))]
fn batch_fast_with_observations(play: Play<Fast>) -> Play<Fast> {
    play_batch(play, true)
}

#[library_benchmark(setup = batch::<Portable>)]
#[bench::baseline(args = (SimdLevel::Baseline), config = limit(824.0, ACROBOTS))]
#[bench::avx2(args = (SimdLevel::Avx2), config = limit(350.0, ACROBOTS))]
fn batch_portable(play: Play<Portable>) -> Play<Portable> {
    play_batch(play, false)
}

// It compiles as long as the others together, so CI counts it at night.
#[cfg(feature = "long")]
#[library_benchmark(setup = batch::<Reference>)]
#[bench::avx2(args = (SimdLevel::Avx2), config = limit(712.0, ACROBOTS))]
fn batch_reference(play: Play<Reference>) -> Play<Reference> {
    play_batch(play, false)
}

library_benchmark_group!(
    name = steps,
    benchmarks = [
        reference,
        portable,
        fast,
        micro,
        batch_fast,
        batch_fast_with_observations,
        batch_portable
    ]
);
#[cfg(feature = "long")]
library_benchmark_group!(name = long, benchmarks = [batch_reference]);
#[cfg(feature = "long")]
main!(library_benchmark_groups = [steps, long]);
#[cfg(not(feature = "long"))]
main!(library_benchmark_groups = steps);
