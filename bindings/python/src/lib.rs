//! The native part of `acrobot_rs`. Gymnasium's interface is written in Python, in `python/`.

mod batch;
mod draws;
mod engine;
mod pool;
mod single;

use std::fmt::Display;

use acrobot::arithmetic::Host;
use acrobot::env::{AcrobotEnv, Env, RenderMode, Rendering};
use acrobot::physics::Dynamics;
use acrobot::task::{Gymnasium, Task};
use acrobot::{Params, State};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::PyClass;
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::False;
use pyo3::types::{PyBool, PyByteArray, PyBytes};
use serde::Serialize;
use serde::de::DeserializeOwned;

pyo3::import_exception!(gymnasium.error, InvalidAction);

#[pymodule(gil_used = false)]
mod _native {
    #[pymodule_export]
    const BUSY: &str = super::BUSY;
    #[pymodule_export]
    use super::batch::Batch;
    #[pymodule_export]
    use super::single::Acrobot;
}

/// Says what to do when an environment is in use.
const BUSY: &str = "another thread is stepping or resetting an environment; \
    change parameters and call methods between its steps, or make an environment for each thread";

/// The only access to an object. Without Python's lock any call can meet another thread's; with it,
/// steps and resets of many let other threads run, and so does Python code that converts a number.
fn alone<'py, T: PyClass<Frozen = False>>(object: &Bound<'py, T>) -> PyResult<PyRefMut<'py, T>> {
    let busy = |_| PyRuntimeError::new_err(BUSY);
    object.try_borrow_mut().map_err(busy)
}

/// The torque of a continuous action, N m, which is within the smallest and the largest torque.
/// Gymnasium's task has torques as actions. In a swing-up the action 1 is the largest torque, −1
/// the smallest and 0 none.
fn torque_of(task: &str, action: f64, low: f64, high: f64) -> f64 {
    let torque = match task {
        Gymnasium::NAME => action,
        _ => match action.clamp(-1.0, 1.0) {
            action if action < 0.0 => action * -low,
            action => action * high,
        },
    };
    torque.max(low).min(high)
}

/// A number among the parameters: Python's name, the crate's, and its field.
type Number = (&'static str, &'static str, fn(&mut Params) -> &mut f64);

/// In the order of draws. Gymnasium has one moment of inertia for both links, a swing-up two.
const NUMBERS: [Number; 20] = [
    ("LINK_LENGTH_1", "length1", |p| &mut p.length1),
    ("LINK_LENGTH_2", "length2", |p| &mut p.length2),
    ("LINK_MASS_1", "mass1", |p| &mut p.mass1),
    ("LINK_MASS_2", "mass2", |p| &mut p.mass2),
    ("LINK_COM_POS_1", "center_of_mass1", |p| &mut p.center_of_mass1),
    ("LINK_COM_POS_2", "center_of_mass2", |p| &mut p.center_of_mass2),
    ("LINK_MOI", "inertia1", |p| &mut p.inertia1),
    ("LINK_MOI", "inertia2", |p| &mut p.inertia2),
    ("LINK_MOI_1", "inertia1", |p| &mut p.inertia1),
    ("LINK_MOI_2", "inertia2", |p| &mut p.inertia2),
    ("gravity", "gravity", |p| &mut p.gravity),
    ("dt", "dt", |p| &mut p.dt),
    ("MAX_VEL_1", "max_velocity1", |p| &mut p.max_velocity1),
    ("MAX_VEL_2", "max_velocity2", |p| &mut p.max_velocity2),
    ("AVAIL_TORQUE", "torques", |p| &mut p.torques[0]),
    ("AVAIL_TORQUE", "torques", |p| &mut p.torques[1]),
    ("AVAIL_TORQUE", "torques", |p| &mut p.torques[2]),
    ("torque_noise_max", "torque_noise", |p| &mut p.torque_noise),
    ("FRICTION_1", "friction.joint1", |p| &mut p.friction.joint1),
    ("FRICTION_2", "friction.joint2", |p| &mut p.friction.joint2),
];

/// The fields of a parameter by Python's name.
fn fields(name: &str) -> impl Iterator<Item = fn(&mut Params) -> &mut f64> {
    let named = NUMBERS.iter().filter(move |(known, ..)| *known == name);
    named.map(|(.., field)| *field)
}

/// Turns an error of the crate into a `ValueError` with its message.
fn rejected(error: impl std::error::Error) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// The same for parameters of a task: the message begins with Python's name of one.
fn invalid(task: &str, error: impl Display) -> PyErr {
    let message = error.to_string();
    let renamed = NUMBERS.iter().find_map(|(pythons, name, _)| {
        let rest = message.strip_prefix(name)?;
        let known = *pythons != "LINK_MOI" || task == Gymnasium::NAME;
        let whole = known && rest.starts_with([' ', '[']);
        whole.then(|| format!("{pythons}{rest}"))
    });
    PyValueError::new_err(renamed.unwrap_or(message))
}

/// An error message in the form of the crate's.
fn must_be(name: &str, rule: impl Display, got: impl Display) -> String {
    format!("{name} must be {rule}, got {got}")
}

