//! What `acrobot_rs.control` computes: functions, each for many states at once, and plans.

use acrobot::arithmetic::Damped;
use acrobot::control::{
    self, ControlError, Cost, Identified, Knot, LinearModel, Lqr, NoPlan, Noise, Sample,
};
use acrobot::numpy::Pcg64;
use acrobot::physics::Pendulum;
use acrobot::{Fast, Portable, State};
use numpy::{PyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::single::{Acrobot, One};
use crate::{NAMES, Params, invalid, places, rejected};

/// Applies a function to each row of inputs. Returns the results of all rows.
#[pyfunction]
pub fn compute<'py>(
    function: &str,
    acrobot: PyRef<'py, Acrobot>,
    rows: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (py, one) = (acrobot.py(), acrobot.acrobot.clone());
    drop(acrobot); // other threads may step it
    let rows = rows.as_slice()?.chunks_exact(rows.shape()[1]);
    let results: PyResult<_> = py.detach(|| {
        let mut results = Vec::new();
        for row in rows {
            results.extend(match function {
                "simulate" => simulate(one.clone(), row)?,
                _ => results_of(function, one.params(), row).map_err(rejected)?,
            });
        }
        Ok(results)
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
fn results_of(function: &str, params: Params, row: &[f64]) -> Result<Vec<f64>, ControlError> {
    let at = |state| Pendulum::<Damped<Portable>>::new(params, State::from(state));
    let of_model = |LinearModel { a: [a1, a2, a3, a4], b }| [a1, a2, a3, a4, b].concat();
    let of_regulator = |Lqr { gain, cost_to_go: [p1, p2, p3, p4] }| [gain, p1, p2, p3, p4].concat();
    let (vectors, numbers) = row.as_chunks();
    Ok(match (function, vectors, numbers) {
        ("energy", &[state], _) => vec![at(state)?.energy()],
        ("mass_matrix", &[state], _) => at(state)?.mass_matrix().concat(),
        ("derivative", &[state], &[torque]) => at(state)?.derivative(torque).to_vec(),
        ("inverse_dynamics", &[state], &[ddtheta1, ddtheta2]) => {
            control::inverse_dynamics(&at(state)?, [ddtheta1, ddtheta2])?.torques.to_vec()
        }
        ("difference", &[state, target], _) => {
            control::difference(State::from(state), State::from(target)).to_vec()
        }
        ("linearize", &[state], &[torque]) => of_model(control::linearize(&at(state)?, torque)?),
        ("linearize_step", &[state], &[torque]) => {
            of_model(control::linearize_step(&at(state)?, torque)?)
        }
        ("lqr", &[a1, a2, a3, a4, b, q1, q2, q3, q4], &[r]) => {
            let model = LinearModel { a: [a1, a2, a3, a4], b };
            of_regulator(control::lqr(&model, &[q1, q2, q3, q4], r)?)
        }
        ("regulator", &[state, q1, q2, q3, q4], &[torque, r]) => {
            of_regulator(control::regulator(&at(state)?, torque, &[q1, q2, q3, q4], r)?)
        }
        _ => Vec::new(),
    })
}

/// The tries between two calls of `progress`: four of each of a search's ten lengths.
const PORTION: u32 = 40;

/// A state, a torque and gains.
type Row = [f32; 9];

/// Plans swing-ups.
#[pyclass(module = "acrobot_rs._native")]
pub struct Planner(control::Planner<Damped<Fast>>);

#[pymethods]
impl Planner {
    #[new]
    fn new(
        acrobot: PyRef<'_, Acrobot>,
        max_torque: f32,
        clamps: bool,
        given: [Option<f32>; 4],
        pairs: [[f32; 2]; 2],
        weights: [f32; 3],
    ) -> PyResult<Self> {
        let params = acrobot.acrobot.params().cast();
        let own = Cost::new(&params, max_torque).map_err(rejected)?;
        let ([torque, below, height, margin], [angles, velocities]) = (given, pairs);
        let [torque_change, power, arrival] = weights;
        let cost = Cost {
            angles,
            velocities,
            torque: torque.unwrap_or(own.torque),
            torque_change,
            power,
            below: below.unwrap_or(own.below),
            height: height.unwrap_or(own.height),
            margin: margin.unwrap_or(own.margin),
            arrival,
        };
        let planner = control::Planner::with_cost(params, max_torque, cost).map_err(rejected)?;
        Ok(Self(if clamps { planner.for_simulation() } else { planner }))
    }

    fn plan(
        &mut self,
        py: Python<'_>,
        state: [f32; 4],
        steps: u16,
        tries: u32,
        seed: u64,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Vec<Row>> {
        let mut rng = Pcg64::new(seed);
        for done in (0..tries).step_by(PORTION as usize) {
            let portion = PORTION.min(tries - done);
            match py.detach(|| self.0.search(state.into(), portion, &mut rng, steps.into())) {
                Ok(plan) => return Ok(plan.iter().map(row).collect()),
                Err(NoPlan::NotFound { .. }) => py.check_signals()?,
                Err(error) => return Err(rejected(error)),
            }
            if let Some(progress) = &progress {
                progress.call1((done + portion,))?;
            }
        }
        Err(PyRuntimeError::new_err(NoPlan::NotFound { tries }.to_string()))
    }

    fn improve(
        &mut self,
        py: Python<'_>,
        state: [f32; 4],
        plan: Vec<Row>,
        iterations: u32,
    ) -> PyResult<(Vec<Row>, f32)> {
        let mut plan: Vec<_> = plan.into_iter().map(knot).collect();
        let cost = py.detach(|| self.0.improve(state.into(), iterations, &mut plan));
        Ok((plan.iter().map(row).collect(), cost.map_err(rejected)?))
    }

    /// The torque of a knot, or that after a plan.
    fn follow(&self, plan: Option<Row>, state: [f32; 4]) -> f32 {
        self.0.follow(plan.map(knot).as_slice(), 0, state.into())
    }

    fn decide(&mut self, state: [f32; 4]) -> PyResult<f32> {
        self.0.decide(state.into()).map_err(rejected)
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

type Estimating = control::Estimator<Damped<Portable>>;

/// Estimates a state and parameters. Those with a deviation of 0 are known.
#[pyclass(module = "acrobot_rs._native")]
pub struct Estimator(control::Estimator<Damped<Portable>, { Estimating::PARAMETERS }>);

#[pymethods]
impl Estimator {
    #[new]
    fn new(
        acrobot: PyRef<'_, Acrobot>,
        angle: f64,
        torque: f64,
        deviations: Vec<(String, f64)>,
    ) -> PyResult<Self> {
        let params = acrobot.acrobot.params();
        let mut all = params;
        all.numbers_mut().into_iter().for_each(|number| *number = 0.0);
        for (name, deviation) in deviations {
            places(&name).for_each(|place| *all.numbers_mut()[place] = deviation);
        }
        let estimator = control::Estimator::with_params(params, all, Noise { angle, torque });
        Ok(Self(estimator.map_err(|error| invalid(error, None))?))
    }

    fn measure(&mut self, angles: [f64; 2]) -> PyResult<[f64; 4]> {
        self.0.measure(angles).map_err(rejected)?;
        Ok(self.0.state().into())
    }

    fn step(&mut self, torque: f64) -> PyResult<()> {
        self.0.step(torque).map_err(rejected)
    }

    fn deviations(&self) -> Option<[f64; 4]> {
        self.0.deviations()
    }

    fn params(&self) -> Named<f64> {
        named_numbers(self.0.params())
    }
}

/// Angles and torques, a row for each sample of each recording, to parameters; to the numbers that
/// they follow from, with errors and with parts of the weakest combination; and to the number of
/// combinations that are not determined.
#[pyfunction]
pub fn identify(
    acrobot: PyRef<'_, Acrobot>,
    recordings: Vec<Vec<[f64; 4]>>,
) -> PyResult<(Named<f64>, Named<[f64; 3]>, usize)> {
    let sample = |[angle1, angle2, torque1, torque2]: [f64; 4]| Sample {
        angles: [angle1, angle2],
        torques: [torque1, torque2],
    };
    let recordings: Vec<Vec<_>> =
        recordings.into_iter().map(|rows| rows.into_iter().map(sample).collect()).collect();
    let recordings: Vec<&[_]> = recordings.iter().map(Vec::as_slice).collect();
    let (params, found) =
        control::identify(&recordings, acrobot.acrobot.params()).map_err(rejected)?;
    let Identified { values, errors, weakest, undetermined } = found;
    let numbers = Identified::NAMES.into_iter().enumerate();
    let numbers = numbers.map(|(i, name)| (name, [values[i], errors[i], weakest[i]])).collect();
    Ok((named_numbers(&params), numbers, undetermined))
}

/// Names and what they stand for.
type Named<T> = Vec<(&'static str, T)>;

/// The parameters that are one number, by Python's names.
fn named_numbers(params: &Params) -> Named<f64> {
    let numbers = NAMES.into_iter().zip(params.numbers()).map(|(name, (_, number))| (name, number));
    numbers.filter(|(name, _)| *name != "AVAIL_TORQUE").collect()
}
