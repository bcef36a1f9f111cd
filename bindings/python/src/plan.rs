//! Plans of `acrobot_rs.control`, and what swings up without one.

use std::time::{Duration, Instant};

use acrobot::arithmetic::{Arithmetic, Damped, Real};
use acrobot::control::plan::{self, Cost, Knot, Plan, Problem};
use acrobot::control::regulator::{self, Feedback};
use acrobot::numpy::Pcg64;
use acrobot::physics::Pendulum;
use acrobot::{Error, Fast, Portable, State};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::batch::parse;
use crate::single::Acrobot;
use crate::{NAMES, Params, alone, held, invalid, named, rejected, wrong};

/// The tries between two calls of `progress`: a multiple of the ten lengths of a plan.
const PORTION: u32 = 40;

/// A state, a torque and gains.
type Row = [f32; 9];

type Matrix = [[f32; 4]; 4];

/// Replaces weights, in their order, by those that are given.
fn weigh<S: Real>(cost: &mut Cost<S>, given: &[Option<f64>]) {
    let Cost { q, qf, angles, torque, torque_change, power, below, height, margin, arrival } = cost;
    let numbers = [torque, torque_change, power, below, height, margin, arrival];
    let matrices = [q, qf].into_iter().flat_map(|rows| rows.as_flattened_mut());
    for (weight, given) in matrices.chain(angles).chain(numbers).zip(given) {
        *weight = given.map_or(*weight, S::from_f64);
    }
}

/// The parameters of an acrobot, if `f32` holds them.
fn machine(acrobot: &Bound<'_, Acrobot>) -> PyResult<Params> {
    let params = alone(acrobot)?.acrobot.params();
    let mut numbers = NAMES.into_iter().zip(params.numbers());
    numbers.try_for_each(|(name, (_, number))| held::<f32>(name, number).map(drop))?;
    Ok(params)
}

/// A result in `f32`. Its error is that of `f64`, if there is one, which shows the numbers before
/// they are rounded.
fn narrow<T, U>(
    narrow: impl FnOnce() -> Result<T, Error>,
    wide: impl FnOnce() -> Result<U, Error>,
) -> PyResult<T> {
    narrow().map_err(|error| {
        let error = wide().err().unwrap_or(error);
        match error.name().strip_prefix("the largest torque") {
            Some(rest) => named(error, format_args!("max_torque{rest}")),
            None => invalid(error, None),
        }
    })
}

fn planner<A: Arithmetic>(
    params: Params,
    [max_torque, elbow]: [f64; 2],
    target: Option<[f64; 4]>,
    weights: &[Option<f64>],
) -> Result<plan::Planner<A>, Error> {
    let (number, params) = (A::Scalar::from_f64, params.cast());
    let mut problem = Problem::balance::<A>(params, number(max_torque), number(elbow))?;
    if let Some(target) = target {
        problem.target = target.map(number).into();
        let rest = Pendulum::<A>::new(params, problem.target)?;
        [_, problem.torque] = rest.inverse_dynamics([A::Scalar::ZERO; 2])?.torques;
        problem.cost.height = rest.tip_height();
    }
    weigh(&mut problem.cost, weights);
    plan::Planner::new(&problem)
}

/// Plans motions to an equilibrium.
#[pyclass(module = "acrobot_rs._native")]
pub struct Planner {
    planner: plan::Planner<Damped<Fast>>,
    arguments: Py<PyTuple>,
}

