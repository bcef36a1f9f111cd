//! Plans.

use core::mem::transmute;
use core::ptr;

use acrobot::arithmetic::Damped;
use acrobot::control::plan::{Cost, Knot, Plan, Planner, Problem};
use acrobot::control::regulator::Feedback;
use acrobot::numpy::Pcg64;
use acrobot::{Error, Fast, State};

use crate::data::{acrobot_params_t, acrobot_state_t};
use crate::memory::{Holder, Span, array, change, check, check_apart, get, init, read};
use crate::model::compute;
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t};

/// The weights of what a plan costs, 0 or more: a larger one makes its term smaller. The defaults
/// are those of acrobot_problem_init: u is the largest torque, and T² the inertia of the straight
/// machine about the fixed joint, divided by the sum of the torque of gravity when it is level and
/// u.
// derive.py writes the fields.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_cost_t {
    /// Q of xᵀ Q x, for the deviation x from the target, by rows: 1/(rad² s), 1/rad² and s/rad²;
    /// symmetric and positive semidefinite. Default 0.
    pub q: [[f32; 4]; 4],
    /// The same of the state after the plan: 1/rad², s/rad² and s²/rad². Default 0.
    pub qf: [[f32; 4]; 4],
    /// Of 2 − 2 cos x, for the deviation x of each angle from the target, 1/s: of x² where it is
    /// small. Default 0.
    pub angles: [f32; 2],
    /// R: of the square of the torque's difference from that which holds the target, 1/((N m)² s).
    /// Default 0.1 / (T u²).
    pub torque: f32,
    /// Of the square of the torque's change from one step to the next, 1/(N m)². Default 0.
    pub torque_change: f32,
    /// Of the absolute value of the motor's power, 1/J. Default 0.
    pub power: f32,
    /// Of the time that the tip is below `height`, 1/s. Default 0.4 / T.
    pub below: f32,
    /// The height of the tip above the fixed joint, m, from which on `below` costs nothing. Default
    /// that of the target.
    pub height: f32,
    /// `below` costs half where the tip is so far below `height`, m; above 0. Default a tenth of
    /// both lengths.
    pub margin: f32,
    /// Of ln(1 + e) for the state after the plan, where e is 1 at the border of the region in which
    /// the regulator holds. Default 20.
    pub arrival: f32,
}

/// A machine, where it is to go, and what the way there costs.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_problem_t {
    /// `dt` is the time between two decisions.
    pub params: acrobot_params_t,
    /// The largest torque, N m.
    pub limit: f32,
    /// The equilibrium in which a plan ends, and the torque that holds it, N m.
    pub target: acrobot_state_t,
    pub torque: f32,
    pub cost: acrobot_cost_t,
}

/// A step of a plan. Zeros are one without a torque.
#[repr(C)]
pub struct acrobot_knot_t {
    /// The state before the step.
    pub state: acrobot_state_t,
    /// N m.
    pub torque: f32,
    /// K of torque − K x for the deviation x from `state`, N m per rad and per rad/s.
    pub gain: acrobot_state_t,
    /// For the planner.
    pub workspace: [f32; 2],
}

/// A gain, and the region in which its torque lasts.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_region_t {
    /// K of −K x for a deviation x, N m per rad and per rad/s.
    pub gain: acrobot_state_t,
    /// F by rows: x is in the region if |F x| is below 1.
    pub factor: [[f32; 4]; 4],
}

/// What holds the target after a plan. It can be a constant.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_feedback_t {
    pub target: acrobot_state_t,
    /// The torque that holds the target, N m.
    pub torque: f32,
    /// The gain in motion, and at rest, which is used where |F x|² is below `reach`.
    pub moving: acrobot_region_t,
    pub resting: acrobot_region_t,
    pub reach: f32,
}

/// Bytes of an acrobot_planner_t.
pub const ACROBOT_PLANNER_SIZE: usize = 752;

/// Plans motions of one machine. Call acrobot_planner_init first. You may copy and move it.
#[repr(C, align(16))]
pub struct acrobot_planner_t {
    bytes: [u8; ACROBOT_PLANNER_SIZE],
}

impl Holder for acrobot_planner_t {
    type Value = Planner<Damped<Fast>>;

