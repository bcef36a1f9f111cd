//! Plans, and swinging up without one.

use core::mem::transmute;

use acrobot::arithmetic::Damped;
use acrobot::control::plan::{Cost, Knot, Plan, Planner, Problem, SwingUp};
use acrobot::control::regulator::Feedback;
use acrobot::numpy::Pcg64;
use acrobot::{Fast, State};

use crate::data::{acrobot_params_t, acrobot_state_t};
use crate::memory::{Holder, Span, array, change, check, check_apart, check_result, get, read};
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t, status};

#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_cost_t {
    pub q: [[f32; 4]; 4],
    pub qf: [[f32; 4]; 4],
    pub angles: [f32; 2],
    pub torque: f32,
    pub torque_change: f32,
    pub power: f32,
    pub below: f32,
    pub height: f32,
    pub margin: f32,
    pub arrival: f32,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_problem_t {
    pub params: acrobot_params_t,
    pub limit: f32,
    pub target: acrobot_state_t,
    pub torque: f32,
    pub cost: acrobot_cost_t,
}

#[repr(C)]
pub struct acrobot_knot_t {
    pub state: acrobot_state_t,
    pub torque: f32,
    pub gain: acrobot_state_t,
    pub workspace: [f32; 2],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_region_t {
    pub gain: acrobot_state_t,
    pub factor: [[f32; 4]; 4],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_feedback_t {
    pub target: acrobot_state_t,
    pub torque: f32,
    pub moving: acrobot_region_t,
    pub resting: acrobot_region_t,
    pub reach: f32,
}

pub const ACROBOT_PLANNER_SIZE: usize = 752;

#[repr(C, align(16))]
pub struct acrobot_planner_t {
    bytes: [u8; ACROBOT_PLANNER_SIZE],
}

impl Holder for acrobot_planner_t {
    type Value = Planner<Damped<Fast>>;

    const TAG: u32 = u32::from_le_bytes(*b"plan");
}

pub const ACROBOT_SWING_UP_SIZE: usize = 496;

#[repr(C, align(16))]
pub struct acrobot_swing_up_t {
    bytes: [u8; ACROBOT_SWING_UP_SIZE],
}

impl Holder for acrobot_swing_up_t {
    type Value = SwingUp<Damped<Fast>>;

    const TAG: u32 = u32::from_le_bytes(*b"swup");
}

fn knots_of(
    planner: *const acrobot_planner_t,
    knots: *mut acrobot_knot_t,
    count: usize,
) -> Result<*mut [Knot<f32>], Rejected> {
    // Both are `repr(C)` and have the same fields.
    const { assert!(size_of::<Knot<f32>>() == size_of::<acrobot_knot_t>()) };
    let knots = array(knots.cast(), count)?;
    check_apart(&[Span::new(planner, 1), Span::of(knots)])?;
    Ok(knots)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_problem_init(
    problem: *mut acrobot_problem_t,
    params: *const acrobot_params_t,
    limit: f32,
    elbow: f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    let init = || {
        let params = read(params)?;
        let Problem { target, torque, cost, .. } =
            Problem::balance::<Damped<Fast>>(params.try_into()?, limit, elbow)?;
        // SAFETY: both are `repr(C)` and have the same fields.
        let cost = transmute::<Cost<f32>, acrobot_cost_t>(cost);
        problem.write(acrobot_problem_t { params, limit, target: target.into(), torque, cost });
        Ok(())
    };
    status(|| {
        check(problem)?;
        init().inspect_err(|rejected: &Rejected| rejected.explain(error))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_planner_init(
    planner: *mut acrobot_planner_t,
    problem: *const acrobot_problem_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    let init = || {
        let acrobot_problem_t { params, limit, target, torque, cost } = read(problem)?;
        // SAFETY: as above.
        let cost = transmute::<acrobot_cost_t, Cost<f32>>(cost);
        let (params, target) = (params.try_into()?, target.into());
        Holder::init(planner, Planner::new(&Problem { params, limit, target, torque, cost })?)
    };
    status(|| {
        check_result(error, planner)?;
        init().inspect_err(|rejected| rejected.explain(error))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_planner_plan(
    planner: *mut acrobot_planner_t,
    start: *const acrobot_state_t,
    tries: u32,
    seed: u64,
    knots: *mut acrobot_knot_t,
    count: usize,
    length: *mut usize,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(planner, length, error, |value| {
        check(length)?;
        let knots = knots_of(planner, knots, count)?;
        let start = read(start)?.into();
        Ok(value.plan_into(start, tries, &mut Pcg64::new(seed), &mut *knots)?.knots.len())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_planner_improve(
    planner: *mut acrobot_planner_t,
    start: *const acrobot_state_t,
    iterations: u32,
    knots: *mut acrobot_knot_t,
    length: usize,
    cost: *mut f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(planner, cost, error, |value| {
        check(cost)?;
        let knots = knots_of(planner, knots, length)?;
        Ok(value.improve(read(start)?.into(), iterations, &mut *knots)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_planner_feedback(
    planner: *const acrobot_planner_t,
    feedback: *mut acrobot_feedback_t,
) -> acrobot_status_t {
    get(planner, feedback, |value| {
        // SAFETY: both are `repr(C)` and have the same fields.
        Ok(transmute::<Feedback<f32>, acrobot_feedback_t>(*value.regulator().feedback()))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_planner_holds_from(
    planner: *const acrobot_planner_t,
    state: *const acrobot_state_t,
    holds: *mut bool,
) -> acrobot_status_t {
    get(planner, holds, |value| {
        let state = State::from(read(state)?);
        state.validate()?;
        Ok(value.regulator().holds_from(state))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_plan_torque(
    knots: *const acrobot_knot_t,
    length: usize,
    after: *const acrobot_feedback_t,
    step: usize,
    state: *const acrobot_state_t,
    torque: *mut f32,
) -> acrobot_status_t {
    status(|| {
        check(torque)?;
        let knots = array(knots.cast::<Knot<f32>>().cast_mut(), length)?;
        // SAFETY: as above.
        let after = transmute::<acrobot_feedback_t, Feedback<f32>>(read(after)?);
        let state = State::from(read(state)?);
        state.validate()?;
        torque.write(Plan { knots: &*knots, after }.torque(step, state));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_swing_up_init(
    swing_up: *mut acrobot_swing_up_t,
    params: *const acrobot_params_t,
    limit: f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    let init = || Holder::init(swing_up, SwingUp::new(read(params)?.try_into()?, limit)?);
    status(|| {
        check_result(error, swing_up)?;
        init().inspect_err(|rejected: &Rejected| rejected.explain(error))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_swing_up_torque(
    swing_up: *mut acrobot_swing_up_t,
    state: *const acrobot_state_t,
    torque: *mut f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(swing_up, torque, error, |value| {
        check(torque)?;
        Ok(value.torque(read(state)?.into())?)
    })
}