#[pymethods]
impl Planner {
    #[new]
    fn new(
        acrobot: &Bound<'_, Acrobot>,
        max_torque: f64,
        elbow: f64,
        target: Option<[f64; 4]>,
        velocity_clamp: bool,
        weights: Vec<Option<f64>>,
    ) -> PyResult<Self> {
        let (params, numbers) = (machine(acrobot)?, [max_torque, elbow]);
        let planner = narrow(
            || planner::<Damped<Fast>>(params, numbers, target, &weights),
            || planner::<Damped<Portable>>(params, numbers, target, &weights),
        )?;
        let planner = if velocity_clamp { planner.with_velocity_clamp() } else { planner };
        let copy = alone(acrobot)?.clone();
        let arguments = (copy, max_torque, elbow, target, velocity_clamp, weights);
        let arguments = arguments.into_pyobject(acrobot.py())?.unbind();
        Ok(Self { planner, arguments })
    }

    /// Every protocol of pickle calls this, and `copy.deepcopy`.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<impl IntoPyObject<'py>> {
        Ok((slf.get_type(), alone(slf)?.arguments.clone_ref(slf.py())))
    }

    /// What holds the target after each plan.
    fn after(slf: &Bound<'_, Self>) -> PyResult<After> {
        let this = alone(slf)?;
        let Feedback { target, torque, moving, resting, reach } =
            *this.planner.regulator().feedback();
        let region = |regulator::Region { gain, factor }| (gain, factor);
        Ok((target.into(), torque, region(moving), region(resting), reach))
    }

    fn holds_from(slf: &Bound<'_, Self>, state: [f32; 4]) -> PyResult<bool> {
        Ok(alone(slf)?.planner.regulator().holds_from(state.into()))
    }

    fn plan(
        slf: &Bound<'_, Self>,
        state: [f32; 4],
        steps: u16,
        tries: u32,
        seed: Bound<'_, PyAny>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Vec<Row>> {
        let (py, mut rng) = (slf.py(), Pcg64::from(parse(seed)?));
        for done in (0..tries).step_by(PORTION as usize) {
            let portion = PORTION.min(tries - done);
            let found = {
                let planner = &mut alone(slf)?.planner; // `progress` may use it, too
                py.detach(|| planner.plan(state.into(), portion, &mut rng, steps.into()))
            };
            match found {
                Ok(plan) => return Ok(plan.knots.iter().map(row).collect()),
                Err(Error::NoPlan { .. }) => py.check_signals()?,
                Err(error) => return Err(rejected(error)),
            }
            if let Some(progress) = &progress {
                progress.call1((done + portion,))?;
            }
        }
        Err(PyRuntimeError::new_err(Error::NoPlan { tries }.to_string()))
    }

    /// Calls `progress` ten times a second, when Ctrl-C acts, and at the end.
    fn plan_each(
        slf: &Bound<'_, Self>,
        states: Vec<[f32; 4]>,
        steps: u16,
        tries: u32,
        seed: Bound<'_, PyAny>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<Option<Vec<Row>>>> {
        let (py, rng) = (slf.py(), Pcg64::from(parse(seed)?));
        let states: Vec<_> = states.into_iter().map(State::from).collect();
        let mut planner = alone(slf)?.planner.clone(); // `progress` may use it, too
        let (mut reported, mut last) = (Ok(()), Instant::now());
        let report = |py: Python<'_>, found: usize| {
            py.check_signals()?;
            progress.as_ref().map_or(Ok(()), |progress| progress.call1(py, (found,)).map(drop))
        };
        let go_on = |found| {
            if last.elapsed() >= Duration::from_millis(100) {
                reported = Python::attach(|py| report(py, found));
                last = Instant::now();
            }
            reported.is_ok()
        };
        let plans = py.detach(|| planner.plan_each(&states, tries, &rng, steps.into(), go_on));
        reported?;
        let plans = plans.map_err(rejected)?;
        report(py, plans.iter().flatten().count())?;
        let rows = |plan: Plan<_, Vec<_>>| plan.knots.iter().map(row).collect();
        Ok(plans.into_iter().map(|plan| plan.map(rows)).collect())
    }

    fn improve(
        slf: &Bound<'_, Self>,
        state: [f32; 4],
        plan: Vec<Row>,
        iterations: u32,
    ) -> PyResult<(Vec<Row>, f32)> {
        let mut plan: Vec<_> = plan.into_iter().map(knot).collect();
        let planner = &mut alone(slf)?.planner;
        let cost = slf.py().detach(|| planner.improve(state.into(), iterations, &mut plan));
        Ok((plan.iter().map(row).collect(), cost.map_err(rejected)?))
    }

    fn improve_each(
        slf: &Bound<'_, Self>,
        states: Vec<[f32; 4]>,
        plans: Vec<Vec<Row>>,
        iterations: u32,
    ) -> PyResult<(Vec<Vec<Row>>, Vec<f32>)> {
        let states: Vec<_> = states.into_iter().map(State::from).collect();
        let knots = |plan: Vec<_>| plan.into_iter().map(knot).collect::<Vec<_>>();
        let mut plans: Vec<_> = plans.into_iter().map(knots).collect();
        let planner = &mut alone(slf)?.planner;
        let costs = slf.py().detach(|| planner.improve_each(&states, iterations, &mut plans));
        let rows = plans.iter().map(|plan| plan.iter().map(row).collect()).collect();
        Ok((rows, costs.map_err(rejected)?))
    }
}