    const TAG: u32 = u32::from_le_bytes(*b"plan");
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

/// The problem to stand with an `elbow` angle, rad, for a largest torque, N m: 0 is a swing-up. It
/// has the default weights, which follow from the size of the machine. Then you may change them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_problem_init(
    problem: *mut acrobot_problem_t,
    params: *const acrobot_params_t,
    limit: f32,
    elbow: f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(problem, error, || {
        let params = read(params)?;
        let Problem { target, torque, cost, .. } =
            Problem::balance::<Damped<Fast>>(params.try_into()?, limit, elbow)?;
        // SAFETY: both are `repr(C)` and have the same fields.
        let cost = transmute::<Cost<f32>, acrobot_cost_t>(cost);
        Ok(acrobot_problem_t { params, limit, target: target.into(), torque, cost })
    })
}

/// No velocity of a plan reaches its bound.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_planner_init(
    planner: *mut acrobot_planner_t,
    problem: *const acrobot_problem_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    init(planner, error, || {
        let acrobot_problem_t { params, limit, target, torque, cost } = read(problem)?;
        // SAFETY: as above.
        let cost = transmute::<acrobot_cost_t, Cost<f32>>(cost);
        let (params, target) = (params.try_into()?, target.into());
        Ok(Planner::new(&Problem { params, limit, target, torque, cost })?)
    })
}

/// Changes a planner to plan for a simulation that clamps velocities at the bounds of its
/// parameters, as Gymnasium's does. Plans may use that as a brake.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_planner_with_velocity_clamp(
    planner: *mut acrobot_planner_t,
) -> acrobot_status_t {
    change(planner, ptr::null_mut(), ptr::null_mut(), |value| {
        *value = value.clone().with_velocity_clamp();
        Ok(())
    })
}

/// Plans until a plan ends where the regulator holds the target. `length` receives its number of
/// knots, which are the first. `error` names the `tries` if so many find no plan. Rejected calls
/// may change knots.
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

/// Improves a plan, or the rest of one, by at most so many iterations: from the state `start` on.
/// `plan` stays as it is, so the machine may follow it meanwhile. `improved` receives the new plan,
/// and `cost` what it costs. Rejected calls may change `improved`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_planner_improve(
    planner: *mut acrobot_planner_t,
    start: *const acrobot_state_t,
    iterations: u32,
    plan: *const acrobot_knot_t,
    improved: *mut acrobot_knot_t,
    length: usize,
    cost: *mut f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(planner, cost, error, |value| {
        check(cost)?;
        let plan = knots_of(planner, plan.cast_mut(), length)?;
        let improved = knots_of(planner, improved, length)?;
        check_apart(&[Span::of(plan), Span::of(improved)])?;
        let start = read(start)?.into();
        improved.cast::<Knot<f32>>().copy_from_nonoverlapping(plan.cast(), length);
        Ok(value.improve(start, iterations, &mut *improved)?)
    })
}

/// What holds the target after each plan.
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

/// Whether this feedback, with the largest torque, takes the machine from a state to the target.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_planner_holds_from(
    planner: *const acrobot_planner_t,
    state: *const acrobot_state_t,
    holds: *mut bool,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(planner.cast_mut(), holds, error, |value| {
        check(holds)?;
        let state = State::from(read(state)?);
        state.validate()?;
        Ok(value.regulator().holds_from(state))
    })
}

/// The torque at a step of a plan, N m, and after it that of the feedback. Clamp it to that of your
/// motor. It needs no planner, so knots and feedback may be constants.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_plan_torque(
    knots: *const acrobot_knot_t,
    length: usize,
    after: *const acrobot_feedback_t,
    step: usize,
    state: *const acrobot_state_t,
    torque: *mut f32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(torque, error, || {
        let knots = array(knots.cast::<Knot<f32>>().cast_mut(), length)?;
        // SAFETY: as above.
        let after = transmute::<acrobot_feedback_t, Feedback<f32>>(read(after)?);
        let state = State::from(read(state)?);
        state.validate()?;
        let torque = Plan { knots: &*knots, after }.torque(step, state);
        match torque.is_finite() {
            true => Ok(torque),
            false => Err(Error::NotFinite { name: "torque", value: torque.into() }.into()),
        }
    })
}