/// Converts a parameter from Python, or raises a `TypeError` that names it. Bools are no numbers,
/// and bytes no sequence.
fn convert<'a, 'py, T: FromPyObject<'a, 'py>>(
    name: &str,
    rule: &str,
    value: &'a Bound<'py, PyAny>,
) -> PyResult<T> {
    let wrong = || PyTypeError::new_err(must_be(name, rule, shown(value)));
    let converted = value.extract().map_err(|_| wrong())?;
    // What was converted has an end, which an iterator need not have.
    let elements = value.try_iter().into_iter().flatten().flatten();
    let is_bytes = value.is_instance_of::<PyBytes>() || value.is_instance_of::<PyByteArray>();
    if is_bytes || elements.chain([value.clone()]).any(|each| is_bool(&each)) {
        return Err(wrong());
    }
    Ok(converted)
}

/// Whether a value is Python's bool, NumPy's, or an array of these.
fn is_bool(value: &Bound<'_, PyAny>) -> bool {
    let kind = value.getattr("dtype").and_then(|dtype| dtype.getattr("kind")?.extract::<char>());
    value.is_instance_of::<PyBool>() || kind.is_ok_and(|kind| kind == 'b')
}

/// A value in an error message.
fn shown(value: &Bound<'_, PyAny>) -> String {
    let text = value.repr().map(|text| text.to_string());
    text.unwrap_or_else(|_| format!("{}", value.get_type()))
}

/// The error for a text from Python that is not one of the names in `rule`.
fn unknown(name: &str, rule: &str, got: &str) -> PyErr {
    PyValueError::new_err(must_be(name, rule, format_args!("{got:?}")))
}

/// The parameters of a task with one of them changed.
fn with(task: &str, mut params: Params, name: &str, value: &Bound<'_, PyAny>) -> PyResult<Params> {
    match name {
        "AVAIL_TORQUE" => {
            let count = value.len().unwrap_or(3); // without a length, it is no sequence
            if count != 3 {
                let message = must_be(name, "3 numbers, such as [-2, 0, 2]", count);
                return Err(PyValueError::new_err(message));
            }
            params.torques = convert(name, "a sequence of 3 numbers", value)?;
        }
        "book_or_nips" => {
            let rule = r#""book" or "nips""#;
            params.dynamics = match convert(name, rule, value)? {
                "book" => Dynamics::Book,
                "nips" => Dynamics::Nips,
                other => return Err(unknown(name, rule, other)),
            }
        }
        _ => {
            let number = convert(name, "a number", value)?;
            fields(name).for_each(|field| *field(&mut params) = number);
        }
    }
    params.validate().map_err(|error| invalid(task, error))?;
    Ok(params)
}

/// Renders a state: an array of shape (500, 500, 3) or a text, depending on the render mode.
fn render<'py>(
    py: Python<'py>,
    params: Params,
    state: State,
    mode: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let mode = match mode {
        "rgb_array" => RenderMode::RgbArray,
        "ansi" => RenderMode::Ansi,
        other => return Err(unknown("render_mode", r#""rgb_array" or "ansi""#, other)),
    };
    let params = Params {
        friction: Default::default(), // which no picture shows
        ..params
    };
    let mut env = AcrobotEnv::<Host, [f32; 6]>::new(params, mode).map_err(rejected)?;
    env.unwrapped_mut().set_state(state).map_err(rejected)?;
    match env.render().map_err(rejected)? {
        Rendering::Frame(frame) => {
            let shape = [frame.height() as usize, frame.width() as usize, 3];
            let array = PyArray1::from_slice(py, frame.bytes()).reshape(shape)?;
            Ok(array.into_any())
        }
        Rendering::Text(text) => Ok(text.into_pyobject(py)?.into_any()),
        // The other modes return no picture, and were rejected above.
        _ => Ok(py.None().into_bound(py)),
    }
}

/// The version of this package's snapshots. Those of the crate, inside, have their own.
const VERSION: u32 = 3;

/// Serializes a snapshot, for pickle.
fn save<'py>(py: Python<'py>, snapshot: &impl Serialize) -> PyResult<Bound<'py, PyBytes>> {
    let bytes = postcard::to_stdvec(&(VERSION, snapshot));
    let bytes = bytes.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    Ok(PyBytes::new(py, &bytes))
}

/// Deserializes a snapshot. Rejects other versions, and bytes after the end.
fn load<T: DeserializeOwned>(bytes: &[u8]) -> PyResult<T> {
    let damaged = |error| PyValueError::new_err(format!("the snapshot is damaged: {error}"));
    let (version, rest): (u32, _) = postcard::take_from_bytes(bytes).map_err(damaged)?;
    if version != VERSION {
        let message = must_be("the snapshot's version", VERSION, version);
        return Err(PyValueError::new_err(message));
    }
    let (snapshot, rest) = postcard::take_from_bytes(rest).map_err(damaged)?;
    if !rest.is_empty() {
        let count = rest.len();
        let message = format!("the snapshot must have no bytes after its end, got {count}");
        return Err(PyValueError::new_err(message));
    }
    Ok(snapshot)
}
