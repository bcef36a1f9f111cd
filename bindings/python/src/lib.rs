//! The native part of `acrobot_rs`. Gymnasium's interface is written in Python, in `python/`.

mod batch;
mod control;
mod engine;
mod estimate;
mod instruments;
mod mpc;
mod plan;
mod pool;
mod single;

use std::fmt::{self, Display, Formatter};

use acrobot::arithmetic::{Damped, Host, Real};
use acrobot::physics::{Dynamics, Pendulum};
use acrobot::render::{Figure, Frame};
use acrobot::task::{AnyTask, Balance, Gymnasium, ResetBounds, Swingup, Task};
use acrobot::{Error, Params, State};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::PyClass;
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::False;
use pyo3::types::PyBytes;
use serde::Serialize;
use serde::de::DeserializeOwned;

pyo3::import_exception!(gymnasium.error, InvalidAction);

#[pymodule(gil_used = false)]
mod _native {
    #[pymodule_export]
    const REWARD_THRESHOLD: f32 = acrobot::REWARD_THRESHOLD;
    #[pymodule_export]
    const MAX_STEPS: u32 = Gymnasium::MAX_STEPS.get();
    #[pymodule_export]
    const SWINGUP_MAX_STEPS: u32 = Swingup::MAX_STEPS.get();
    #[pymodule_export]
    const BOUND: f64 = Gymnasium::RESET_BOUNDS.high();
    #[pymodule_export]
    const SWINGUP_BOUND: f64 = Swingup::RESET_BOUNDS.high();
    #[pymodule_export]
    const BALANCE_BOUND: f64 = Balance::RESET_BOUNDS.high();
    #[pymodule_export]
    use super::batch::Batch;
    #[pymodule_export]
    use super::control::{compute, fields, params_with};
    #[pymodule_export]
    use super::estimate::{Estimator, calibrate, identify};
    #[pymodule_export]
    use super::mpc::{Controller, Replanner};
    #[pymodule_export]
    use super::plan::{Planner, SwingUp, plan_torque};
    #[pymodule_export]
    use super::single::Acrobot;
    use super::*;

    /// The place of the first number, if any, that is NaN or larger than the largest.
    #[pyfunction]
    fn first_beyond(numbers: PyReadonlyArray1<'_, f64>, largest: f64) -> Option<usize> {
        numbers.as_array().iter().position(|number| number.is_nan() || number.abs() > largest)
    }

    /// Checks the bounds of initial states, rad and rad/s.
    #[pyfunction]
    fn check_bounds(low: f64, high: f64) -> PyResult<()> {
        ResetBounds::new(low, high).map(drop).map_err(rejected)
    }
}

/// Says what to do when an object is in use.
const BUSY: &str = "another thread is using this environment, planner or estimator; \
    call it between the calls of that thread, or make one for each thread";

/// The only access to an object. Without Python's lock any call can meet another thread's; with it,
/// steps and resets of many let other threads run, and so does Python code that converts a number.
fn alone<'py, T: PyClass<Frozen = False>>(object: &Bound<'py, T>) -> PyResult<PyRefMut<'py, T>> {
    let busy = |_| PyRuntimeError::new_err(BUSY);
    object.try_borrow_mut().map_err(busy)
}

/// Python's names of the parameters, in the order of the crate's numbers. `LINK_MOI` is both
/// moments of inertia.
// derive.py writes the names.
const NAMES: [&str; 21] = [
    "LINK_LENGTH_1",
    "LINK_LENGTH_2",
    "LINK_MASS_1",
    "LINK_MASS_2",
    "LINK_COM_POS_1",
    "LINK_COM_POS_2",
    "LINK_MOI_1",
    "LINK_MOI_2",
    "gravity",
    "dt",
    "MAX_VEL_1",
    "MAX_VEL_2",
    "AVAIL_TORQUE",
    "AVAIL_TORQUE",
    "AVAIL_TORQUE",
    "torque_noise_max",
    "DAMPING_1",
    "DAMPING_2",
    "COULOMB_1",
    "COULOMB_2",
    "ROTOR",
];

/// The places of a parameter among the numbers.
fn places(name: &str) -> impl Iterator<Item = usize> {
    let is_of = move |known: &str| known == name || name == "LINK_MOI" && known.starts_with(name);
    (0..NAMES.len()).filter(move |&place| is_of(NAMES[place]))
}

/// Python's name of a parameter, with the indices of an environment and of a torque.
struct Name<'a>(&'a str, [Option<usize>; 2]);

impl Display for Name<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)?;
        self.1.iter().flatten().try_for_each(|index| write!(f, "[{index}]"))
    }
}

/// Turns an error of the crate into a `ValueError` with its message.
fn rejected(error: impl std::error::Error) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// The place among the numbers of the parameter that was rejected, if it is one.
fn place_of(error: Error) -> Option<usize> {
    let names: [(_, f64); NAMES.len()] = Params::DEFAULT.numbers();
    names.iter().position(|(name, _)| *name == error.name())
}

/// The error of a rejected parameter, of all environments or of one, with Python's name.
fn invalid(error: Error, index: Option<usize>) -> PyErr {
    let Some(place) = place_of(error) else { return rejected(error) };
    let name = NAMES[place];
    let torque = places(name).position(|each| each == place).filter(|_| name == "AVAIL_TORQUE");
    named(error, Name(name, [index, torque]))
}

/// The error of a rejected number, with its name in Python.
fn named(error: Error, name: impl Display) -> PyErr {
    PyValueError::new_err(error.named(name).to_string())
}

