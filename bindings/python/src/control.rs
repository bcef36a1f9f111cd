//! What `acrobot_rs.control` computes: functions, each for many states at once, and plans.

use acrobot::arithmetic::Damped;
use acrobot::control;
use acrobot::control::estimate::{Noise, ParameterEstimator, ParameterStd};
use acrobot::control::identify::{Fit, Sample};
use acrobot::control::model::{LinearModel, StepModel};
use acrobot::control::plan::{self, Cost, Knot, Plan, Problem};
use acrobot::control::regulator::{self, Feedback, Lqr, dlqr, lqr};
use acrobot::numpy::Pcg64;
use acrobot::physics::Pendulum;
use acrobot::{Error, Fast, Portable, State};
use numpy::{PyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::single::{Acrobot, One};
use crate::{NAMES, Params, invalid, rejected};

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
        ("linearize_step", &[state], &[torque]) => {
            let StepModel { a, b } = at(state)?.linearize_step(torque)?;
            of_model(a, b)
        }
        ("dlqr", &[a1, a2, a3, a4, b, q1, q2, q3, q4], &[r]) => {
            let model = StepModel { a: [a1, a2, a3, a4], b };
            of_regulator(dlqr(&model, &[q1, q2, q3, q4], r)?)
        }
        ("lqr", &[a1, a2, a3, a4, b, q1, q2, q3, q4], &[r]) => {
            let model = LinearModel { a: [a1, a2, a3, a4], b };
            of_regulator(lqr(&model, &[q1, q2, q3, q4], r)?)
        }
        ("regulator", &[state, q1, q2, q3, q4], &[torque, r]) => {
            of_regulator(at(state)?.regulator(torque, &[q1, q2, q3, q4], r)?)
        }
        _ => Vec::new(),
    })
}

/// The tries between two calls of `progress`: a multiple of the ten lengths of a plan.
const PORTION: u32 = 40;

/// A state, a torque and gains.
type Row = [f32; 9];

type Matrix = [[f32; 4]; 4];

/// The weights of a cost, by their names in Rust. `None` for the default.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Weights {
    q: Option<Matrix>,
    qf: Option<Matrix>,
    angles: Option<[f32; 2]>,
    torque: Option<f32>,
    torque_change: Option<f32>,
    power: Option<f32>,
    below: Option<f32>,
    height: Option<f32>,
    margin: Option<f32>,
    arrival: Option<f32>,
}

/// Plans motions to an equilibrium.
#[pyclass(module = "acrobot_rs._native")]
pub struct Planner(plan::Planner<Damped<Fast>>);

#[pymethods]
impl Planner {
    #[new]
    fn new(
        acrobot: PyRef<'_, Acrobot>,
        max_torque: f32,
        elbow: f32,
        velocity_clamp: bool,
        weights: Weights,
    ) -> PyResult<Self> {
        let params = acrobot.acrobot.params().cast();
        let mut problem =
            Problem::balance::<Damped<Fast>>(params, max_torque, elbow).map_err(rejected)?;
        let own = problem.cost;
        problem.cost = Cost {
            q: weights.q.unwrap_or(own.q),
            qf: weights.qf.unwrap_or(own.qf),
            angles: weights.angles.unwrap_or(own.angles),
            torque: weights.torque.unwrap_or(own.torque),
            torque_change: weights.torque_change.unwrap_or(own.torque_change),
            power: weights.power.unwrap_or(own.power),
            below: weights.below.unwrap_or(own.below),
            height: weights.height.unwrap_or(own.height),
            margin: weights.margin.unwrap_or(own.margin),
            arrival: weights.arrival.unwrap_or(own.arrival),
        };
        let planner = plan::Planner::new(&problem).map_err(rejected)?;
        Ok(Self(if velocity_clamp { planner.with_velocity_clamp() } else { planner }))
    }

    /// What holds the target after each plan.
    fn after(&self) -> After {
        let Feedback { target, torque, moving, resting, reach } = *self.0.regulator().feedback();
        let region = |regulator::Region { gain, factor }| (gain, factor);
        (target.into(), torque, region(moving), region(resting), reach)
    }

