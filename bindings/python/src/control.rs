//! What `acrobot_rs.control` computes: functions, each for many states at once, and plans.

use acrobot::arithmetic::{Arithmetic, Damped, Real};
use acrobot::batch::VecBatch;
use acrobot::control::model::{LinearModel, StepModel};
use acrobot::control::plan::{self, Cost, Knot, Plan, Problem};
use acrobot::control::regulator::{self, Feedback, Lqe, Lqr, dlqe, dlqr, lqr, tvlqr};
use acrobot::numpy::Pcg64;
use acrobot::physics::Pendulum;
use acrobot::{Error, Fast, Portable, State};
use numpy::{PyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::batch::parse;
use crate::single::{Acrobot, One};
use crate::{NAMES, Params, alone, held, invalid, named, places, rejected, wrong};

/// Applies a function to each row of inputs. Returns the results of all rows.
#[pyfunction]
pub fn compute<'py>(
    function: &str,
    acrobot: &Bound<'py, Acrobot>,
    rows: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (py, one) = (acrobot.py(), alone(acrobot)?.acrobot.clone());
    let rows = rows.as_slice()?.chunks_exact(rows.shape()[1]);
    let results: PyResult<_> = py.detach(|| {
        let mut results = Vec::new();
        for row in rows {
            results.extend(match function {
                "simulate" => simulate(one.clone(), row)?,
                _ => {
                    results_of(function, one.params(), row).map_err(|error| match error.name() {
                        // As in python-control.
                        name @ ("q" | "r" | "w" | "s") => named(error, name.to_uppercase()),
                        _ => rejected(error),
                    })?
                }
            });
        }
        let rule = format_args!("so small that {function} is finite");
        let infinite = results.iter().find(|x| !f64::is_finite(**x));
        infinite.map_or(Ok(()), |x| Err(wrong("the numbers", rule, x))).map(|()| results)
    });
    Ok(PyArray1::from_vec(py, results?))
}

/// The state that a row begins with, and that after each torque.
fn simulate(mut acrobot: One, row: &[f64]) -> PyResult<Vec<f64>> {
    let Some((&state, torques)) = row.split_first_chunk::<4>() else { return Ok(Vec::new()) };
    acrobot.set_state(State::from(state))?;
    let mut states = state.to_vec();
    for &torque in torques {
        acrobot.step(torque)?;
        states.extend(<[f64; 4]>::from(acrobot.state()));
    }
    Ok(states)
}

/// The results for a row: vectors of four numbers, then the other numbers.
fn results_of(function: &str, params: Params, row: &[f64]) -> Result<Vec<f64>, Error> {
    let at = |state| Pendulum::<Damped<Portable>>::new(params, State::from(state));
    let of_model = |[a1, a2, a3, a4]: [[f64; 4]; 4], b| [a1, a2, a3, a4, b].concat();
    let of_regulator = |Lqr { gain, cost_to_go: [p1, p2, p3, p4] }| [gain, p1, p2, p3, p4].concat();
    let (vectors, numbers) = row.as_chunks();
    Ok(match (function, vectors, numbers) {
        ("energy", &[state], _) => vec![at(state)?.energy()],
        ("mass_matrix", &[state], _) => at(state)?.mass_matrix().concat(),
        ("derivative", &[state], &[torque]) => at(state)?.derivative(torque).to_vec(),
        ("inverse_dynamics", &[state], &[ddtheta1, ddtheta2]) => {
            at(state)?.inverse_dynamics([ddtheta1, ddtheta2])?.torques.to_vec()
        }
        ("deviation", &[state, target], _) => {
            State::from(state).deviation_from(State::from(target)).to_vec()
        }
        ("linearize", &[state], &[torque]) => {
            let LinearModel { a, b } = at(state)?.linearize(torque)?;
            of_model(a, b)
        }
        ("dlqr", &[a1, a2, a3, a4, b, q1, q2, q3, q4], &[r]) => {
            let model = StepModel { a: [a1, a2, a3, a4], b };
            of_regulator(dlqr(&model, &[q1, q2, q3, q4], r)?)
        }
        ("dlqe", &[a1, a2, a3, a4, w1, w2, w3, w4], &[s1, s2]) => {
            let model = StepModel { a: [a1, a2, a3, a4], b: [0.0; 4] };
            let Lqe { gain, prior_covariance } = dlqe(&model, &[w1, w2, w3, w4], [s1, s2])?;
            [gain.concat(), prior_covariance.concat()].concat()
        }
        ("lqr", &[a1, a2, a3, a4, b, q1, q2, q3, q4], &[r]) => {
            let model = LinearModel { a: [a1, a2, a3, a4], b };
            of_regulator(lqr(&model, &[q1, q2, q3, q4], r)?)
        }
        ("regulator", &[state, q1, q2, q3, q4], &[torque, r]) => {
            of_regulator(at(state)?.regulator(torque, &[q1, q2, q3, q4], r)?)
        }
        ("tvlqr", vectors, &[r]) if let Some((models, last)) = vectors.split_last_chunk() => {
            let [q1, q2, q3, q4, qf1, qf2, qf3, qf4] = *last;
            let (a, b) = models.split_at(models.len() / 5 * 4);
            let models = a.as_chunks().0.iter().zip(b).map(|(&a, &b)| StepModel { a, b });
            let models: Vec<_> = models.collect();
            let mut gains = vec![[0.0; 4]; models.len()];
            let (q, qf) = ([q1, q2, q3, q4], [qf1, qf2, qf3, qf4]);
            let cost_to_go = tvlqr(&models, &q, r, &qf, &mut gains)?;
            [cost_to_go.concat(), gains.concat()].concat()
        }
        _ => Vec::new(),
    })
}