/// The task with this name.
fn task(name: &str) -> PyResult<AnyTask> {
    let task = AnyTask::ALL.into_iter().find(|task| task.name() == name);
    let names = AnyTask::ALL.map(|task| task.name());
    task.ok_or_else(|| wrong("task", format_args!("one of {names:?}"), name))
}

/// A number, unless the scalar `S` makes infinity or 0 of it.
fn held<S: Real>(name: impl Display, number: f64) -> PyResult<f64> {
    let held = S::from_f64(number).to_f64();
    if number.is_finite() && (held.is_infinite() || held == 0.0 && number != 0.0) {
        let rule = "in the range of float32, from 1.2e-38 to 3.4e38";
        return Err(wrong(name, rule, format_args!("{number:?}")));
    }
    Ok(number)
}

/// Checks that the scalar `S` holds all states.
fn check_states<S: Real>(states: &[[f64; 4]]) -> PyResult<()> {
    let is_lost = |x: &f64| !S::from_f64(*x).to_f64().is_finite();
    for (index, state) in states.iter().enumerate() {
        if let Some(column) = state.iter().position(is_lost) {
            let name = format_args!("state[{index}, {column}]");
            held::<S>(name, state[column])?;
            State::from(*state).validate().map_err(|error| named(error, name))?;
        }
    }
    Ok(())
}

/// An error message in the form of the crate's.
fn must_be(name: impl Display, rule: impl Display, got: impl Display) -> String {
    format!("{name} must be {rule}, got {got}")
}

fn wrong(name: impl Display, rule: impl Display, got: impl Display) -> PyErr {
    PyValueError::new_err(must_be(name, rule, got))
}

/// Converts a parameter from Python, or raises a `TypeError` that names it.
fn convert<'a, 'py, T: FromPyObject<'a, 'py>>(
    name: impl Display,
    rule: &str,
    value: &'a Bound<'py, PyAny>,
) -> PyResult<T> {
    value.extract().map_err(|_| PyTypeError::new_err(must_be(name, rule, shown(value))))
}

/// A value in an error message.
fn shown(value: &Bound<'_, PyAny>) -> String {
    let text = value.repr().map(|text| text.to_string());
    text.unwrap_or_else(|_| format!("{}", value.get_type()))
}

/// The parameters with one of them changed, for the scalar `S`.
fn with<S: Real>(mut params: Params, name: Name<'_>, value: &Bound<'_, PyAny>) -> PyResult<Params> {
    match name.0 {
        "AVAIL_TORQUE" => {
            let count = value.len().unwrap_or(3); // without a length, it is no sequence
            if count != 3 {
                return Err(wrong(name, "3 numbers, such as [-2, 0, 2]", count));
            }
            params.torques = convert(&name, "a sequence of 3 numbers", value)?;
            for (index, &torque) in params.torques.iter().enumerate() {
                held::<S>(format_args!("{name}[{index}]"), torque)?;
            }
        }
        "book_or_nips" => {
            let rule = "'book' or 'nips'";
            params.dynamics = match convert(&name, rule, value)? {
                "book" => Dynamics::Book,
                "nips" => Dynamics::Nips,
                _ => return Err(wrong(name, rule, shown(value))),
            }
        }
        _ => {
            let number = held::<S>(&name, convert(&name, "a number", value)?)?;
            places(name.0).for_each(|place| *params.numbers_mut()[place] = number);
        }
    }
    Ok(params)
}

/// Renders a state: an array of shape (500, 500, 3) or a text, depending on the render mode.
fn render<'py>(
    py: Python<'py>,
    params: Params,
    state: State,
    mode: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let figure = Figure::of(&Pendulum::<Damped<Host>>::new(params, state).map_err(rejected)?);
    if mode == "rgb_array" {
        let frame = Frame::of(&figure);
        let shape = [frame.height() as usize, frame.width() as usize, 3];
        return Ok(PyArray1::from_slice(py, frame.bytes()).reshape(shape)?.into_any());
    }
    let [theta1, theta2, dtheta1, dtheta2] = <[f64; 4]>::from(state);
    let angles = format!("θ1 {theta1:+.2}  θ2 {theta2:+.2} rad");
    let velocities = format!("θ̇1 {dtheta1:+.2}  θ̇2 {dtheta2:+.2} rad/s");
    let text = format!("{}\n{angles}  {velocities}\n", figure.braille());
    Ok(text.into_pyobject(py)?.into_any())
}

/// Changes when a snapshot of another layout would be read.
const SNAPSHOT_VERSION: u8 = 8;

/// Serializes a snapshot, for pickle.
fn save<'py>(py: Python<'py>, snapshot: &impl Serialize) -> PyResult<Bound<'py, PyBytes>> {
    let bytes = postcard::to_stdvec(&(SNAPSHOT_VERSION, snapshot));
    Ok(PyBytes::new(py, &bytes.map_err(|error| PyRuntimeError::new_err(error.to_string()))?))
}

/// Deserializes a snapshot.
fn load<T: DeserializeOwned>(bytes: &[u8]) -> PyResult<T> {
    match postcard::from_bytes(bytes) {
        Ok((SNAPSHOT_VERSION, snapshot)) => Ok(snapshot),
        Ok(_) => Err(PyValueError::new_err("the snapshot is of another version")),
        Err(error) => Err(PyValueError::new_err(format!("the snapshot is damaged: {error}"))),
    }
}
