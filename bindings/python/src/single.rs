//! The single environments: one acrobot, bit-identical to Gymnasium's, or of another task.

use acrobot::arithmetic::{Damped, Host};
use acrobot::numpy::Pcg64;
use acrobot::task::{AnyTask, Instruments};
use acrobot::{Portable, State, Step};
use numpy::{PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyAssertionError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde::{Deserialize, Serialize};

use crate::engine::torque_of;
use crate::instruments::{Setting, Through, place};
use crate::{
    InvalidAction, Name, Params, alone, convert, invalid, load, must_be, named, rejected, render,
    save, shown, with, wrong,
};

pyo3::import_exception!(gymnasium.error, ResetNeeded);

/// An acrobot of a task, which computes as Gymnasium does in its task.
#[derive(Clone, Serialize, Deserialize)]
#[expect(clippy::large_enum_variant, reason = "each environment has one")]
pub enum One {
    Host(acrobot::Acrobot<Damped<Host>, AnyTask>),
    Portable(acrobot::Acrobot<Damped<Portable>, AnyTask>),
    /// Through a motor and sensors.
    Measured(acrobot::Acrobot<Damped<Portable>, Through>),
}

/// Does something with the acrobot, whatever its arithmetic.
macro_rules! with_one {
    ($one:expr, $acrobot:ident => $result:expr) => {
        match $one {
            One::Host($acrobot) => $result,
            One::Portable($acrobot) => $result,
            One::Measured($acrobot) => $result,
        }
    };
}

impl One {
    fn new(task: AnyTask) -> PyResult<Self> {
        match task {
            AnyTask::Gymnasium => acrobot::Acrobot::with_task(0, task).map(Self::Host),
            _ => acrobot::Acrobot::with_task(0, task).map(Self::Portable),
        }
        .map_err(rejected)
    }

    fn task(&self) -> AnyTask {
        match self {
            Self::Host(acrobot) => *acrobot.task(),
            Self::Portable(acrobot) => *acrobot.task(),
            Self::Measured(acrobot) => *acrobot.task().task(),
        }
    }

    /// The same acrobot with this instrument.
    fn through(&self, name: &str, setting: &Setting) -> PyResult<Self> {
        let mut acrobot = match self {
            Self::Measured(acrobot) => acrobot.clone(),
            _ if matches!(setting, Setting::Ideal) => return Ok(self.clone()),
            _ => {
                let task = Through::new(self.task(), Instruments::IDEAL).map_err(rejected)?;
                let mut acrobot = acrobot::Acrobot::with_task(0, task).map_err(rejected)?;
                acrobot.set_params(self.params()).map_err(rejected)?;
                acrobot.set_state(self.state()).map_err(rejected)?;
                acrobot
            }
        };
        acrobot.set_task(setting.task(acrobot.task(), name)?);
        let memory = setting.remember::<Damped<Portable>>(name, 0, *acrobot.memory())?;
        acrobot.set_memory(memory).map_err(rejected)?;
        Ok(Self::Measured(acrobot))
    }

    pub fn params(&self) -> Params {
        with_one!(self, acrobot => *acrobot.params())
    }

    fn set_params(&mut self, params: Params) -> PyResult<()> {
        with_one!(self, acrobot => acrobot.set_params(params)).map_err(|error| invalid(error, None))
    }

    pub fn state(&self) -> State {
        with_one!(self, acrobot => acrobot.state())
    }

    pub fn set_state(&mut self, state: State) -> PyResult<()> {
        with_one!(self, acrobot => acrobot.set_state(state)).map_err(rejected)
    }

    pub fn step(&mut self, torque: f64) -> PyResult<Step> {
        with_one!(self, acrobot => acrobot.step_torque(torque)).map_err(rejected)
    }
}

/// One acrobot: its parameters and its state. Random numbers come from the environment's generator.
#[pyclass(module = "acrobot_rs._native")]
#[derive(Clone, Serialize, Deserialize)]
pub struct Acrobot {
    /// Whether actions are torques.
    continuous: bool,
    /// Without noise and with the default torques: the crate has three.
    pub acrobot: One,
    torques: Vec<f64>,
    noise: f64,
    /// Whether the state was set or reset: Gymnasium's environment has none before the first reset.
    started: bool,
}

impl Acrobot {
    /// Checks the torques and the noise.
    fn validate(&self) -> PyResult<()> {
        if self.torques.is_empty() {
            return Err(wrong("AVAIL_TORQUE", "one or more numbers of N m", "none"));
        }
        let params = Params { torque_noise: self.noise, ..self.acrobot.params() };
        params.validate().map_err(|error| invalid(error, None))?;
        for (index, &torque) in self.torques.iter().enumerate() {
            let name = Name("AVAIL_TORQUE", [None, Some(index)]);
            let checked = Params { torques: [torque; 3], ..params }.validate();
            checked.map_err(|error| named(error, name))?;
        }
        Ok(())
    }
}

#[pymethods]
impl Acrobot {
    #[new]
    #[pyo3(signature = (continuous = false, task = "gymnasium"))]
    pub fn new(continuous: bool, task: &str) -> PyResult<Self> {
        let acrobot = One::new(crate::task(task)?)?;
        let torques = acrobot.params().torques.into();
        Ok(Self { continuous, acrobot, torques, noise: 0.0, started: false })
    }

    fn set(slf: &Bound<'_, Self>, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut this = alone(slf)?;
        let mut changed = this.clone();
        match name {
            "AVAIL_TORQUE" => changed.torques = convert(name, "a sequence of numbers", value)?,
            "torque_noise_max" => changed.noise = convert(name, "a number", value)?,
            _ => {
                let params = with::<f64>(changed.acrobot.params(), Name(name, [None; 2]), value)?;
                changed.acrobot.set_params(params)?;
            }
        }
        changed.validate()?;
        *this = changed;
        Ok(())
    }

    /// Sets an instrument: no value, one, or what each reset draws.
    fn set_instrument(
        slf: &Bound<'_, Self>,
        name: &str,
        values: Vec<Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let setting = Setting::read(name, &values)?;
        let mut this = alone(slf)?;
        this.acrobot = this.acrobot.through(name, &setting)?;
        Ok(())
    }

    fn instrument(slf: &Bound<'_, Self>, name: &str) -> PyResult<f64> {
        Ok(match &alone(slf)?.acrobot {
            One::Measured(acrobot) => *place(&mut Through::drawn(acrobot.memory()), name),
            _ => 0.0,
        })
    }

    /// Draws the instruments from a generator with this seed.
    fn draw_instruments(slf: &Bound<'_, Self>, seed: u64) -> PyResult<()> {
        if let One::Measured(acrobot) = &mut alone(slf)?.acrobot {
            *acrobot.rng_mut() = Pcg64::new(seed);
            acrobot.reset();
        }
        Ok(())
    }

    #[getter]
    fn state(slf: &Bound<'_, Self>) -> PyResult<Option<[f64; 4]>> {
        let this = alone(slf)?;
        Ok(this.started.then(|| this.acrobot.state().into()))
    }

    #[setter]
    fn set_state(slf: &Bound<'_, Self>, state: [f64; 4]) -> PyResult<()> {
        let mut this = alone(slf)?;
        this.acrobot.set_state(state.into())?;
        this.started = true;
        Ok(())
    }

    fn observation<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let this = alone(slf)?;
        let observation = with_one!(&this.acrobot, acrobot => acrobot.observation());
        Ok(PyArray1::from_slice(slf.py(), &observation))
    }

    /// Steps by an action of the environment, whose generator draws the noise. Returns what
    /// `Env.step` does.
    fn step<'py>(
        slf: &Bound<'py, Self>,
        env: &Bound<'py, PyAny>,
        action: &Bound<'py, PyAny>,
    ) -> PyResult<impl IntoPyObject<'py>> {
        let py = slf.py();
        let continuous = alone(slf)?.continuous;
        // The conversion can be Python code.
        let number = continuous.then(|| number(env, action)).transpose()?;
        let mut this = alone(slf)?;
        if !this.started {
            let message = "the environment has no state yet; call reset before step";
            return Err(match this.acrobot.task() {
                AnyTask::Gymnasium => PyAssertionError::new_err(message), // as Gymnasium's
                _ => ResetNeeded::new_err(message),
            });
        }
        let mut torque = match number {
            Some(torque) => this.clipped(torque),
            None => this.torque(action)?,
        };
        let noise = this.noise;
        if noise > 0.0 {
            drop(this); // the generator is Python code
            let rng = env.getattr("np_random")?;
            let draw: f64 = rng.call_method1("uniform", (-noise, noise))?.extract()?;
            torque += draw;
            this = alone(slf)?;
        }
        let step = this.acrobot.step(torque)?;
        let observation = PyArray1::from_slice(py, &step.observation);
        Ok((observation, f64::from(step.reward), step.terminated, false, PyDict::new(py)))
    }

    fn render<'py>(slf: &Bound<'py, Self>, mode: &str) -> PyResult<Bound<'py, PyAny>> {
        let this = alone(slf)?;
        let acrobot = &this.acrobot;
        render(slf.py(), acrobot.params(), acrobot.state(), mode)
    }

    /// Every protocol of pickle calls this.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<impl IntoPyObject<'py>> {
        Ok((slf.get_type(), (), Self::__getstate__(slf)?))
    }

    fn __getstate__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyBytes>> {
        save(slf.py(), &*alone(slf)?)
    }

    fn __setstate__(slf: &Bound<'_, Self>, bytes: &[u8]) -> PyResult<()> {
        let loaded: Self = load(bytes)?;
        loaded.validate()?;
        *alone(slf)? = loaded;
        Ok(())
    }
}

