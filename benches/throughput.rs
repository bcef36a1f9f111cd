//! Steps per second on one core, and their ratio to a bare loop, one line each: `name
//! steps_per_second ratio`.
//!
//! A batch plays a random policy. Its yardstick is a loop over eight lanes of AVX2 that neither
//! draws actions nor resets, with FMA (`batch_…`) and without (`batch_…_nofma`). The yardstick of
//! `scalar_fast` and `scalar_micro` has the same equations for one acrobot in f32, that of the
//! other `scalar_…` Gymnasium's order of operations in f64 and the platform's sines. That of
//! `linearize_…`, the derivatives of steps, is `Pendulum::linearize_step`. Each figure is the best
//! of several runs, interleaved with runs of the yardstick.
//!
//! ```text
//! cargo bench -p benches --bench throughput
//! ```

use std::hint::black_box;
use std::time::Instant;

use acrobot::arithmetic::{Arithmetic, Damped, Host, Micro, Real, Reference};
use acrobot::batch::{SimdLevel, VecBatch};
use acrobot::numpy::Pcg64;
use acrobot::physics::Pendulum;
use acrobot::task::{Swingup, Task};
use acrobot::{Acrobot, Action, Fast, Params, Portable, State, TimeLimit};
use benches::{Lanes, Play, bare_f32, bare_f64, measured};

fn main() {
    scalar::<Host>("scalar_host", bare_f64);
    scalar::<Reference>("scalar_reference", bare_f64);
    scalar::<Portable>("scalar_portable", bare_f64);
    scalar::<Fast>("scalar_fast", bare_f32);
    scalar::<Micro>("scalar_micro", bare_f32);
    for len in [1024, 1 << 20] {
        batch::<Fast>("fast", len, SimdLevel::widest());
    }
    let mut own = VecBatch::<Fast>::new(0, 1024).expect("memory for the batch");
    own.own_params().expect("memory for the batch");
    versus("batch_fast_1024_own_params", Play::from(own), Play::<Fast>::new(1024));
    let swingup = Play::<Damped<Fast>, Swingup>::new(1024);
    versus("batch_fast_1024_swingup", swingup, Play::<Fast>::new(1024));
    for level in [SimdLevel::widest(), SimdLevel::Avx2, SimdLevel::Baseline] {
        let measured = VecBatch::<Fast, _>::with_task(0, measured(), 1024);
        let mut measured = Play::from(measured.expect("memory for the batch"));
        let mut plain = Play::<Fast>::new(1024);
        measured.batch.set_simd_level(level);
        plain.batch.set_simd_level(level);
        versus(&format!("batch_fast_1024_measured {level:?}"), measured, plain);
    }
    for level in [SimdLevel::widest(), SimdLevel::Avx2, SimdLevel::Baseline] {
        linearize::<Fast>(&format!("linearize_fast_1024_own_params {level:?}"), level, false);
        linearize::<Fast>(&format!("linearize_fast_1024_by_params {level:?}"), level, true);
        linearize::<Portable>(
            &format!("linearize_portable_1024_own_params {level:?}"),
            level,
            false,
        );
    }
    batch::<Fast>("fast_avx2", 1024, SimdLevel::Avx2);
    batch::<Fast>("fast_baseline", 1024, SimdLevel::Baseline);
    batch::<Portable>("portable", 1024, SimdLevel::widest());
    batch::<Portable>("portable_avx2", 1024, SimdLevel::Avx2);
    batch::<Portable>("portable_baseline", 1024, SimdLevel::Baseline);
    batch::<Reference>("reference", 1024, SimdLevel::widest());
    threads(1 << 20);
}

const ROUNDS: usize = 7;

