//! The WebAssembly module of `acrobot-rs/control`: linear models, regulators and a planner.
//!
//! All data except single numbers passes through the words of `memory`. A function returns 0, or
//! the kind of error, whose details are in the words.

use std::slice;

use acrobot::arithmetic::Damped;
use acrobot::control::{
    self, ControlError, Cost, Knot, LinearModel, Lqr, NoPlan, linearize, linearize_step,
};
use acrobot::numpy::Pcg64;
use acrobot::physics::Pendulum;
use acrobot::{Fast, Params, State};
use memory::{changed, keep, seed, set, set_numbers, text, zeros};

/// The first words of the weights of a cost or a regulator, after the parameters, and of a state,
/// after the longest seed.
const WEIGHTS: usize = 22;
const STATE: usize = 64;

#[unsafe(no_mangle)]
pub extern "C" fn param_names() {
    memory::set_param_names();
}

/// What JavaScript has written from a word on.
fn numbers<const N: usize>(from: usize) -> [f32; N] {
    let numbers = memory::numbers();
    let rest = numbers.get(from..).and_then(<[f32]>::first_chunk);
    rest.copied().unwrap_or([0.0; N])
}

fn state() -> State<f32> {
    numbers(STATE).into()
}

/// The pendulum with the parameters in the mask.
fn pendulum(mask: u32) -> Result<Pendulum<Damped<Fast>>, ControlError> {
    Ok(Pendulum::new(changed(Params::DEFAULT, mask), state())?)
}

fn knot() -> Knot<f32> {
    let [a, b, c, d, torque, gain @ ..] = numbers::<9>(0);
    let mut knot = Knot::open(torque);
    (knot.state, knot.gain) = ([a, b, c, d].into(), gain);
    knot
}

/// Writes a result, and returns 0, or the kind of error. JavaScript composes the message, as with
/// `memory::reason`.
fn write<const N: usize>(result: Result<[f32; N], ControlError>) -> u32 {
    let (kind, name, values) = match result {
        Ok(values) => {
            set_numbers(values);
            return 0;
        }
        Err(ControlError::Invalid(error)) => return memory::reason(Err(error)),
        Err(ControlError::NotFinite { name, value }) => (4, name, [value, 0.0]),
        Err(ControlError::NotSymmetric { name, upper, lower }) => (5, name, [upper, lower]),
        Err(ControlError::NotSemidefinite { name, value }) => (6, name, [value, 0.0]),
        Err(ControlError::NotInEquilibrium { rate, largest }) => (7, "", [rate, largest]),
        Err(ControlError::NotStabilizable) => (8, "", [0.0; 2]),
        Err(ControlError::IllConditioned { error }) => (10, "", [error, 0.0]),
        // `NotDetectable`: the crate has no other error.
        Err(_) => (9, "", [0.0; 2]),
    };
    let [address, len] = text(name);
    let [value, other] = values.map(|value| (value as f32).to_bits());
    set(&[value, address, len, other]);
    kind
}

/// Writes a matrix by rows, then a vector.
fn write_matrix(result: Result<([[f32; 4]; 4], [f32; 4]), ControlError>) -> u32 {
    write(result.map(|([a, b, c, d], vector)| {
        let mut numbers = [0.0; 20];
        let (rows, _) = numbers.as_chunks_mut();
        rows.copy_from_slice(&[a, b, c, d, vector]);
        numbers
    }))
}

/// Writes A and B of a pendulum: of a step, or of the equations of motion.
#[unsafe(no_mangle)]
pub extern "C" fn linear_model(mask: u32, torque: f32, of_step: bool) -> u32 {
    let linearize = if of_step { linearize_step } else { linearize };
    let model = pendulum(mask).and_then(|pendulum| linearize(&pendulum, torque));
    write_matrix(model.map(|LinearModel { a, b }| (a, b)))
}

/// Writes the cost of all steps and the gain of the regulator of a pendulum.
#[unsafe(no_mangle)]
pub extern "C" fn regulator(mask: u32, torque: f32) -> u32 {
    let q = [0, 4, 8, 12].map(|row| numbers(WEIGHTS + row));
    let [r] = numbers(WEIGHTS + 16);
    let regulator = pendulum(mask).and_then(|p| control::regulator(&p, torque, &q, r));
    write_matrix(regulator.map(|Lqr { gain, cost_to_go }| (cost_to_go, gain)))
}

