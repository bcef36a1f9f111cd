//! Fixed episodes and batches, and a digest of every bit of each.

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::batch::{
    Autoreset, Batch, BatchMemory, Block, LaneParams, OwnParams, StepBuffers, Storage,
};
use acrobot::numpy::Pcg64;
use acrobot::task::{Draw, Draws, Gymnasium, Instruments, Measured, Task};
use acrobot::{Acrobot, Action, Fast, Params, State, TimeLimit};

use crate::{Digest, against};

/// Adds every bit of the state and of the observation.
pub fn add_seen<A: Arithmetic, T: Task>(
    digest: &mut Digest,
    acrobot: &Acrobot<A, T>,
    seen: T::Observation,
) {
    for x in <[A::Scalar; 4]>::from(acrobot.state()) {
        digest.add(x.to_f64().to_bits());
    }
    for x in seen.as_ref() {
        digest.add(x.to_bits().into());
    }
}

/// Every bit of one episode, from its initial state to its end, and of the next initial state. Even
/// episodes have random actions, odd ones torque against θ̇1.
fn episode<A: Arithmetic>(number: u64) -> u64 {
    let mut digest = Digest::default();
    let mut acrobot = TimeLimit::with_task_limit(Acrobot::<A>::new(number));
    let mut actions = Pcg64::new(number);
    add_seen(&mut digest, acrobot.inner(), acrobot.observation());
    loop {
        let action = if number.is_multiple_of(2) {
            Action::sample(&mut actions)
        } else {
            against(acrobot.state().dtheta1)
        };
        let step = acrobot.step(action);
        add_seen(&mut digest, acrobot.inner(), step.observation);
        digest.add(step.reward.to_bits().into());
        digest.add(u64::from(step.terminated) << 1 | u64::from(step.truncated));
        if step.is_done() {
            let start = acrobot.reset();
            add_seen(&mut digest, acrobot.inner(), start);
            return digest.0;
        }
    }
}

/// The digests of sixteen episodes in one.
pub fn sixteen<A: Arithmetic>() -> u64 {
    let mut digest = Digest::default();
    (0..16).for_each(|number| digest.add(episode::<A>(number)));
    digest.0
}

/// Torques so small that angles and velocities stay subnormal for 200 steps.
fn subnormal_torques<A: Arithmetic>(params: &mut Params<A::Scalar>) {
    let smallest_normal =
        if size_of::<A::Scalar>() == 4 { f64::from(f32::MIN_POSITIVE) } else { f64::MIN_POSITIVE };
    let torque = A::Scalar::from_f64(smallest_normal / 100.0);
    params.torques = [-torque, A::Scalar::ZERO, torque];
}

/// Every bit of 200 steps with subnormal numbers, which some FPUs flush to zero.
pub fn subnormal<A: Arithmetic>() -> u64 {
    steps(Acrobot::<A>::hanging(Pcg64::new(0)), subnormal_torques::<A>)
}

/// Every bit of 200 steps with friction.
pub fn damped<A: Arithmetic>() -> u64 {
    steps(Acrobot::<A>::new(0), |params| {
        [params.damping1, params.damping2] = [0.1, 0.05].map(A::Scalar::from_f64);
    })
}

/// Every bit of 200 steps of a task, with their rewards, from a state near upright and from one far
/// away.
pub fn task<A: Arithmetic, T: Task>() -> u64 {
    let mut digest = Digest::default();
    for start in [[3.0, 0.2, 0.0, 0.0], [0.5, 0.0, 0.0, 0.0]] {
        let mut acrobot = Acrobot::<A, T>::new(0);
        if acrobot.set_state(State::from(start).cast()).is_err() {
            return 0;
        }
        for _ in 0..100 {
            let step = acrobot.step(against(acrobot.state().dtheta1));
            add_seen(&mut digest, &acrobot, step.observation);
            digest.add(step.reward.to_bits().into());
        }
    }
    digest.0
}

/// Every bit of 200 steps against θ̇1 with changed parameters.
fn steps<A: Arithmetic>(mut acrobot: Acrobot<A>, change: impl Fn(&mut Params<A::Scalar>)) -> u64 {
    let mut params = *acrobot.params();
    change(&mut params);
    if acrobot.set_params(params).is_err() {
        return 0;
    }
    let mut digest = Digest::default();
    for _ in 0..200 {
        let step = acrobot.step(against(acrobot.state().dtheta1));
        add_seen(&mut digest, &acrobot, step.observation);
    }
    digest.0
}

/// Every bit that four batches return, which is the same for any width `N`. Each is a function out
/// of line, which frees its stack before the next, because RAM has 16 KiB.
pub fn batches<const N: usize, const BLOCKS_OF_20: usize, const BLOCKS_OF_8: usize>() -> [u64; 4] {
    [
        shared_params::<N, BLOCKS_OF_20>(),
        subnormal_batch::<N, BLOCKS_OF_20>(),
        own_params::<N, BLOCKS_OF_8>(),
        measured::<N, BLOCKS_OF_8>(),
    ]
}

/// A batch of twenty in `Fast` with the same parameters.
#[inline(never)]
pub fn shared_params<const N: usize, const BLOCKS: usize>() -> u64 {
    let (mut blocks, mut generators) = ([Block::EMPTY; BLOCKS], [Pcg64::UNSEEDED; 20]);
    let (blocks, generators) = (&mut blocks[..], &mut generators[..]);
    batch::<20, N, Gymnasium, _>(BatchMemory { blocks, generators, own: () }, |_| {})
}