impl Acrobot {
    /// The torque of an action, N m.
    #[inline]
    fn torque(&self, action: &Bound<'_, PyAny>) -> PyResult<f64> {
        let number = action.extract::<usize>().ok();
        let torque = number.and_then(|number| self.torques.get(number));
        torque.copied().ok_or_else(|| {
            let rule = format_args!("an integer from 0 to {}", self.torques.len() - 1);
            InvalidAction::new_err(must_be("action", rule, shown(action)))
        })
    }

    /// The torque of a continuous action, N m.
    fn clipped(&self, action: f64) -> f64 {
        let torques = &self.torques;
        let low = torques.iter().copied().fold(f64::INFINITY, f64::min);
        let high = torques.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        torque_of(self.acrobot.task(), action, low, high)
    }
}

/// A continuous action. The environment converts or rejects all but an array of one `f32`.
fn number(env: &Bound<'_, PyAny>, action: &Bound<'_, PyAny>) -> PyResult<f64> {
    if let Ok(array) = action.cast::<PyArray1<f32>>()
        && array.len() == 1
        && array.is_aligned()
        && let Some(torque) = array.get_owned(0)
        && !torque.is_nan()
    {
        return Ok(torque.into());
    }
    env.call_method1("_torque", (action,))?.extract()
}