fn knot([x1, x2, x3, x4, torque, k1, k2, k3, k4]: Row) -> Knot<f32> {
    let mut knot = Knot::open(torque);
    (knot.state, knot.gain) = ([x1, x2, x3, x4].into(), [k1, k2, k3, k4]);
    knot
}

fn row(&Knot { state, torque, gain: [k1, k2, k3, k4], .. }: &Knot<f32>) -> Row {
    let [x1, x2, x3, x4] = state.into();
    [x1, x2, x3, x4, torque, k1, k2, k3, k4]
}

/// A gain and the region in which its torque lasts.
type Region = ([f32; 4], Matrix);

/// The fields of a feedback.
type After = ([f32; 4], f32, Region, Region, f32);

/// The torque at a knot, or without one that after a plan, N m.
#[pyfunction]
pub fn plan_torque(row: Option<Row>, after: After, state: [f32; 4]) -> PyResult<f32> {
    let (target, torque, moving, resting, reach) = after;
    let region = |(gain, factor)| regulator::Region { gain, factor };
    let (target, moving, resting) = (target.into(), region(moving), region(resting));
    let after = Feedback { target, torque, moving, resting, reach };
    match (Plan { knots: row.map(knot).as_slice(), after }).torque(0, state.into()) {
        torque if torque.is_finite() => Ok(torque),
        torque => Err(wrong("state", "so near the plan that the torque is finite", torque)),
    }
}

/// Swings up without a plan.
#[pyclass(module = "acrobot_rs._native")]
pub struct SwingUp {
    swing_up: plan::SwingUp<Damped<Fast>>,
    arguments: (Acrobot, f64),
}

#[pymethods]
impl SwingUp {
    #[new]
    #[pyo3(signature = (acrobot, max_torque, is_holding = false))]
    fn new(acrobot: &Bound<'_, Acrobot>, max_torque: f64, is_holding: bool) -> PyResult<Self> {
        let params = machine(acrobot)?;
        let mut swing_up = narrow(
            || plan::SwingUp::new(params.cast(), max_torque as f32),
            || plan::SwingUp::<Damped<Portable>>::new(params, max_torque),
        )?;
        swing_up.is_holding = is_holding;
        Ok(Self { swing_up, arguments: (alone(acrobot)?.clone(), max_torque) })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<impl IntoPyObject<'py>> {
        let this = alone(slf)?;
        let (acrobot, max_torque) = this.arguments.clone();
        Ok((slf.get_type(), (acrobot, max_torque, this.swing_up.is_holding)))
    }

    fn torque(slf: &Bound<'_, Self>, state: [f32; 4]) -> PyResult<f32> {
        alone(slf)?.swing_up.torque(state.into()).map_err(rejected)
    }
}
