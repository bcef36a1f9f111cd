//! The WebAssembly module of `acrobot-rs/control`: linear models, regulators and a planner.
//!
//! Parameters, weights and results pass through the words of `memory`, plans through memory of
//! their own. A function returns 0, or the kind of error, whose details are in the words.

use std::slice;

use acrobot::arithmetic::Damped;
use acrobot::control::{
    self, ControlError, Cost, Knot, LinearModel, Lqr, NoPlan, linearize_step, lqr,
};
use acrobot::numpy::Pcg64;
use acrobot::physics::Pendulum;
use acrobot::{Fast, Params, State};
use memory::{changed, keep, seed, set, set_numbers, text, zeros};

/// The first words of weights: those of a cost follow the parameters, those of a regulator a model.
const COST: usize = 19;
const WEIGHTS: usize = 20;

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

fn matrix(from: usize) -> [[f32; 4]; 4] {
    [0, 4, 8, 12].map(|row| numbers(from + row))
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
        Err(ControlError::NotInEquilibrium { rate }) => (7, "", [rate, 0.0]),
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

/// The numbers of a matrix by rows, then those of a vector.
fn flat(m: [[f32; 4]; 4], v: [f32; 4]) -> [f32; 20] {
    let [[a, b, c, d], [e, f, g, h], [i, j, k, l], [m, n, o, p]] = m;
    let [q, r, s, t] = v;
    [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t]
}

fn write_model(model: Result<LinearModel<f32>, ControlError>) -> u32 {
    write(model.map(|LinearModel { a, b }| flat(a, b)))
}

fn write_regulator(regulator: Result<Lqr<f32>, ControlError>) -> u32 {
    write(regulator.map(|Lqr { gain, cost_to_go }| flat(cost_to_go, gain)))
}

/// The pendulum with the parameters in the mask, in a state.
fn pendulum(mask: u32, state: [f32; 4]) -> Result<Pendulum<Damped<Fast>>, ControlError> {
    Ok(Pendulum::new(changed(Params::DEFAULT, mask), state.into())?)
}

#[unsafe(no_mangle)]
pub extern "C" fn linearize(mask: u32, torque: f32, a: f32, b: f32, c: f32, d: f32) -> u32 {
    let pendulum = pendulum(mask, [a, b, c, d]);
    write_model(pendulum.and_then(|pendulum| control::linearize(&pendulum, torque)))
}

#[unsafe(no_mangle)]
pub extern "C" fn linearize_one_step(
    mask: u32,
    torque: f32,
    a: f32,
    b: f32,
    c: f32,
    d: f32,
) -> u32 {
    let pendulum = pendulum(mask, [a, b, c, d]);
    write_model(pendulum.and_then(|pendulum| linearize_step(&pendulum, torque)))
}

/// The weights Q and R.
fn weights() -> ([[f32; 4]; 4], f32) {
    let [r] = numbers(WEIGHTS + 16);
    (matrix(WEIGHTS), r)
}

#[unsafe(no_mangle)]
pub extern "C" fn regulator(mask: u32, torque: f32, a: f32, b: f32, c: f32, d: f32) -> u32 {
    let (q, r) = weights();
    let pendulum = pendulum(mask, [a, b, c, d]);
    write_regulator(pendulum.and_then(|pendulum| control::regulator(&pendulum, torque, &q, r)))
}

#[unsafe(no_mangle)]
pub extern "C" fn regulator_of_model() -> u32 {
    let (q, r) = weights();
    write_regulator(lqr(&LinearModel { a: matrix(0), b: numbers(16) }, &q, r))
}

/// A planner with memory for a plan.
pub struct Planner {
    planner: control::Planner<Damped<Fast>>,
    knots: Vec<Knot<f32>>,
    /// The knots, as JavaScript reads and writes them.
    rows: Vec<Row>,
}

/// A knot's state, torque and gain.
type Row = [f32; 9];

fn row(knot: &Knot<f32>) -> Row {
    let State { theta1, theta2, dtheta1, dtheta2 } = knot.state;
    let [k1, k2, k3, k4] = knot.gain;
    [theta1, theta2, dtheta1, dtheta2, knot.torque, k1, k2, k3, k4]
}

fn knot([theta1, theta2, dtheta1, dtheta2, torque, gain @ ..]: Row) -> Knot<f32> {
    let mut knot = Knot::open(torque);
    knot.state = State { theta1, theta2, dtheta1, dtheta2 };
    knot.gain = gain;
    knot
}

/// The default weights, with those in the mask.
fn cost(params: &Params<f32>, mask: u32) -> Cost<f32> {
    let mut cost = Cost::new(params);
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
    for (i, (weight, given)) in weights.into_iter().zip(numbers::<11>(COST)).enumerate() {
        if mask >> (COST + i) & 1 != 0 {
            *weight = given;
        }
    }
    cost
}

/// Makes a planner with the parameters and weights in the mask. Writes its address, or 0 without
/// memory.
#[unsafe(no_mangle)]
pub extern "C" fn planner_new(mask: u32, limit: f32) -> u32 {
    let params = changed(Params::DEFAULT, mask);
    match control::Planner::with_cost(params, limit, cost(&params, mask)) {
        Ok(planner) => {
            let planner = keep(Planner { planner, knots: Vec::new(), rows: Vec::new() });
            set(&[planner.map_or(0, |planner| Box::into_raw(planner).addr() as u32)]);
            0
        }
        Err(error) => write::<0>(Err(error)),
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn planner_free(planner: Box<Planner>) {
    drop(planner);
}

/// Makes memory for a plan. Returns the address of its rows, or 0 without memory.
#[unsafe(no_mangle)]
pub extern "C" fn planner_rows(planner: &mut Planner, steps: usize) -> usize {
    // SAFETY: both are numbers.
    let (knots, rows) = unsafe { (zeros(steps), zeros(steps)) };
    let (Some(knots), Some(rows)) = (knots, rows) else {
        return 0;
    };
    (planner.knots, planner.rows) = (knots, rows);
    planner.rows.as_ptr().addr()
}

/// Plans with a seed of so many words. Writes the length of the plan, or returns 11 if it finds
/// none.
#[unsafe(no_mangle)]
pub extern "C" fn planner_plan(
    Planner { planner, knots, rows }: &mut Planner,
    words: usize,
    tries: u32,
    a: f32,
    b: f32,
    c: f32,
    d: f32,
) -> u32 {
    let mut rng = Pcg64::from(seed(words));
    match planner.plan([a, b, c, d].into(), tries, &mut rng, knots) {
        Ok(plan) => {
            rows.iter_mut().zip(&*plan).for_each(|(to, knot)| *to = row(knot));
            set(&[plan.len() as u32]);
            0
        }
        Err(NoPlan::Invalid(error)) => write::<0>(Err(error)),
        Err(NoPlan::NotFound { .. }) => 11,
    }
}

/// Improves the plan in the rows. Writes its cost.
#[unsafe(no_mangle)]
pub extern "C" fn planner_improve(
    Planner { planner, knots, rows }: &mut Planner,
    iterations: u32,
    a: f32,
    b: f32,
    c: f32,
    d: f32,
) -> u32 {
    knots.iter_mut().zip(&*rows).for_each(|(to, row)| *to = knot(*row));
    let cost = planner.improve([a, b, c, d].into(), iterations, knots);
    rows.iter_mut().zip(knots).for_each(|(to, knot)| *to = row(knot));
    write(cost.map(|cost| [cost]))
}

/// The torque that follows the row in the words, or that of the regulator after a plan.
#[unsafe(no_mangle)]
pub extern "C" fn planner_follow(
    planner: &Planner,
    is_planned: bool,
    a: f32,
    b: f32,
    c: f32,
    d: f32,
) -> f32 {
    let knot = knot(numbers(0));
    let plan = if is_planned { slice::from_ref(&knot) } else { &[] };
    planner.planner.follow(plan, 0, [a, b, c, d].into())
}

/// Writes the torque without a plan.
#[unsafe(no_mangle)]
pub extern "C" fn planner_decide(planner: &mut Planner, a: f32, b: f32, c: f32, d: f32) -> u32 {
    let torque = planner.planner.decide([a, b, c, d].into());
    write(torque.map(|torque| [torque]).map_err(ControlError::Invalid))
}