/// A step of many acrobots, for rows of a state, a torque and the parameters with these names: the
/// states after it, or the derivatives by each number of the rows.
#[pyfunction]
pub fn steps<'py>(
    acrobot: &Bound<'py, Acrobot>,
    rows: PyReadonlyArray2<'py, f64>,
    names: Vec<String>,
    linearizes: bool,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (py, mut params) = (acrobot.py(), alone(acrobot)?.acrobot.params());
    params.torque_noise = 0.0;
    let rows = rows.as_slice()?.chunks_exact(rows.shape()[1]);
    let results: PyResult<_> = py.detach(|| {
        if rows.len() == 0 {
            return Ok(Vec::new()); // no batch is empty
        }
        let mut batch = VecBatch::<Damped<Portable>>::new(0, rows.len()).map_err(rejected)?;
        batch.own_params().map_err(rejected)?;
        let mut torques = Vec::new();
        for (index, row) in rows.enumerate() {
            let Some((&state, &[torque, ref values @ ..])) = row.split_first_chunk::<4>() else {
                return Ok(Vec::new());
            };
            let mut own = params;
            for (name, value) in names.iter().zip(values) {
                places(name).for_each(|place| *own.numbers_mut()[place] = *value);
            }
            batch.set_params(index, own).map_err(|error| invalid(error, Some(index)))?;
            batch.set_state(index, state.into()).map_err(rejected)?;
            torques.push(torque);
        }
        if !linearizes {
            batch.step(&torques).map_err(rejected)?;
            let states = (0..torques.len()).filter_map(|index| batch.state(index).ok());
            return Ok(states.flat_map(<[f64; 4]>::from).collect());
        }
        let mut models = vec![StepModel { a: [[0.0; 4]; 4], b: [0.0; 4] }; torques.len()];
        let mut by_params = vec![params.map(|_| [0.0; 4]); models.len()];
        let wanted = (!names.is_empty()).then_some(&mut by_params[..]);
        batch.linearize_step_into(&torques, &mut models, wanted).map_err(rejected)?;
        let mut results = Vec::new();
        for (StepModel { a, b }, by_params) in models.into_iter().zip(by_params) {
            results.extend([a.as_flattened(), &b].concat());
            let numbers = by_params.numbers();
            for name in &names {
                // Both moments of inertia have a common name.
                let sum = |i: usize| places(name).map(|place| numbers[place].1[i]).sum::<f64>();
                results.extend([sum(0), sum(1), sum(2), sum(3)]);
            }
        }
        Ok(results)
    });
    Ok(PyArray1::from_vec(py, results?))
}

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
    weights: &[Option<f64>],
) -> Result<plan::Planner<A>, Error> {
    let number = A::Scalar::from_f64;
    let mut problem = Problem::balance::<A>(params.cast(), number(max_torque), number(elbow))?;
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
        velocity_clamp: bool,
        weights: Vec<Option<f64>>,
    ) -> PyResult<Self> {
        let (params, numbers) = (machine(acrobot)?, [max_torque, elbow]);
        let planner = narrow(
            || planner::<Damped<Fast>>(params, numbers, &weights),
            || planner::<Damped<Portable>>(params, numbers, &weights),
        )?;
        let planner = if velocity_clamp { planner.with_velocity_clamp() } else { planner };
        let copy = alone(acrobot)?.clone();
        let arguments = (copy, max_torque, elbow, velocity_clamp, weights);
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
