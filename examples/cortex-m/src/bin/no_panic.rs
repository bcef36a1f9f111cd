//! Links only if no panicking branch is left, because the panic handler calls a function that does
//! not exist. `cargo build --release --bin no_panic --features no_panic` is the whole test; nothing
//! runs. CI builds it with the oldest and the newest Rust, at opt-level 3, 2, "s" and "z".
//!
//! `Trajectory`'s `write_csv` and `rows` are not called: core's formatting of floats can panic.

#![no_std]
#![no_main]

use core::hint::black_box;
use core::num::NonZeroU32;
use core::panic::PanicInfo;

use acrobot::arithmetic::{Arithmetic, Damped, Micro, Real, Reference};
use acrobot::batch::{
    Autoreset, Batch, BatchMemory, Block, LaneParams, OwnParams, StepBuffers, Storage,
};
use acrobot::control::estimate::{Estimator, Noise, ParameterEstimator, ParameterStd};
use acrobot::control::identify::{Regression, Sample, calibrate, identify, prediction_error};
use acrobot::control::plan::{Knot, Planner, Problem, SwingUp};
use acrobot::control::regulator::{dlqe, dlqr, lqr, tvlqr};
use acrobot::numpy::{Pcg64, SeedSequence, integers, uniform};
use acrobot::physics::{Pendulum, wrap};
use acrobot::render::{Figure, Theme};
use acrobot::task::{Draw, Draws, Gymnasium, Measured, ResetBounds, Swingup, Task};
use acrobot::trajectory::Trajectory;
use acrobot::{Acrobot, Action, Error, Fast, Params, Portable, ResetOptions, State, TimeLimit};
use bits::oled::Display;
use bits::training;
use cortex_m_rt::entry;
use learners::Memory16;
use policy::Policy;
use rand_core::{Rng as _, SeedableRng as _};

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
        all_of::<Fast, Gymnasium>();
        pendulum::<Micro>(); // differs from `Fast` in its sines alone
        all_of::<Portable, Gymnasium>();
        all_of::<Reference, Gymnasium>();
        all_of::<Damped<Fast>, Swingup>();
        all_of::<Fast, Measured<Gymnasium>>();
        let (blocks, generators) = ([Block::EMPTY; 2], [Pcg64::UNSEEDED; 20]);
        let own = OwnParams::new([LaneParams::default(); 2]);
        batch::<Fast, Gymnasium, 20, 16>(BatchMemory { blocks, generators, own });
        numbers();
        learners();
        planner::<Fast>();
        planner::<Damped<Portable>>();
        estimator::<Damped<Fast>>();
        estimator::<Damped<Portable>>();
        identification();
        policy();
    }
}

fn all_of<A: Arithmetic, T: Task<Observation = [f32; 6]>>() {
    pendulum::<A>();
    control::<A>();
    environment::<A, T>();
    // Blocks of 16 lanes, the default, compile far longer, so only `main` has one.
    let (blocks, generators) = ([Block::EMPTY; 2], [Pcg64::UNSEEDED; 6]);
    batch::<A, T, 6, 4>(BatchMemory { blocks, generators, own: () });
}

/// A number that the compiler cannot know.
fn number<S: Real>() -> S {
    S::from_f64(black_box(0.5))
}

fn state<S: Real>() -> State<S> {
    [(); 4].map(|()| number()).into()
}

fn params<S: Real>() -> Params<S> {
    Params { torque_noise: number(), mass1: number(), ..Params::default() }
}

fn draws<S: Real>() -> Result<Draws<S>, Error> {
    let (mean, std, low, high) = (number(), number(), number(), number());
    Draws::new(Params {
        mass1: black_box(Draw::Normal { mean, std, low, high }),
        torque_noise: black_box(Draw::LogUniform { low, high }),
        ..Draws::FIXED
    })
}

fn pendulum<A: Arithmetic>() {
    let _ = black_box(Pendulum::<A>::new(params(), state()));
    let mut pendulum = Pendulum::<A>::hanging();
    for _ in 0..black_box(10) {
        let _ = black_box((
            pendulum.step(number()),
            pendulum.set_params(params()).map_err(|error| error.message()),
            pendulum.set_state(state()),
            pendulum.push([number(), number()]),
        ));
        black_box((
            pendulum.state(),
            pendulum.sin_cos(),
            pendulum.derivative(number()),
            pendulum.positions(),
            pendulum.energy(),
            pendulum.mass_matrix(),
            pendulum.tip_height(),
        ));
    }
    black_box(wrap::<A::Scalar>(number()));
}

