//! Steps per second on one core, and their ratio to a bare loop, one line each: `name steps_per_second ratio`.
//!
//! A batch plays a random policy, and draws actions and resets episodes in the loop. Its yardstick is a handwritten
//! loop over eight lanes of AVX2 that does neither, with FMA (`batch_…`) and without (`batch_…_nofma`). The yardstick
//! of `scalar_fast` and `scalar_micro` is the same equations for one acrobot in f32. That of the others alone is
//! Gymnasium's order in f64 with the platform's sines. Both play the same actions as the crate. Each
//! figure is the best of several runs, interleaved with runs of the yardstick.
//!
//! ```text
//! cargo run --release --example throughput
//! ```

#[path = "../common/exit.rs"]
mod exit;
pub mod yardsticks;

use std::hint::black_box;
use std::io::{self, Write};
use std::process::ExitCode;
use std::time::Instant;

use acrobot::arithmetic::{Arithmetic, Host, Micro, Reference};
use acrobot::batch::{Batch, Block, Observations, SimdLevel, StepBuffers};
use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Action, Error, Fast, Portable, TimeLimit};
use yardsticks::{bare_f32, bare_f64};

pub fn main() -> ExitCode {
    exit::status(measure())
}

fn measure() -> io::Result<()> {
    scalar::<Host>("scalar_host", bare_f64)?;
    scalar::<Reference>("scalar_reference", bare_f64)?;
    scalar::<Portable>("scalar_portable", bare_f64)?;
    scalar::<Fast>("scalar_fast", bare_f32)?;
    scalar::<Micro>("scalar_micro", bare_f32)?;
    for len in [1024, 1 << 20] {
        batch::<Fast>("fast", len, SimdLevel::widest())?;
    }
    batch::<Fast>("fast_avx2", 1024, SimdLevel::Avx2)?;
    batch::<Fast>("fast_baseline", 1024, SimdLevel::Baseline)?;
    batch::<Portable>("portable", 1024, SimdLevel::Baseline)?;
    threads(1 << 20)
}

const ROUNDS: usize = 7;

/// The best rates of `ours` and `yardstick`, interleaved. Each returns how many steps it took.
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

fn report(name: &str, (rate, yardstick): (f64, f64)) -> io::Result<()> {
    writeln!(io::stdout(), "{name} {rate:.0} {:.2}", rate / yardstick)
}

fn scalar<A: Arithmetic>(name: &str, yardstick: fn(&[Action])) -> io::Result<()> {
    const STEPS: usize = 200_000;
    let mut rng = Pcg64::new(0);
    let actions: Vec<Action> = (0..STEPS).map(|_| Action::sample(&mut rng)).collect();
    let mut acrobot = TimeLimit::v1(Acrobot::<A>::new(0));
    let ours = || {
        for &action in &actions {
            if black_box(acrobot.step(action)).done() {
                acrobot.reset();
            }
        }
        STEPS
    };
    let bare = || {
        yardstick(&actions);
        STEPS
    };
    report(name, compare(ours, bare))
}

/// A batch, the random policy that plays it, and the buffers of its steps.
#[derive(Debug)]
pub struct Play<A: Arithmetic> {
    pub batch: Batch<A, Vec<Block<A::Scalar>>, Vec<Pcg64>>,
    streams: Vec<u32>,
    actions: Vec<u8>,
    rewards: Vec<f32>,
    terminated: Vec<bool>,
    truncated: Vec<bool>,
    rows: Vec<[f32; 6]>,
}

type Step<A> = fn(
    &mut Batch<A, Vec<Block<<A as Arithmetic>::Scalar>>, Vec<Pcg64>>,
    &[u8],
    StepBuffers<'_>,
) -> Result<(), Error>;

impl<A: Arithmetic> Play<A> {
    pub fn new(len: usize) -> Self {
        let blocks = vec![Block::EMPTY; len.div_ceil(Block::<A::Scalar>::LANES)];
        let generators = vec![Pcg64::UNSEEDED; len];
        Self {
            batch: Batch::new(0, blocks, generators).expect("a block for each 16 generators"),
            streams: (0..len as u32)
                .map(|i| i.wrapping_mul(0x9e37_79b9))
                .collect(),
            actions: vec![0; len],
            rewards: vec![0.0; len],
            terminated: vec![false; len],
            truncated: vec![false; len],
            rows: vec![[0.0; 6]; len],
        }
    }

    pub fn draw_actions(&mut self) {
        for (stream, action) in self.streams.iter_mut().zip(&mut self.actions) {
            *stream = stream.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *action = (((*stream >> 16) * 3) >> 16) as u8;
        }
    }

    /// Steps with `step`. Returns the number of acrobots.
    pub fn step(&mut self, observe: bool, step: Step<A>) -> usize {
        let buffers = StepBuffers {
            rewards: &mut self.rewards,
            terminated: &mut self.terminated,
            truncated: &mut self.truncated,
            observations: match observe {
                true => Observations::Rows(&mut self.rows),
                false => Observations::None,
            },
            final_observations: Observations::None,
        };
        step(&mut self.batch, &self.actions, buffers).expect("slices of the batch's length");
        self.batch.len()
    }
}

fn batch<A: Arithmetic>(arithmetic: &str, len: usize, level: SimdLevel) -> io::Result<()> {
    let steps = (2_000_000 / len).max(2);
    let mut play = Play::<A>::new(len);
    if !level.is_available() {
        return writeln!(
            io::stdout(),
            "batch_{arithmetic}_{len} needs {level:?}, which this machine does not have"
        );
    }
    play.batch.set_simd_level(level);
    for (suffix, observe) in [("", false), ("_observations", true)] {
        let mut ours = || {
            for _ in 0..steps {
                play.draw_actions();
                play.step(observe, Batch::step);
            }
            steps * len
        };
        let name = format!("batch_{arithmetic}_{len}{suffix}");
        for (fma, flavour) in [(true, ""), (false, "_nofma")] {
            let name = format!("{name}{flavour}");
            match yardsticks::Lanes::new(fma) {
                Some(mut bare) => report(&name, compare(&mut ours, || bare.run()))?,
                None => writeln!(
                    io::stdout(),
                    "{name} has no yardstick, because that needs AVX2 and FMA"
                )?,
            }
        }
    }
    Ok(())
}

/// Steps on all cores; the ratio is to the same steps on one core. The actions stay the same, because only the step
/// runs on all cores.
fn threads(len: usize) -> io::Result<()> {
    let (mut many, mut one) = (Play::<Fast>::new(len), Play::<Fast>::new(len));
    let rates = compare(
        || many.step(false, Batch::par_step),
        || one.step(false, Batch::step),
    );
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    report(&format!("batch_fast_{len}_threads_{threads}"), rates)
}
