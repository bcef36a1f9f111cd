//! The native part of `acrobot_rs`: numbers in, numbers out. What Gymnasium's users see is in `python/`.

mod batch;
mod single;

use std::num::NonZeroU32;

use acrobot::env::{AcrobotEnv, Env, RenderMode, Rendering};
use acrobot::{Dynamics, Host, Observation, Params, State};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyAttributeError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

pyo3::import_exception!(gymnasium.error, InvalidAction);

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::batch::Batch;
    #[pymodule_export]
    use super::check_start_bounds;
    #[pymodule_export]
    use super::single::Acrobot;
}

/// Refuses bounds that `f32` cannot hold, and a `low` above `high`.
#[pyfunction]
fn check_start_bounds(low: f64, high: f64) -> PyResult<()> {
    acrobot::StartBounds::new(low, high).map_err(refused)?;
    Ok(())
}

/// What the crate refuses is a `ValueError` that says what is allowed.
fn refused(error: impl std::error::Error) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A text from Python that is no name of what there is.
fn unknown(name: &str, found: &str, allowed: &str) -> PyErr {
    PyValueError::new_err(format!("{name} is {found:?}; allowed is {allowed}"))
}

/// A count from Python, which has no types for it.
fn positive(name: &str, value: i64) -> PyResult<NonZeroU32> {
    let count = u32::try_from(value).ok().and_then(NonZeroU32::new);
    count.ok_or_else(|| {
        PyValueError::new_err(format!("{name} is {value}; allowed is 1 to {}", u32::MAX))
    })
}

/// The parameters with one changed, by the name that Gymnasium has for it.
fn with(params: Params, name: &str, value: &Bound<'_, PyAny>) -> PyResult<Params> {
    let mut params = params;
    match name {
        "dt" => params.dt = value.extract()?,
        "LINK_LENGTH_1" => params.length1 = value.extract()?,
        "LINK_LENGTH_2" => params.length2 = value.extract()?,
        "LINK_MASS_1" => params.mass1 = value.extract()?,
        "LINK_MASS_2" => params.mass2 = value.extract()?,
        "LINK_COM_POS_1" => params.center_of_mass1 = value.extract()?,
        "LINK_COM_POS_2" => params.center_of_mass2 = value.extract()?,
        "LINK_MOI" => {
            params.inertia1 = value.extract()?;
            params.inertia2 = params.inertia1;
        }
        "MAX_VEL_1" => params.max_velocity1 = value.extract()?,
        "MAX_VEL_2" => params.max_velocity2 = value.extract()?,
        "AVAIL_TORQUE" => params.torques = value.extract()?,
        "torque_noise_max" => params.torque_noise = value.extract()?,
        "book_or_nips" => {
            params.dynamics = match value.extract()? {
                "book" => Dynamics::Book,
                "nips" => Dynamics::Nips,
                other => return Err(unknown(name, other, r#""book" or "nips""#)),
            }
        }
        _ => return Err(PyAttributeError::new_err(format!("no parameter {name}"))),
    }
    params.validate().map_err(refused)?;
    Ok(params)
}

/// What a render mode shows of a state: an array of shape (500, 500, 3), or a text.
fn render<'py>(
    py: Python<'py>,
    params: Params,
    state: State,
    mode: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let mode = match mode {
        "rgb_array" => RenderMode::RgbArray,
        "ansi" => RenderMode::Ansi,
        other => return Err(unknown("render_mode", other, r#""rgb_array" or "ansi""#)),
    };
    let mut env = AcrobotEnv::<Host, Observation>::new(params, mode).map_err(refused)?;
    env.unwrapped_mut().set_state(state).map_err(refused)?;
    match env.render().map_err(refused)? {
        Rendering::Frame(frame) => {
            let shape = [frame.height() as usize, frame.width() as usize, 3];
            let array = PyArray1::from_slice(py, frame.bytes()).reshape(shape)?;
            Ok(array.into_any())
        }
        Rendering::Text(text) => Ok(text.into_pyobject(py)?.into_any()),
        Rendering::Shown => Ok(py.None().into_bound(py)),
    }
}

/// Of what this package adds to the crate's snapshots, which have a version of their own.
const VERSION: u32 = 1;

/// The bytes of a snapshot, for pickle.
fn save(snapshot: &impl Serialize) -> PyResult<Vec<u8>> {
    postcard::to_stdvec(&(VERSION, snapshot))
        .map_err(|error| PyRuntimeError::new_err(error.to_string()))
}

/// The snapshot of such bytes, checked, and nothing after it.
fn load<T: DeserializeOwned>(bytes: &[u8]) -> PyResult<T> {
    let damaged = |error| PyValueError::new_err(format!("the snapshot is damaged: {error}"));
    let (version, bytes) = postcard::take_from_bytes::<u32>(bytes).map_err(damaged)?;
    if version != VERSION {
        let message = format!("the snapshot is of version {version}; allowed is {VERSION}");
        return Err(PyValueError::new_err(message));
    }
    match postcard::take_from_bytes(bytes).map_err(damaged)? {
        (snapshot, []) => Ok(snapshot),
        _ => Err(PyValueError::new_err("the snapshot has bytes too many")),
    }
}