pub struct Planner {
    planner: control::Planner<Damped<Fast>>,
    knots: Vec<Knot<f32>>,
}

/// The default weights, with those in the mask.
fn cost(params: &Params<f32>, limit: f32, mask: u32) -> Result<Cost<f32>, ControlError> {
    let mut cost = Cost::new(params, limit)?;
    let ([angle1, angle2], [velocity1, velocity2]) = (&mut cost.angles, &mut cost.velocities);
    let weights = [
        angle1,
        angle2,
        velocity1,
        velocity2,
        &mut cost.torque,
        &mut cost.torque_change,
        &mut cost.power,
        &mut cost.below,
        &mut cost.height,
        &mut cost.margin,
        &mut cost.arrival,
    ];
    for (i, (weight, given)) in weights.into_iter().zip(numbers::<11>(WEIGHTS)).enumerate() {
        if mask >> i & 1 != 0 {
            *weight = given;
        }
    }
    Ok(cost)
}

/// Makes a planner with the parameters in the mask and the weights in the other one. Writes its
/// address, or 0 without memory.
#[unsafe(no_mangle)]
pub extern "C" fn make(mask: u32, weights: u32, limit: f32) -> u32 {
    let params = changed(Params::DEFAULT, mask);
    let cost = cost(&params, limit, weights);
    match cost.and_then(|cost| control::Planner::with_cost(params, limit, cost)) {
        Ok(planner) => {
            let planner = keep(Planner { planner, knots: Vec::new() });
            set(&[planner.map_or(0, |planner| Box::into_raw(planner).addr() as u32)]);
            0
        }
        Err(error) => write::<0>(Err(error)),
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn kept_free(planner: Box<Planner>) {
    drop(planner);
}

/// Makes memory for a plan, if there is any.
#[unsafe(no_mangle)]
pub extern "C" fn resize(planner: &mut Planner, steps: usize) -> bool {
    // SAFETY: a knot has numbers only.
    let knots = unsafe { zeros(steps) };
    knots.map(|knots| planner.knots = knots).is_some()
}

#[unsafe(no_mangle)]
pub extern "C" fn read_knot(planner: &Planner, step: usize) {
    if let Some(Knot { state, torque, gain: [k1, k2, k3, k4], .. }) = planner.knots.get(step) {
        let State { theta1, theta2, dtheta1, dtheta2 } = *state;
        set_numbers([theta1, theta2, dtheta1, dtheta2, *torque, *k1, *k2, *k3, *k4]);
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn set_knot(planner: &mut Planner, step: usize) {
    if let Some(place) = planner.knots.get_mut(step) {
        *place = knot();
    }
}

/// Plans with a seed of so many words. Writes the length of the plan, or returns 11 if it finds
/// none.
#[unsafe(no_mangle)]
pub extern "C" fn plan(planner: &mut Planner, words: usize, tries: u32) -> u32 {
    let mut rng = Pcg64::from(seed(words));
    match planner.planner.plan(state(), tries, &mut rng, &mut planner.knots) {
        Ok(plan) => {
            set(&[plan.len() as u32]);
            0
        }
        Err(NoPlan::Invalid(error)) => write::<0>(Err(error)),
        Err(NoPlan::NotFound { .. }) => 11,
    }
}

/// Improves the plan. Writes its cost.
#[unsafe(no_mangle)]
pub extern "C" fn improve(planner: &mut Planner, iterations: u32) -> u32 {
    let cost = planner.planner.improve(state(), iterations, &mut planner.knots);
    write(cost.map(|cost| [cost]))
}

/// The torque that follows the knot in the words, or that of the regulator after a plan.
#[unsafe(no_mangle)]
pub extern "C" fn follow(planner: &Planner, is_planned: bool) -> f32 {
    let knot = knot();
    let plan = if is_planned { slice::from_ref(&knot) } else { &[] };
    planner.planner.follow(plan, 0, state())
}

/// Writes the torque without a plan.
#[unsafe(no_mangle)]
pub extern "C" fn decide(planner: &mut Planner) -> u32 {
    write(planner.planner.decide(state()).map(|torque| [torque]).map_err(ControlError::Invalid))
}
