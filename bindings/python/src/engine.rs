//! A batch of any arithmetic and task.

use std::fmt::Display;

use acrobot::arithmetic::{Arithmetic, Damped, Host, Real, Reference};
use acrobot::batch::{StepBuffers, VecBatch};
use acrobot::numpy::SeedSequence;
use acrobot::task::{AnyTask, Draw, Draws, Task};
use acrobot::{Acrobot, Error, Fast, State};
use numpy::{
    PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyMemoryError, PyTypeError};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::instruments::{Setting, Through};
use crate::{
    InvalidAction, Name, Params, check_states, invalid, must_be, places, rejected, shown, with,
    wrong,
};

/// Actions (0, 1 or 2), or torques, N m; in a swing-up from −1 to 1.
#[derive(FromPyObject)]
pub enum Inputs<'py> {
    Actions(PyReadonlyArray1<'py, i64>),
    Torques(PyReadonlyArray2<'py, f32>),
}

impl<'py> Inputs<'py> {
    /// The actions, if no conversion is necessary.
    pub fn of(actions: &Bound<'py, PyAny>, len: usize, continuous: bool) -> Option<Self> {
        if continuous {
            let torques = actions.cast::<PyArray2<f32>>().ok()?;
            let torques = torques.try_readonly().ok()?;
            let fits = torques.shape() == [len, 1] && torques.as_slice().is_ok();
            return fits.then_some(Self::Torques(torques));
        }
        let actions = actions.cast::<PyArray1<i64>>().ok()?;
        let actions = actions.try_readonly().ok()?;
        let fits = actions.len() == len && actions.as_slice().is_ok();
        fits.then_some(Self::Actions(actions))
    }
}

/// A batch in one of three arithmetics. All have friction, which takes 2 % of a step where it is 0.
#[derive(Serialize, Deserialize)]
pub enum Engine {
    Float32(Many<Damped<Fast>>),
    Float64(Many<Damped<Reference>>),
    /// Computes as Gymnasium does.
    Host(Many<Damped<Host>>),
    /// In `float32`, through a motor and sensors.
    Measured(Many<Damped<Fast>, Through>),
}

impl Engine {
    pub fn new(arithmetic: &str, task: AnyTask, len: usize, seed: SeedSequence) -> PyResult<Self> {
        match arithmetic {
            "float32" => Many::new(task, len, seed).map(Self::Float32),
            "float64" => Many::new(task, len, seed).map(Self::Float64),
            "host" => Many::new(task, len, seed).map(Self::Host),
            _ => return Err(wrong("arithmetic", "float32, float64 or host", arithmetic)),
        }
        .map_err(out_of_memory)
    }

    pub fn task(&self) -> AnyTask {
        match self {
            Self::Float32(many) => *many.batch.task(),
            Self::Float64(many) => *many.batch.task(),
            Self::Host(many) => *many.batch.task(),
            Self::Measured(many) => *many.batch.task().task(),
        }
    }

    /// Sets an instrument. Acrobots without any get all.
    pub fn set_instrument(&mut self, name: &str, values: &[Bound<'_, PyAny>]) -> PyResult<()> {
        let setting = Setting::read(name, values)?;
        match self {
            Self::Measured(many) => many.set_instrument(name, &setting),
            _ if matches!(setting, Setting::Ideal) => Ok(()),
            Self::Float32(many) => {
                let mut measured = Many::through(many)?;
                measured.set_instrument(name, &setting)?;
                *self = Self::Measured(measured);
                Ok(())
            }
            _ => {
                Err(wrong(name, "None with float64 and with gymnasium_episodes", shown(&values[0])))
            }
        }
    }
}

/// Does something with the batch in an engine, whatever its arithmetic.
macro_rules! with_batch {
    ($engine:expr, $many:ident => $result:expr) => {
        match $engine {
            $crate::engine::Engine::Float32($many) => $result,
            $crate::engine::Engine::Float64($many) => $result,
            $crate::engine::Engine::Host($many) => $result,
            $crate::engine::Engine::Measured($many) => $result,
        }
    };
}
pub(crate) use with_batch;

/// A batch, and memory for its inputs. Numbers are `f64` outside, which `f32` becomes exactly.
#[derive(Serialize, Deserialize)]
#[serde(bound = "T: Serialize + serde::de::DeserializeOwned", transparent)]
pub struct Many<A: Arithmetic, T: Task = AnyTask> {
    pub batch: VecBatch<A, T>,
    #[serde(skip)]
    actions: Vec<u8>,
    /// Empty if the inputs of the next step are actions.
    #[serde(skip)]
    torques: Vec<A::Scalar>,
}

impl<A: Arithmetic, T: Task> From<VecBatch<A, T>> for Many<A, T> {
    fn from(batch: VecBatch<A, T>) -> Self {
        Self { batch, actions: Vec::new(), torques: Vec::new() }
    }
}

impl<A: Arithmetic, T: Task<Observation = [f32; 6]>> Many<A, T> {
    fn new(task: T, len: usize, seed: SeedSequence) -> Result<Self, Error> {
        VecBatch::with_task(seed, task, len).map(Self::from)
    }

    pub fn params(&self, index: usize) -> Params {
        self.batch.params(index).unwrap_or_default().cast()
    }

    pub fn state(&self, index: usize) -> State {
        self.batch.state(index).unwrap_or_default().cast()
    }

    /// Sets all states, if all are valid.
    pub fn set_states(&mut self, states: &[[f64; 4]]) -> PyResult<()> {
        check_states::<A::Scalar>(states)?;
        for (index, state) in states.iter().enumerate() {
            let state = State::from(*state).cast();
            self.batch.set_state(index, state).map_err(rejected)?;
        }
        Ok(())
    }

    /// Sets a parameter of all acrobots to a value from Python, or to a value for each.
    pub fn set(&mut self, name: &str, values: &[Bound<'_, PyAny>]) -> PyResult<()> {
        let mut draws = *self.batch.draws().params();
        places(name).for_each(|place| *draws.numbers_mut()[place] = Draw::Fixed);
        let draws = Draws::new(draws).map_err(rejected)?;
        let is_own = values.len() > 1 || self.batch.has_own_params();
        let count = if is_own { self.batch.len() } else { 1 };
        let mut each = Vec::with_capacity(count);
        // An acrobot alone tries them: a rejected value must change no acrobot of the batch.
        let mut alone = Acrobot::<A>::new(0);
        for (index, value) in values.iter().cycle().take(count).enumerate() {
            let index_in_name = (values.len() > 1).then_some(index);
            let name = Name(name, [index_in_name, None]);
            let params = with::<A::Scalar>(self.params(index), name, value)?;
            let given = params.cast();
            let tried = params.validate(); // its error shows the number before it is rounded
            let tried = tried.and_then(|()| alone.set_params(given));
            let tried = tried.and_then(|()| alone.draw_params(&draws));
            tried.map_err(|error| invalid(error, index_in_name))?;
            each.push(given);
        }
        if each.iter().all(|params| *params == each[0]) {
            self.batch.set_all_params(each[0])
        } else {
            self.batch.own_params().map_err(out_of_memory)?;
            let mut each = each.into_iter().enumerate();
            each.try_for_each(|(index, params)| self.batch.set_params(index, params))
        }
        .and_then(|()| self.batch.set_draws(draws))
        .map_err(rejected)
    }

    /// Sets a parameter that each reset draws.
    pub fn set_drawn(&mut self, name: &str, drawn: &Bound<'_, PyAny>) -> PyResult<()> {
        if name == "LINK_MOI" {
            let rule = "a number; a reset can draw LINK_MOI_1 and LINK_MOI_2";
            return Err(PyTypeError::new_err(must_be(name, rule, shown(drawn))));
        }
        let kind: String = drawn.getattr("_KIND")?.extract()?;
        let attributes = ["low", "high", "mean", "std"];
        let given = attributes[..if kind == "normal" { 4 } else { 2 }].iter().map(|number| {
            with::<A::Scalar>(Params::DEFAULT, Name(name, [None; 2]), &drawn.getattr(*number)?)
        });
        let given = given.collect::<PyResult<Vec<_>>>()?;
        let (mut draws, mut exact) = (*self.batch.draws().params(), Draws::FIXED);
        for place in places(name) {
            let numbers = given.iter().map(|params| params.numbers()[place].1);
            let numbers = numbers.collect::<Vec<_>>();
            *draws.numbers_mut()[place] = draw(&kind, &numbers);
            *exact.numbers_mut()[place] = draw(&kind, &numbers);
        }
        let rejected = |error| invalid(error, None);
        // Errors of an acrobot in f64 show the numbers before they are rounded.
        let mut alone = Acrobot::<Damped<Reference>>::new(0);
        let tried = alone.set_params(self.params(0)).and_then(|()| Draws::new(exact));
        tried.and_then(|exact| alone.draw_params(&exact)).map_err(rejected)?;
        let draws = Draws::new(draws).map_err(rejected)?;
        match self.batch.set_draws(draws) {
            Err(Error::SharedParams) => {
                self.batch.own_params().map_err(out_of_memory)?;
                self.batch.set_draws(draws)
            }
            result => result,
        }
        .map_err(rejected)
    }

    /// Checks the inputs of the next step and copies them.
    pub fn read(&mut self, task: AnyTask, inputs: Inputs<'_>) -> PyResult<()> {
        self.torques.clear();
        match inputs {
            Inputs::Actions(from) => {
                let from = from.as_slice()?;
                let rule = "0 (negative torque), 1 (none) or 2 (positive)";
                check(from, |action| (0..3).contains(action), rule)?;
                self.actions.clear();
                self.actions.extend(from.iter().map(|&action| action as u8));
            }
            Inputs::Torques(from) => {
                let from = from.as_slice()?;
                let rule = match task {
                    AnyTask::Swingup => "a number from -1 to 1",
                    _ => "a number, N m",
                };
                check(from, |torque| !torque.is_nan(), rule)?;
                let is_own = from.len() > 1 && self.batch.has_own_params();
                let bounds = |index| {
                    let params = self.batch.params(index).unwrap_or_default();
                    let [a, b, c] = params.torques.map(Real::to_f64);
                    (a.min(b).min(c), a.max(b).max(c))
                };
                let first = bounds(0);
                self.torques.extend(from.iter().enumerate().map(|(index, &torque)| {
                    let (low, high) = if is_own { bounds(index) } else { first };
                    A::Scalar::from_f64(torque_of(task, torque.into(), low, high))
                }));
            }
        }
        Ok(())
    }

    /// Steps on this thread, or on all threads of rayon's current pool, into the buffers.
    pub fn step(&mut self, buffers: StepBuffers<'_>, parallel: bool) -> Result<(), Error> {
        let (actions, torques) = (&self.actions, &self.torques);
        match (torques.is_empty(), parallel) {
            (true, false) => self.batch.step_into(actions, buffers),
            (true, true) => self.batch.par_step_into(actions, buffers),
            (false, false) => self.batch.step_into(torques, buffers),
            (false, true) => self.batch.par_step_into(torques, buffers),
        }
    }
}

/// A draw between two numbers, or between two with a mean and a standard deviation.
pub fn draw<S: Real>(kind: &str, numbers: &[f64]) -> Draw<S> {
    let number = |i: usize| S::from_f64(numbers[i]);
    let (low, high) = (number(0), number(1));
    match kind {
        "normal" => Draw::Normal { mean: number(2), std: number(3), low, high },
        "log_uniform" => Draw::LogUniform { low, high },
        _ => Draw::Uniform { low, high },
    }
}

/// The torque of a continuous action, N m, which is within the smallest and the largest torque. In
/// a swing-up the action 1 is the largest torque, −1 the smallest and 0 none. In other tasks
/// actions are torques.
pub fn torque_of(task: AnyTask, action: f64, low: f64, high: f64) -> f64 {
    let torque = match task {
        AnyTask::Swingup => match action.clamp(-1.0, 1.0) {
            action if action < 0.0 => action * -low,
            action => action * high,
        },
        _ => action,
    };
    torque.max(low).min(high)
}

/// Checks all inputs. There is no early exit, so that the compiler vectorizes the loop.
fn check<T: Display>(from: &[T], valid: impl Fn(&T) -> bool, rule: &str) -> PyResult<()> {
    if !from.iter().fold(true, |all, input| all & valid(input))
        && let Some((index, input)) = from.iter().enumerate().find(|(_, input)| !valid(input))
    {
        let name = format!("actions[{index}]");
        return Err(InvalidAction::new_err(must_be(name, rule, input)));
    }
    Ok(())
}

pub fn out_of_memory(error: Error) -> PyErr {
    match error {
        Error::OutOfMemory { len, .. } => {
            let rule = "so few that they fit into memory";
            PyMemoryError::new_err(must_be("num_envs", rule, len))
        }
        error => rejected(error),
    }
}
