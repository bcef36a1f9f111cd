//! The single environment: one acrobot, bit-identical to Gymnasium's.

use acrobot::arithmetic::Host;
use acrobot::{Action, Observation, Params, State};
use numpy::PyArray1;
use pyo3::exceptions::PyAssertionError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::{ACTIONS, InvalidAction, load, must_be, rejected, render, save, with};

/// What `Env.step` returns: observation, reward, terminated, truncated and info.
type Step<'py> = (
    Bound<'py, PyArray1<f32>>,
    f64,
    bool,
    bool,
    Bound<'py, PyDict>,
);

/// One acrobot: its parameters and its state. Python draws all random numbers, from the environment's generator.
#[pyclass(module = "acrobot_rs._native")]
pub struct Acrobot {
    acrobot: acrobot::Acrobot<Host>,
    /// Whether observations are those of `Acrobot-v0`.
    angles: bool,
    /// Whether the state was set or reset: Gymnasium's environment has none before the first reset.
    started: bool,
}

#[pymethods]
impl Acrobot {
    #[new]
    fn new(angles: bool) -> Self {
        Self {
            acrobot: acrobot::Acrobot::new(0),
            angles,
            started: false,
        }
    }

    fn set(&mut self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let params = with(*self.acrobot.params(), name, value)?;
        // No noise from the crate: `step` gets it as an argument.
        let params = Params {
            torque_noise: 0.0,
            ..params
        };
        self.acrobot.set_params(params).map_err(rejected)
    }

    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let state: [f64; 4] = self.acrobot.state().into();
        self.started.then(|| PyArray1::from_slice(py, &state))
    }

    #[setter]
    fn set_state(&mut self, state: [f64; 4]) -> PyResult<()> {
        self.acrobot
            .set_state(State::from(state))
            .map_err(rejected)?;
        self.started = true;
        Ok(())
    }

    fn observation<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        if self.angles {
            PyArray1::from_slice(py, Observation::<4>::from(self.acrobot.state()).as_ref())
        } else {
            PyArray1::from_slice(py, self.acrobot.observation().as_ref())
        }
    }

    /// The torque of an action, N m. Rejects invalid actions, and any action before the first reset.
    fn torque(&self, action: &Bound<'_, PyAny>) -> PyResult<f64> {
        if !self.started {
            let message = "the environment has no state yet; call reset before step";
            return Err(PyAssertionError::new_err(message));
        }
        let number = action.extract::<u8>().ok();
        let known = number.and_then(|number| Action::try_from(number).ok());
        let known = known.ok_or_else(|| {
            let shown = action.repr().map(|repr| repr.to_string());
            InvalidAction::new_err(must_be("action", ACTIONS, shown.unwrap_or_default()))
        })?;
        Ok(self.acrobot.params().torque(known))
    }

    fn step<'py>(&mut self, action: &Bound<'py, PyAny>, noise: f64) -> PyResult<Step<'py>> {
        let torque = self.torque(action)? + noise;
        let step = self.acrobot.step_torque(torque).map_err(rejected)?;
        let py = action.py();
        Ok((
            self.observation(py),
            step.reward.into(),
            step.terminated,
            false,
            PyDict::new(py),
        ))
    }

    fn render<'py>(&self, py: Python<'py>, mode: &str) -> PyResult<Bound<'py, PyAny>> {
        render(py, *self.acrobot.params(), self.acrobot.state(), mode)
    }

    fn __getnewargs__(&self) -> (bool,) {
        (self.angles,)
    }

    fn __getstate__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = save(&(&self.acrobot, self.started))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn __setstate__(&mut self, bytes: &[u8]) -> PyResult<()> {
        (self.acrobot, self.started) = load(bytes)?;
        Ok(())
    }
}