/// Prints the best rate of `ours`, and its ratio to that of `yardstick`, interleaved. Each returns
/// how many steps it took.
fn compare(name: &str, mut ours: impl FnMut() -> usize, mut yardstick: impl FnMut() -> usize) {
    let rate = |run: &mut dyn FnMut() -> usize| {
        let start = Instant::now();
        let steps = run();
        steps as f64 / start.elapsed().as_secs_f64()
    };
    let (best, bare) = (0..ROUNDS).fold((0.0, 0.0), |(best, bare), _| {
        (f64::max(best, rate(&mut ours)), f64::max(bare, rate(&mut yardstick)))
    });
    println!("{name} {best:.0} {:.2}", best / bare);
}

/// Derivatives of the steps of acrobots with own parameters, and of one pendulum again and again.
fn linearize<A: Arithmetic>(name: &str, level: SimdLevel, with_params: bool) {
    const COUNT: usize = 1024;
    let mut batch = VecBatch::<A>::new(0, COUNT).expect("memory for the batch");
    batch.own_params().expect("memory for the batch");
    batch.set_simd_level(level);
    let one = Pendulum::<A>::new(Params::<f64>::DEFAULT.cast(), State::UPRIGHT);
    let one = one.expect("valid parameters");
    let torque = A::Scalar::from_f64(0.5);
    let mut models = [one.linearize_step(torque).expect("finite derivatives"); COUNT];
    let mut by_params = [one.params().map(|_| [torque; 4]); COUNT];
    let ours = || {
        for _ in 0..50 {
            let by_params = with_params.then_some(&mut by_params[..]);
            let result =
                batch.linearize_step_into(&[black_box(torque); COUNT], &mut models, by_params);
            result.expect("finite derivatives");
        }
        50 * COUNT
    };
    let alone = || {
        for _ in 0..COUNT {
            black_box(one.linearize_step(black_box(torque)).expect("finite derivatives"));
        }
        COUNT
    };
    compare(name, ours, alone);
}

fn scalar<A: Arithmetic>(name: &str, yardstick: fn(&[Action])) {
    const STEPS: usize = 200_000;
    let mut rng = Pcg64::new(0);
    let actions: Vec<Action> = (0..STEPS).map(|_| Action::sample(&mut rng)).collect();
    let mut acrobot = TimeLimit::with_task_limit(Acrobot::<A>::new(0));
    let ours = || {
        for &action in &actions {
            if black_box(acrobot.step(action)).is_done() {
                acrobot.reset();
            }
        }
        STEPS
    };
    let bare = || {
        yardstick(&actions);
        STEPS
    };
    compare(name, ours, bare);
}

fn batch<A: Arithmetic>(arithmetic: &str, len: usize, level: SimdLevel) {
    let steps = (2_000_000 / len).max(2);
    let mut play = Play::<A>::new(len);
    if !level.is_available() {
        println!("batch_{arithmetic}_{len} needs {level:?}, which this machine does not have");
        return;
    }
    play.batch.set_simd_level(level);
    for (suffix, observe) in [("", false), ("_observations", true)] {
        let mut ours = || {
            for _ in 0..steps {
                play.play(observe);
            }
            steps * len
        };
        let name = format!("batch_{arithmetic}_{len}{suffix}");
        for (fma, flavour) in [(true, ""), (false, "_nofma")] {
            let name = format!("{name}{flavour}");
            match Lanes::new(fma) {
                Some(mut bare) => compare(&name, &mut ours, || bare.run()),
                None => println!("{name} has no yardstick, which needs AVX2 and FMA"),
            }
        }
    }
}

/// A batch with observations; the ratio is to another one.
fn versus<A: Arithmetic, T: Task>(
    name: &str,
    mut ours: Play<A, T>,
    mut other: Play<impl Arithmetic>,
) {
    compare(
        name,
        || (0..2000).map(|_| ours.play(true)).sum(),
        || (0..2000).map(|_| other.play(true)).sum(),
    );
}

/// Steps on all cores; the ratio is to the same steps on one core.
fn threads(len: usize) {
    let (mut many, mut one) = (Play::<Fast>::new(len), Play::<Fast>::new(len));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let name = format!("batch_fast_{len}_threads_{threads}");
    compare(&name, || many.step(false, true), || one.step(false, false));
}