fn control<A: Arithmetic>() {
    let Ok(pendulum) = Pendulum::<A>::new(params(), state()) else {
        return;
    };
    let weights = [(); 4].map(|()| [(); 4].map(|()| number()));
    let _ = black_box((
        pendulum.linearize(number()),
        pendulum.inverse_dynamics([number(), number()]),
        pendulum.regulator(number(), &weights, number()),
    ));
    let _ = black_box(pendulum.linearize(number()).map(|model| lqr(&model, &weights, number())));
    let Ok(model) = pendulum.linearize_step(number()) else {
        return;
    };
    let mut gains = [[number(); 4]; 2];
    let _ = black_box(tvlqr(&[model; 2], &weights, number(), &weights, &mut gains));
    if let Ok(filter) = black_box(dlqe(&model, &weights, [number(), number()])) {
        black_box(filter.correct([number(); 4], [number(), number()]));
    }
    if let Ok(regulator) = black_box(dlqr(&model, &weights, number())) {
        black_box(pendulum.state().deviation_from(state()));
        black_box(regulator.torque(pendulum.state().deviation_from(state())));
    }
}

/// An acrobot with a time limit, recorded and drawn.
fn environment<A: Arithmetic, T: Task>() {
    let mut seeds = SeedSequence::new(black_box(42));
    for seed in seeds.spawn(black_box(2)) {
        let mut acrobot = TimeLimit::with_task_limit(Acrobot::<A, T>::new(seed.clone()));
        let mut trajectory = Trajectory::<A::Scalar, 8>::new();
        let inner = acrobot.inner_mut();
        inner.set_task(black_box(*inner.task()));
        let _ = black_box((
            inner.set_memory(*inner.memory()),
            inner.set_params(params()),
            inner.set_state(state()),
            draws().and_then(|draws| inner.draw_params(&draws)),
        ));
        if let Ok(bounds) = ResetBounds::new(black_box(-0.2), black_box(0.2)) {
            black_box(bounds.draw(acrobot.inner_mut().rng_mut()));
            let (seed, bounds) = (Some(seed), Some(bounds));
            black_box(acrobot.reset_with(ResetOptions { seed, bounds }));
        }
        black_box(acrobot.reset_with_seed(black_box(7)));
        let mut shown = Figure::new(acrobot.inner());
        let mut display = Display::new();
        let _ = shown.draw(&mut display, &Theme::MONOCHROME);
        black_box(display.data());
        for _ in 0..black_box(10) {
            let action = Action::sample(acrobot.inner_mut().rng_mut());
            let _ = black_box((
                trajectory.step(&mut acrobot, action),
                trajectory.step_torque(&mut acrobot, number()),
                Action::try_from(black_box(3)),
                acrobot.step_torque(number()),
            ));
            let inner = acrobot.inner();
            black_box(inner.observation());
            let figure = Figure::new(inner).with_torque(black_box(1.0));
            let _ = figure.redraw(&shown, &mut display, &Theme::MONOCHROME);
            black_box(display.data());
            shown = figure;
        }
        for transition in trajectory.iter() {
            black_box(transition);
        }
    }
}

/// A batch whose last block is not full.
fn batch<A, T, const LEN: usize, const N: usize>(memory: impl Storage<A, N, T::Memory>)
where
    A: Arithmetic,
    T: Task<Observation = [f32; 6]>,
{
    let Ok(mut batch) = Batch::<A, _, T, N>::new(black_box(42), memory) else {
        return;
    };
    let (mut rows, mut finals) = ([[0.0; 6]; LEN], [[0.0; 6]; LEN]);
    let (mut rewards, mut terminated, mut truncated) = ([0.0; LEN], [false; LEN], [false; LEN]);
    for _ in 0..black_box(10) {
        batch.set_autoreset(black_box(Autoreset::Disabled));
        batch.set_task(black_box(*batch.task()));
        let _ = black_box((
            batch.memory(black_box(3)).and_then(|memory| batch.set_memory(black_box(4), memory)),
            batch.set_all_params(params()),
            batch.set_params(black_box(3), params()),
            draws().and_then(|draws| batch.set_draws(draws)),
        ));
        let actions = black_box([1_u8; LEN]);
        let torques = black_box([A::Scalar::ZERO; LEN]);
        let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated)
            .with_observations(&mut rows)
            .with_final_observations(&mut finals);
        let _ = black_box(if black_box(true) {
            batch.step_into(&actions, buffers)
        } else {
            batch.step_into(&torques, buffers)
        });
        black_box((&rewards, &terminated, &truncated, &rows, &finals));
        let _ = black_box((
            batch.observe(&mut rows),
            batch.reset_masked(&black_box([true; LEN]), ResetOptions::default()),
            batch.reset_to(&black_box([State::default(); LEN])),
            batch.set_state(black_box(3), state()),
        ));
        let _ = black_box((&rows, batch.state(black_box(3)), batch.is_done(black_box(3))));
        let _ = black_box((batch.params(black_box(3)), batch.elapsed_steps(black_box(3))));
        if let Ok(member) = batch.member(black_box(3)) {
            let _ = black_box(batch.set_member(black_box(4), member));
        }
        batch.reset();
        batch.reset_with_seed(black_box(7));
        black_box(batch.generators_mut());
    }
}

