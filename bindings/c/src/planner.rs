//! Plans of swing-ups.

use core::mem::transmute;

use acrobot::control::{Cost, Knot, Planner};
use acrobot::numpy::Pcg64;
use acrobot::{Fast, State};

use crate::data::{acrobot_params_t, acrobot_state_t};
use crate::memory::{Holder, Span, array, change, check, check_apart, check_result, get, read};
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t, status};

/// Bytes of an acrobot_planner_t.
pub const ACROBOT_PLANNER_SIZE: usize = 384;

/// Plans swing-ups for one machine. Call acrobot_planner_init first. You may copy and move it.
#[repr(C, align(16))]
pub struct acrobot_planner_t {
    bytes: [u8; ACROBOT_PLANNER_SIZE],
}

impl Holder for acrobot_planner_t {
    type Value = Planner<Fast>;

    const TAG: u32 = u32::from_le_bytes(*b"plan");
}

/// A step of a plan. Zeros are one without a torque.
#[repr(C)]
pub struct acrobot_knot_t {
    /// The state before the step.
    pub state: acrobot_state_t,
    /// N m.
    pub torque: f32,
    /// What to add to the torque for each deviation from `state`, N m per rad and per rad/s.
    pub gain: acrobot_state_t,
    /// For the planner.
    pub workspace: [f32; 2],
}

/// The weights of what a plan costs, 0 or more: a larger one makes its term smaller.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_cost_t {
    /// Of 2 − 2 cos x, for the deviation x of each angle from upright, 1/s.
    pub angles: [f32; 2],
    /// Of θ̇1² and θ̇2², s/rad².
    pub velocities: [f32; 2],
    /// Of the squared torque, 1/((N m)² s).
    pub torque: f32,
    /// Of the squared change of the torque from step to step, 1/(N m)².
    pub torque_change: f32,
    /// Of the absolute value of the motor's power, 1/J.
    pub power: f32,
    /// Of the time that the tip is below `height`, 1/s.
    pub below: f32,
    /// A height of the tip above the fixed joint, m.
    pub height: f32,
    /// `below` costs half where the tip is so far below `height`, m; above 0.
    pub margin: f32,
    /// Of ln(1 + e), where e is 1 for an end that the regulator surely holds.
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

/// The default weights.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_default_cost(
    params: *const acrobot_params_t,
    cost: *mut acrobot_cost_t,
) -> acrobot_status_t {
    status(|| {
        check(cost)?;
        let weights = Cost::new(&read(params)?.try_into()?);
        // SAFETY: both are `repr(C)` and have the same fields.
        cost.write(transmute::<Cost<f32>, acrobot_cost_t>(weights));
        Ok(())
    })
}

/// For a machine with these parameters, whose `dt` is the time between two decisions, and a largest
/// torque, N m. No velocity of a plan reaches its bound. A null `cost` has the default weights.
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
            true => Cost::new(&params),
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

/// Plans until a plan ends where a regulator holds the acrobot upright. `length` receives its
/// number of knots, which are the first. `error` names the `tries` if so many find no plan.
/// Rejected calls may change knots.
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

/// Improves a plan, or the rest of one, by at most so many iterations: from the state `start` on.
/// `cost` receives what it costs.
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

/// The torque at a step of a plan, N m, and after it that of the regulator. Clamp it to that of
/// your motor.
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

/// The torque without a plan, N m, at most the largest. It pumps energy until the regulator holds.
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