/// As [`shared_params`] with subnormal numbers.
#[inline(never)]
fn subnormal_batch<const N: usize, const BLOCKS: usize>() -> u64 {
    let (mut blocks, mut generators) = ([Block::EMPTY; BLOCKS], [Pcg64::UNSEEDED; 20]);
    let (blocks, generators) = (&mut blocks[..], &mut generators[..]);
    batch::<20, N, Gymnasium, _>(BatchMemory { blocks, generators, own: () }, |batch| {
        let mut params = Params::DEFAULT;
        subnormal_torques::<Fast>(&mut params);
        // Neither fails: a failure changes the digest.
        let _ = batch.set_all_params(params);
        let _ = batch.reset_to(&[State::HANGING; 20]);
    })
}

/// As [`shared_params`] for eight, of which each reset draws parameters.
#[inline(never)]
fn own_params<const N: usize, const BLOCKS: usize>() -> u64 {
    let draws = Draws::new(Params {
        mass1: Draw::LogUniform { low: 0.9, high: 1.1 },
        inertia2: Draw::Uniform { low: 0.9, high: 1.1 },
        gravity: Draw::Normal { mean: 9.8, std: 0.5, low: 9.0, high: 10.0 },
        torque_noise: Draw::Uniform { low: 0.0, high: 0.1 },
        ..Draws::FIXED
    });
    let (mut blocks, mut generators) = ([Block::EMPTY; BLOCKS], [Pcg64::UNSEEDED; 8]);
    let mut own = [LaneParams::default(); BLOCKS];
    let (blocks, generators) = (&mut blocks[..], &mut generators[..]);
    let memory = BatchMemory { blocks, generators, own: OwnParams::new(&mut own[..]) };
    batch::<8, N, Gymnasium, _>(memory, |batch| {
        // It does not fail: a failure changes the digest.
        let _ = draws.and_then(|draws| batch.set_draws(draws));
        batch.reset();
    })
}

/// A batch of eight in `Fast`, through a motor and sensors that each reset draws.
#[inline(never)]
fn measured<const N: usize, const BLOCKS: usize>() -> u64 {
    let uniform = |low, high| Some(Draw::Uniform { low, high });
    let instruments = Instruments {
        action_delay: uniform(0.0, 2.0),
        observation_delay: uniform(0.0, 2.0),
        motor_lag: Some(Draw::LogUniform { low: 0.01, high: 0.2 }),
        torque_error: Some(Draw::Normal { mean: 0.0, std: 0.1, low: -0.3, high: 0.3 }),
        angle_noise: uniform(0.0, 0.01),
        encoder_zero1: uniform(-0.05, 0.05),
        encoder_zero2: uniform(-0.05, 0.05),
        encoder_counts: Some(Draw::exactly(4096.0)),
        velocity_filter: uniform(0.0, 0.1),
    };
    let task = Measured::<_, 2>::new(Gymnasium, instruments);
    let (mut blocks, mut generators) = ([Block::EMPTY; BLOCKS], [Pcg64::UNSEEDED; 8]);
    let (blocks, generators) = (&mut blocks[..], &mut generators[..]);
    batch::<8, N, _, _>(BatchMemory { blocks, generators, own: () }, |batch| {
        // It does not fail: a failure changes the digest.
        let _ = task.map(|task| batch.set_task(task));
        batch.reset();
    })
}

/// Every bit that a batch returns in 200 steps under torque against θ̇1, which ends episodes.
fn batch<const LEN: usize, const N: usize, T, S>(
    memory: S,
    prepare: impl FnOnce(&mut Batch<Fast, S, T, N>),
) -> u64
where
    T: Task<Observation = [f32; 6]>,
    S: Storage<Fast, N, T::Memory>,
{
    let Ok(mut batch) = Batch::new(42, memory) else {
        return 0;
    };
    prepare(&mut batch);
    batch.set_autoreset(Autoreset::SameStep);
    let mut digest = Digest::default();
    let (mut rewards, mut terminated, mut truncated) = ([0.0; LEN], [false; LEN], [false; LEN]);
    let (mut rows, mut finals) = ([[0.0; 6]; LEN], [[0.0; 6]; LEN]);
    for _ in 0..200 {
        let actions = rows.map(|[.., dtheta1, _]| against(dtheta1));
        let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated)
            .with_observations(&mut rows)
            .with_final_observations(&mut finals);
        if batch.step_into(&actions, buffers).is_err() {
            return 0;
        }
        let seen = rows.iter().chain(&finals).flatten().chain(&rewards);
        seen.for_each(|x| digest.add(x.to_bits().into()));
        terminated.iter().for_each(|&x| digest.add(x.into()));
    }
    digest.0
}

pub const BATCHES: [u64; 4] = [
    0xeae8_bc44_fb2b_ab5e, // shared parameters
    0xcc78_d474_8108_4cf5, // subnormal numbers
    0x386b_bd46_1da1_e6cd, // own parameters
    0xbd12_ea2d_ae12_2f43, // a motor and sensors
];

pub const SUBNORMAL: [u64; 4] = [
    0x9042_c808_54ae_9aad,
    0x155b_5f68_7777_a84a,
    0x2460_ddd8_8094_68c1, // where angles are that small, sin x is x in both
    0x2460_ddd8_8094_68c1,
];

pub const DAMPED: [u64; 2] = [0xaa5b_ea28_3a02_5fe0, 0x02ab_1a17_374e_5871];

pub const SWINGUP: [u64; 2] = [0x22a6_0076_4bda_c4c0, 0x4329_8e9d_2663_2406];

pub const BALANCE: [u64; 2] = [0x7966_469b_cf83_61bb, 0x3c5d_97b5_d2a0_597e];

pub const REFERENCE: u64 = 0xbb7e_cdbb_174c_3b77;
pub const PORTABLE: u64 = 0xbc39_fafe_6c5c_432c;
pub const FAST: u64 = 0x273b_096c_8e81_c01c;
pub const MICRO: u64 = 0x9bf7_c576_2904_d031;