fn numbers() {
    let mut rng = Pcg64::new(black_box(42));
    black_box(uniform(&mut rng, black_box(-1.0), black_box(1.0)));
    if let Some(n) = NonZeroU32::new(black_box(3)) {
        black_box(integers(&mut rng, n));
    }
    let mut bytes = [0; 9];
    rng.fill_bytes(black_box(&mut bytes[..]));
    black_box((bytes, Pcg64::from_seed(black_box([7; 32]))));
    black_box(SeedSequence::from_words(&black_box([7; 9])));
}

fn learners() {
    let mut memory = black_box(Memory16::EMPTY);
    let (mut learner, mut env) = (training::learner(&mut memory), training::env());
    black_box(learner.learn(&mut env));
    black_box(learner.greedy(&black_box(State::default())));
    black_box(training::digest(&learner));
}

fn planner<A: Arithmetic>() {
    let mut memory = black_box([Knot::EMPTY; 20]);
    let mut rng = Pcg64::new(black_box(42));
    let Ok(mut problem) = Problem::balance::<A>(params(), number(), number()) else { return };
    problem.cost.torque_change = number();
    if let Ok(mut planner) = Planner::<A>::new(&problem) {
        let _ = black_box(planner.improve(state(), black_box(10), &mut memory));
        if let Ok(plan) = planner.plan_into(state(), black_box(10), &mut rng, &mut memory) {
            black_box(plan.torque(black_box(3), state()));
        }
        black_box(planner.regulator().holds_from(state()));
    }
    if let Ok(mut swing_up) = SwingUp::<A>::new(params(), number()) {
        let _ = black_box(swing_up.torque(state()));
    }
}

fn estimator<A: Arithmetic>() {
    let noise = Noise { angle_std: number(), torque_std: number() };
    let std = ParameterStd { mass1: number(), ..ParameterStd::default() };
    let machine = params().with_inertias_about_joints([number(), number()]);
    let machine = machine.with_rotor(number(), number());
    let mut of_state = Estimator::<A>::new(machine, noise);
    let mut of_params = ParameterEstimator::<A>::new(machine, std, noise);
    for _ in 0..black_box(10) {
        if let (Ok(of_state), Ok(of_params)) = (&mut of_state, &mut of_params) {
            let angles = [number(), number()];
            let _ = black_box((of_state.correct(angles), of_state.predict(number())));
            let _ = black_box((of_params.correct(angles), of_params.predict(number())));
            black_box((of_state.state(), of_params.state_std(), of_params.params()));
        }
    }
}

fn identification() {
    let samples = [Sample { angles: [number(); 2], torques: [number(); 2] }; 20];
    let mut regression = Regression::EMPTY;
    let (half, window) = (black_box(1), black_box(2));
    let _ = black_box(regression.add(black_box(&samples), number(), number(), half, window));
    let _ = black_box(regression.fit().params(params()));
    let found = identify(&[black_box(&samples)], params());
    let calibrated = calibrate(black_box(&samples), params());
    let horizon = black_box(3);
    let _ = black_box((found, calibrated, prediction_error(params(), &samples, horizon)));
}

/// A policy from a file that is read at run time.
fn policy() {
    static FILE: [u8; 1000] = [0; 1000];
    if let Ok(policy) = Policy::<64>::new(black_box(&FILE)) {
        let observation = black_box([0.0; 6]);
        let _ = black_box((policy.action(&observation), policy.torque(&observation)));
    }
}
