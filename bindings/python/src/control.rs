//! The functions of `acrobot_rs.control`, each for many states at once.

use acrobot::arithmetic::{Arithmetic, Damped, Host, Real, Reference};
use acrobot::control::{self, ControlError, LinearModel, Lqr};
use acrobot::physics::Pendulum;
use acrobot::task::{Gymnasium, Swingup, Task};
use acrobot::{Error, Fast, Portable, State};
use numpy::{PyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::{Name, Params, invalid, rejected, with};

/// Applies a function to each row of inputs. Returns the results of all rows.
#[pyfunction]
pub fn compute<'py>(
    py: Python<'py>,
    function: &str,
    params: &Bound<'py, PyDict>,
    rows: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let params = read(params)?;
    let rows = rows.as_slice()?.chunks_exact(rows.shape()[1]);
    let results = py.detach(|| {
        let mut results = Vec::new();
        for row in rows {
            results.extend(results_of(function, params, row)?);
        }
        Ok(results)
    });
    Ok(PyArray1::from_vec(py, results.map_err(|error: ControlError| rejected(error))?))
}

/// The parameters by Python's names. A pendulum has neither actions nor noise.
fn read(given: &Bound<'_, PyDict>) -> PyResult<Params> {
    let mut params = Params::DEFAULT;
    for (name, value) in given {
        let name: String = name.extract()?;
        if !matches!(&*name, "AVAIL_TORQUE" | "torque_noise_max") {
            params = with::<f64>(params, Name(&name, [None; 2]), &value)?;
        }
    }
    let task = if given.contains("LINK_MOI")? { Gymnasium::NAME } else { Swingup::NAME };
    params.validate().map_err(|error| invalid(task, error, None))?;
    Ok(params)
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
        ("fast", ..) => simulate::<Damped<Fast>>(params, row)?,
        ("portable", ..) => simulate::<Damped<Portable>>(params, row)?,
        ("reference", ..) => simulate::<Damped<Reference>>(params, row)?,
        _ => simulate::<Damped<Host>>(params, row)?,
    })
}

/// The state that a row begins with, and that after each torque.
fn simulate<A: Arithmetic>(params: Params, row: &[f64]) -> Result<Vec<f64>, Error> {
    let Some((&state, torques)) = row.split_first_chunk::<4>() else { return Ok(Vec::new()) };
    let mut pendulum = Pendulum::<A>::new(params.cast(), State::from(state).cast())?;
    let mut states = vec![pendulum.state().cast()];
    for &torque in torques {
        pendulum.step(A::Scalar::from_f64(torque))?;
        states.push(pendulum.state().cast());
    }
    Ok(states.into_iter().flat_map(<[f64; 4]>::from).collect())
}
