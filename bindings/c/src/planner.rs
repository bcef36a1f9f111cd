//! Plans of swing-ups.

use core::mem::transmute;

use acrobot::arithmetic::Damped;
use acrobot::control::{Cost, Knot, Planner};
use acrobot::numpy::Pcg64;
use acrobot::{Fast, State};

use crate::data::{acrobot_params_t, acrobot_state_t};
use crate::memory::{Holder, Span, array, change, check, check_apart, check_result, get, read};
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t, status};

pub const ACROBOT_PLANNER_SIZE: usize = 560;

#[repr(C, align(16))]
pub struct acrobot_planner_t {
    bytes: [u8; ACROBOT_PLANNER_SIZE],
}

impl Holder for acrobot_planner_t {
    type Value = Planner<Damped<Fast>>;

    const TAG: u32 = u32::from_le_bytes(*b"plan");
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
pub struct acrobot_cost_t {
    pub angles: [f32; 2],
    pub velocities: [f32; 2],
    pub torque: f32,
    pub torque_change: f32,
    pub power: f32,
    pub below: f32,
    pub height: f32,
    pub margin: f32,
    pub arrival: f32,
}

fn knots_of(
    planner: *const acrobot_planner_t,
    knots: *const acrobot_knot_t,
    count: usize,
) -> Result<*mut [Knot<f32>], Rejected> {
    // Both are `repr(C)` and have the same fields.
    const { assert!(size_of::<Knot<f32>>() == size_of::<acrobot_knot_t>()) };
    let knots = array(knots.cast_mut().cast(), count)?;
    check_apart(&[Span::new(planner, 1), Span::of(knots)])?;
    Ok(knots)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_default_cost(
    params: *const acrobot_params_t,
    limit: f32,
    cost: *mut acrobot_cost_t,
) -> acrobot_status_t {
    status(|| {
        check(cost)?;
        let weights = Cost::new(&read(params)?.try_into()?, limit)?;
        // SAFETY: both are `repr(C)` and have the same fields.
        cost.write(transmute::<Cost<f32>, acrobot_cost_t>(weights));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_planner_init(
    planner: *mut acrobot_planner_t,
    params: *const acrobot_params_t,
    limit: f32,
    cost: *const acrobot_cost_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    let init = || {
        let params = read(params)?.try_into()?;
        let cost = match cost.is_null() {
            true => Cost::new(&params, limit)?,
            // SAFETY: as above.
            false => transmute::<acrobot_cost_t, Cost<f32>>(read(cost)?),
        };
        Holder::init(planner, Planner::with_cost(params, limit, cost)?)
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
        Ok(value.plan(start, tries, &mut Pcg64::new(seed), &mut *knots)?.len())
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
pub unsafe extern "C" fn acrobot_planner_follow(
    planner: *const acrobot_planner_t,
    knots: *const acrobot_knot_t,
    length: usize,
    step: usize,
    state: *const acrobot_state_t,
    torque: *mut f32,
) -> acrobot_status_t {
    get(planner, torque, |value| {
        let knots = knots_of(planner, knots, length)?;
        let state = State::from(read(state)?);
        state.validate()?;
        Ok(value.follow(&*knots, step, state))
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_planner_decide(
    planner: *mut acrobot_planner_t,
    state: *const acrobot_state_t,
    torque: *mut f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(planner, torque, error, |value| {
        check(torque)?;
        Ok(value.decide(read(state)?.into())?)
    })
}
