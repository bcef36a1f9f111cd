//! The WebAssembly module of `acrobot-rs/control`: linear models, regulators, a planner and
//! swinging up without one.
//!
//! All data except single numbers passes through the words of `memory`. A function returns 0, or
//! the kind of error, whose details are in the words.

use std::mem::transmute;
use std::slice;

use acrobot::arithmetic::Damped;
use acrobot::control::model::{LinearModel, StepModel};
use acrobot::control::plan::{Knot, Plan, Planner, Problem, SwingUp};
use acrobot::control::regulator::{Feedback, Lqr};
use acrobot::numpy::Pcg64;
use acrobot::physics::Pendulum;
use acrobot::{Error, Fast, Params, State};
use memory::{changed, keep, seed, set, set_numbers, text, zeros};

/// The first words of the weights of a cost or a regulator, after the parameters, of a cost's Q and
/// Qf, and of a state, after the longest seed. What follows a plan begins after its knot.
const WEIGHTS: usize = 22;
const MATRICES: usize = 31;
const STATE: usize = 64;
const AFTER: usize = 9;

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
fn pendulum(mask: u32) -> Result<Pendulum<Damped<Fast>>, Error> {
    Pendulum::new(changed(Params::DEFAULT, mask), state())
}

fn knot() -> Knot<f32> {
    let [a, b, c, d, torque, gain @ ..] = numbers::<9>(0);
    Knot::new([a, b, c, d], torque, gain)
}

/// Writes a result, and returns 0, or the kind of error. JavaScript composes the message, as with
/// `memory::reason`.
fn write<const N: usize>(result: Result<[f32; N], Error>) -> u32 {
    let (kind, name, values) = match result {
        Ok(values) => {
            set_numbers(values);
            return 0;
        }
        Err(Error::NotFinite { name, value }) => (4, name, [value, 0.0]),
        Err(Error::NotSymmetric { name, upper, lower }) => (5, name, [upper, lower]),
        Err(Error::NotSemidefinite { name, value }) => (6, name, [value, 0.0]),
        Err(Error::NotInEquilibrium { rate, .. }) => (7, "", [rate, 0.0]),
        Err(Error::NotStabilizable) => (8, "", [0.0; 2]),
        Err(Error::IllConditioned { error }) => (10, "", [error, 0.0]),
        Err(Error::NotDetectable) => (9, "", [0.0; 2]),
        Err(Error::NoPlan { .. }) => (11, "", [0.0; 2]),
        Err(error) => return memory::reason(Err(error)),
    };
    let [address, len] = text(name);
    let [value, other] = values.map(|value| (value as f32).to_bits());
    set(&[value, address, len, other]);
    kind
}

/// Writes a matrix by rows, then a vector.
fn write_matrix(result: Result<([[f32; 4]; 4], [f32; 4]), Error>) -> u32 {
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
    let model = pendulum(mask).and_then(|pendulum| match of_step {
        true => pendulum.linearize_step(torque).map(|StepModel { a, b }| (a, b)),
        false => pendulum.linearize(torque).map(|LinearModel { a, b }| (a, b)),
    });
    write_matrix(model)
}

/// Writes the cost of all steps and the gain of the regulator of a pendulum.
#[unsafe(no_mangle)]
pub extern "C" fn regulator(mask: u32, torque: f32) -> u32 {
    let q = [0, 4, 8, 12].map(|row| numbers(WEIGHTS + row));
    let [r] = numbers(WEIGHTS + 16);
    let regulator = pendulum(mask).and_then(|p| p.regulator(torque, &q, r));
    write_matrix(regulator.map(|Lqr { gain, cost_to_go }| (cost_to_go, gain)))
}

/// What JavaScript keeps.
#[expect(clippy::large_enum_variant, reason = "each is in a box")]
pub enum Kept {
    Planner(Planner<Damped<Fast>>, Vec<Knot<f32>>),
    SwingUp(SwingUp<Damped<Fast>>),
}

/// The problem to stand with an elbow angle, with the weights in the mask.
fn problem(params: Params<f32>, limit: f32, elbow: f32, mask: u32) -> Result<Problem<f32>, Error> {
    let mut problem = Problem::balance::<Damped<Fast>>(params, limit, elbow)?;
    let cost = &mut problem.cost;
    let [angle1, angle2] = &mut cost.angles;
    let weights = [
        angle1,
        angle2,
        &mut cost.torque,
        &mut cost.torque_change,
        &mut cost.power,
        &mut cost.below,
        &mut cost.height,
        &mut cost.margin,
        &mut cost.arrival,
    ];
    for (i, (weight, given)) in weights.into_iter().zip(numbers::<9>(WEIGHTS)).enumerate() {
        if mask >> i & 1 != 0 {
            *weight = given;
        }
    }
    cost.q = [0, 4, 8, 12].map(|row| numbers(MATRICES + row));
    cost.qf = [16, 20, 24, 28].map(|row| numbers(MATRICES + row));
    Ok(problem)
}