    fn holds_from(&self, state: [f32; 4]) -> PyResult<bool> {
        Ok(self.0.regulator().holds_from(valid(state)?))
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
            match py.detach(|| self.0.plan(state.into(), portion, &mut rng, steps.into())) {
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

    fn improve_each(
        &mut self,
        py: Python<'_>,
        states: Vec<[f32; 4]>,
        plans: Vec<Vec<Row>>,
        iterations: u32,
    ) -> PyResult<(Vec<Vec<Row>>, Vec<f32>)> {
        let states: Vec<_> = states.into_iter().map(State::from).collect();
        let knots = |plan: Vec<_>| plan.into_iter().map(knot).collect::<Vec<_>>();
        let mut plans: Vec<_> = plans.into_iter().map(knots).collect();
        let costs = py.detach(|| self.0.improve_each(&states, iterations, &mut plans));
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

fn valid(state: [f32; 4]) -> PyResult<State<f32>> {
    let state = State::from(state);
    state.validate().map_err(rejected).map(|()| state)
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
    Ok(Plan { knots: row.map(knot).as_slice(), after }.torque(0, valid(state)?))
}

/// Swings up without a plan.
#[pyclass(module = "acrobot_rs._native")]
pub struct SwingUp(plan::SwingUp<Damped<Fast>>);

#[pymethods]
impl SwingUp {
    #[new]
    fn new(acrobot: PyRef<'_, Acrobot>, max_torque: f32) -> PyResult<Self> {
        let params = acrobot.acrobot.params().cast();
        plan::SwingUp::new(params, max_torque).map(Self).map_err(rejected)
    }

    fn torque(&mut self, state: [f32; 4]) -> PyResult<f32> {
        self.0.torque(state.into()).map_err(rejected)
    }
}

/// Estimates a state and parameters. Those with a standard deviation of 0 are known.
#[pyclass(module = "acrobot_rs._native")]
pub struct Estimator(ParameterEstimator<Damped<Portable>>);

#[pymethods]
impl Estimator {
    #[new]
    fn new(
        acrobot: PyRef<'_, Acrobot>,
        angle_std: f64,
        torque_std: f64,
        parameter_std: [f64; 10],
    ) -> PyResult<Self> {
        let [mass1, mass2, length1, inertia1, inertia2, ..] = parameter_std;
        let [.., damping1, damping2, coulomb1, coulomb2, rotor] = parameter_std;
        let links =
            ParameterStd { mass1, mass2, length1, inertia1, inertia2, ..Default::default() };
        let std = ParameterStd { damping1, damping2, coulomb1, coulomb2, rotor, ..links };
        let noise = Noise { angle_std, torque_std };
        let estimator = ParameterEstimator::new(acrobot.acrobot.params(), std, noise);
        estimator.map(Self).map_err(|error| invalid(error, None))
    }

    fn correct(&mut self, angles: [f64; 2]) -> PyResult<[f64; 4]> {
        self.0.correct(angles).map_err(rejected)?;
        Ok(self.0.state().into())
    }

    fn predict(&mut self, torque: f64) -> PyResult<()> {
        self.0.predict(torque).map_err(rejected)
    }

    fn state_std(&self) -> Option<[f64; 4]> {
        self.0.state_std()
    }

    fn params(&self) -> Named<f64> {
        named_numbers(self.0.params())
    }
}

/// Angles and torques, a row for each sample of each recording, to parameters; to the numbers that
/// they follow from, with standard errors and parts of the weakest combination; and to the rank
/// deficiency.
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
    let (params, fit) =
        control::identify::identify(&recordings, acrobot.acrobot.params()).map_err(rejected)?;
    let Fit { values, std_errors, weakest, rank_deficiency } = fit;
    let numbers = Fit::NAMES.into_iter().enumerate();
    let numbers = numbers.map(|(i, name)| (name, [values[i], std_errors[i], weakest[i]])).collect();
    Ok((named_numbers(&params), numbers, rank_deficiency))
}

/// Names and what they stand for.
type Named<T> = Vec<(&'static str, T)>;

/// The parameters that are one number, by Python's names.
fn named_numbers(params: &Params) -> Named<f64> {
    let numbers = NAMES.into_iter().zip(params.numbers()).map(|(name, (_, number))| (name, number));
    numbers.filter(|(name, _)| *name != "AVAIL_TORQUE").collect()
}
