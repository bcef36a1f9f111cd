//! The functions of `acrobot_rs.control`, each for many states at once.

use acrobot::arithmetic::Damped;
use acrobot::control::{self, ControlError, LinearModel, Lqr};
use acrobot::physics::Pendulum;
use acrobot::{Portable, State};
use numpy::{PyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::single::{Acrobot, One};
use crate::{Params, rejected};

/// Applies a function to each row of inputs. Returns the results of all rows.
#[pyfunction]
pub fn compute<'py>(
    function: &str,
    acrobot: PyRef<'py, Acrobot>,
    rows: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (py, one) = (acrobot.py(), acrobot.inner.acrobot.clone());
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