/// Writes the address of what JavaScript keeps, or 0 without memory.
fn made(kept: Result<Kept, Error>) -> u32 {
    match kept {
        Ok(kept) => {
            set(&[keep(kept).map_or(0, |kept| Box::into_raw(kept).addr() as u32)]);
            0
        }
        Err(error) => write::<0>(Err(error)),
    }
}

/// Makes a planner with the parameters in the mask and the weights in the other one.
#[unsafe(no_mangle)]
pub extern "C" fn make(mask: u32, weights: u32, limit: f32, elbow: f32) -> u32 {
    let problem = problem(changed(Params::DEFAULT, mask), limit, elbow, weights);
    let planner = problem.and_then(|problem| Planner::new(&problem));
    made(planner.map(|planner| Kept::Planner(planner, Vec::new())))
}

#[unsafe(no_mangle)]
pub extern "C" fn make_swing_up(mask: u32, limit: f32) -> u32 {
    made(SwingUp::new(changed(Params::DEFAULT, mask), limit).map(Kept::SwingUp))
}

#[unsafe(no_mangle)]
pub extern "C" fn kept_free(kept: Box<Kept>) {
    drop(kept);
}

/// Makes memory for a plan, if there is any.
#[unsafe(no_mangle)]
pub extern "C" fn resize(kept: &mut Kept, steps: usize) -> bool {
    // SAFETY: a knot has numbers only.
    let (Kept::Planner(_, knots), Some(new)) = (kept, unsafe { zeros(steps) }) else {
        return false;
    };
    *knots = new;
    true
}

#[unsafe(no_mangle)]
pub extern "C" fn read_knot(kept: &Kept, step: usize) {
    if let Kept::Planner(_, knots) = kept
        && let Some(Knot { state, torque, gain: [k1, k2, k3, k4], .. }) = knots.get(step)
    {
        let State { theta1, theta2, dtheta1, dtheta2 } = *state;
        set_numbers([theta1, theta2, dtheta1, dtheta2, *torque, *k1, *k2, *k3, *k4]);
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn set_knot(kept: &mut Kept, step: usize) {
    if let Kept::Planner(_, knots) = kept
        && let Some(place) = knots.get_mut(step)
    {
        *place = knot();
    }
}

/// Plans with a seed of so many words. Writes the length of the plan, or returns 11 if it finds
/// none.
#[unsafe(no_mangle)]
pub extern "C" fn plan(kept: &mut Kept, words: usize, tries: u32) -> u32 {
    let mut rng = Pcg64::from(seed(words));
    let Kept::Planner(planner, knots) = kept else { return 0 };
    match planner.plan_into(state(), tries, &mut rng, knots) {
        Ok(plan) => {
            set(&[plan.knots.len() as u32]);
            0
        }
        Err(error) => write::<0>(Err(error)),
    }
}

/// Improves the plan. Writes its cost.
#[unsafe(no_mangle)]
pub extern "C" fn improve(kept: &mut Kept, iterations: u32) -> u32 {
    let Kept::Planner(planner, knots) = kept else { return 0 };
    write(planner.improve(state(), iterations, knots).map(|cost| [cost]))
}

/// Writes what holds the target after a plan.
#[unsafe(no_mangle)]
pub extern "C" fn feedback(kept: &Kept) {
    if let Kept::Planner(planner, _) = kept {
        // SAFETY: a feedback has these numbers only.
        set_numbers(unsafe {
            transmute::<Feedback<f32>, [f32; 46]>(*planner.regulator().feedback())
        });
    }
}

/// The torque of the knot in the words, or that of the feedback after it.
#[unsafe(no_mangle)]
pub extern "C" fn plan_torque(is_planned: bool) -> f32 {
    let knot = knot();
    let knots = if is_planned { slice::from_ref(&knot) } else { &[] };
    // SAFETY: a feedback has these numbers only, and any are valid.
    let after = unsafe { transmute::<[f32; 46], Feedback<f32>>(numbers(AFTER)) };
    Plan { knots, after }.torque(0, state())
}

/// Writes the torque without a plan.
#[unsafe(no_mangle)]
pub extern "C" fn swing_up_torque(kept: &mut Kept) -> u32 {
    let Kept::SwingUp(swing_up) = kept else { return 0 };
    write(swing_up.torque(state()).map(|torque| [torque]))
}
