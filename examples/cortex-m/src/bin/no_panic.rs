//! Links only if no panicking branch is left: the panic handler calls a function that does not exist.
//! `cargo build --release --bin no_panic` is the whole test; there is nothing to run.
//!
//! `Trajectory::write_csv` is left out, for core's formatting of floats has branches that panic.

#![no_std]
#![no_main]

#[path = "../../../../tests/common/digest.rs"]
mod digest;
#[allow(dead_code, reason = "shared with what compares the weights")]
#[path = "../../../../tests/common/training.rs"]
mod training;

use core::hint::black_box;
use core::panic::PanicInfo;

use acrobot::{
    Acrobot, Action, Arithmetic, Autoreset, Batch, Block, Fast, Figure, Micro, Observations,
    Output, Params, Pcg64, Portable, Real, SeedSequence, StartBounds, State, Theme, TimeLimit,
    Trajectory,
};
use cortex_m_rt::entry;
use embedded_graphics::framebuffer::{Framebuffer, buffer_size};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::pixelcolor::raw::{BigEndian, RawU1};
use training::acrobot_task::{Preset, greedy, learn};

unsafe extern "C" {
    fn a_panicking_branch_is_left() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    unsafe { a_panicking_branch_is_left() }
}

#[entry]
fn main() -> ! {
    loop {
        everything::<Fast>();
        everything::<Micro>();
        everything::<Portable>();
        batch::<Fast>();
        batch::<Portable>();
        learner();
    }
}

/// What firmware can call, with arguments that the compiler cannot know.
fn everything<A: Arithmetic>() {
    let number = || A::Scalar::from_f64(black_box(0.5));
    let mut seeds = SeedSequence::from(black_box(42));
    for seed in seeds.spawn(black_box(2)) {
        let mut acrobot = TimeLimit::v1(Acrobot::<A>::new(seed));
        let mut trajectory = Trajectory::<A::Scalar, 8>::new();
        let inner = acrobot.inner_mut();
        let params = Params {
            torque_noise: number(),
            mass1: number(),
            ..Params::default()
        };
        let _ = black_box(inner.set_params(params));
        let _ = black_box(inner.set_state(State::from([(); 4].map(|()| number()))));
        if let Ok(bounds) = StartBounds::new(black_box(-0.2), black_box(0.2)) {
            black_box(acrobot.reset_within(bounds));
        }
        black_box(acrobot.reset_seeded(black_box(7)));
        let mut shown = Figure::new(acrobot.inner());
        let mut display = Display::new();
        let _ = shown.draw(&mut display, &Theme::MONOCHROME);
        black_box(display.data());
        for _ in 0..black_box(10) {
            let action = Action::sample(acrobot.inner_mut().rng_mut());
            black_box(trajectory.step(&mut acrobot, action));
            let _ = black_box(Action::try_from(black_box(3)));
            let _ = black_box(acrobot.step_torque(number()));
            let inner = acrobot.inner();
            black_box((
                inner.observation(),
                inner.energy(),
                inner.tip_height(),
                inner.mass_matrix(),
            ));
            let figure = Figure::new(inner).with_torque(black_box(1.0));
            let _ = figure.redraw(&shown, &mut display, &Theme::MONOCHROME);
            black_box(display.data());
            shown = figure;
        }
        trajectory.iter().for_each(|transition| {
            black_box(transition);
        });
    }
}

/// A batch whose last block is not full.
fn batch<A: Arithmetic>() {
    let blocks = [Block::EMPTY; 2];
    let generators = [Pcg64::UNSEEDED; 20];
    let Ok(mut batch) = Batch::<A, _, _>::new(black_box(42), blocks, generators) else {
        return;
    };
    batch.set_autoreset(Autoreset::SameStep);
    let actions = black_box([1_u8; 20]);
    let (mut rows, mut finals) = ([[0.0; 6]; 20], [[0.0; 6]; 20]);
    let mut column = [0.0; 20];
    for _ in 0..black_box(10) {
        let output = Output {
            rewards: &mut column,
            terminated: &mut [false; 20],
            truncated: &mut [false; 20],
            observations: Observations::Rows(&mut rows),
            final_observations: Observations::Rows(&mut finals),
        };
        let _ = black_box(batch.step(&actions, output));
        let _ = black_box(batch.reset_to(&black_box([State::default(); 20])));
        black_box((&rows, &finals, &column, batch.state(black_box(3))));
        if let Some(member) = batch.member(black_box(3)) {
            let _ = black_box(batch.set_member(black_box(4), member));
        }
    }
}

/// The learner of `learn`, which comes with the crate's examples.
fn learner() {
    let mut weights = black_box(training::UNTRAINED);
    let Ok(mut learner) = Preset::Fast.learner(training::EPISODES, &mut weights) else {
        return;
    };
    let (mut env, mut choices) = training::acrobot_task::training(black_box(42).into());
    black_box(learn(&mut learner, &mut env, &mut choices));
    black_box(greedy(&learner, &black_box(State::default())));
    black_box(training::digest(&learner));
}

type Display =
    Framebuffer<BinaryColor, RawU1, BigEndian, 128, 64, { buffer_size::<BinaryColor>(128, 64) }>;
