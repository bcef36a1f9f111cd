//! What `acrobot_rs.control` computes: functions, each for many states at once.

use std::ffi::CString;

use acrobot::arithmetic::Damped;
use acrobot::control::model::{LinearModel, StepModel};
use acrobot::control::regulator::{Lqe, Lqr, dlqe, dlqr, lqr, tvlqr};
use acrobot::physics::Pendulum;
use acrobot::{Error, Portable, State};
use numpy::{PyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;

use crate::estimate::{Named, named_numbers};
use crate::single::{Acrobot, One};
use crate::{Params, alone, invalid, named, rejected, wrong};

/// Applies a function to each row of inputs. Returns the results of all rows.
#[pyfunction]
pub fn compute<'py>(
    function: &str,
    acrobot: &Bound<'py, Acrobot>,
    rows: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (py, one) = (acrobot.py(), alone(acrobot)?.acrobot.clone());
    let rows = rows.as_slice()?.chunks_exact(rows.shape()[1]);
    let mut clamped = None;
    let results: PyResult<_> = py.detach(|| {
        let mut results = Vec::new();
        for row in rows {
            results.extend(match function {
                "simulate" => simulate(one.clone(), row, &mut clamped)?,
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
    let results = results?;
    if let Some((name, bound)) = clamped {
        let what = "simulate clamped a velocity at its bound, as an environment does";
        let warning = CString::new(format!("{what}: {name}={bound:.4} rad/s; inf is no bound"))?;
        // For the line that calls `simulate`, which calls `_call`: once by default.
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &warning, 3)?;
    }
    Ok(PyArray1::from_vec(py, results))
}

/// A bound of a velocity, by its name, rad/s.
type Clamped = Option<(&'static str, f64)>;

/// The state that a row begins with, and that after each torque.
fn simulate(mut acrobot: One, row: &[f64], clamped: &mut Clamped) -> PyResult<Vec<f64>> {
    let Some((&state, torques)) = row.split_first_chunk::<4>() else { return Ok(Vec::new()) };
    acrobot.set_state(State::from(state))?;
    let Params { max_velocity1, max_velocity2, .. } = acrobot.params();
    let mut states = state.to_vec();
    for &torque in torques {
        acrobot.step(torque)?;
        let state = acrobot.state();
        if state.dtheta1.abs() >= max_velocity1 {
            *clamped = Some(("MAX_VEL_1", max_velocity1));
        } else if state.dtheta2.abs() >= max_velocity2 {
            *clamped = Some(("MAX_VEL_2", max_velocity2));
        }
        states.extend(<[f64; 4]>::from(state));
    }
    Ok(states)
}

/// The parameters with a rotor behind a gear in the elbow, or with inertias about the joints.
#[pyfunction]
pub fn params_with(
    acrobot: &Bound<'_, Acrobot>,
    rotor: Option<[f64; 2]>,
    inertias: Option<[f64; 2]>,
) -> PyResult<Named<f64>> {
    let mut params = alone(acrobot)?.acrobot.params();
    params = rotor.map_or(params, |[inertia, gear]| params.with_rotor(inertia, gear));
    params = inertias.map_or(params, |inertias| params.with_inertias_about_joints(inertias));
    params.validate().map_err(|error| invalid(error, None))?;
    Ok(named_numbers(&params))
}

/// The parameters by Rust's names.
#[pyfunction]
pub fn fields(acrobot: &Bound<'_, Acrobot>) -> PyResult<Vec<(&'static str, f64)>> {
    Ok(alone(acrobot)?.acrobot.params().numbers().into())
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
