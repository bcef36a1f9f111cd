//! A batch of one of nine pairs of arithmetic and task.

use acrobot::arithmetic::{Arithmetic, Damped, Host, Real, Reference};
use acrobot::batch::{StepBuffers, VecBatch};
use acrobot::numpy::SeedSequence;
use acrobot::task::{Balance, Draw, Draws, Gymnasium, Swingup, Task};
use acrobot::{Acrobot, Error, Fast, State};
use numpy::{
    PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{
    InvalidAction, Name, Params, check_states, invalid, load, must_be, places, rejected, to_bytes,
    torque_of, with,
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

#[derive(Serialize, Deserialize)]
pub enum Engine {
    Fast(Many<Fast>),
    DampedFast(Many<Damped<Fast>>),
    /// Computes as Gymnasium does, without friction.
    Host(Many<Host>),
    Swingup(Many<Damped<Fast>, Swingup>),
    Balance(Many<Damped<Fast>, Balance>),
    Reference(Many<Reference>),
    DampedReference(Many<Damped<Reference>>),
    ReferenceSwingup(Many<Damped<Reference>, Swingup>),
    ReferenceBalance(Many<Damped<Reference>, Balance>),
}

impl Engine {
    pub fn new(name: &str, len: usize, seed: SeedSequence) -> PyResult<Self> {
        Ok(match name {
            "gymnasium" => Self::Host(Many::new(len, seed)?),
            "swingup" => Self::Swingup(Many::new(len, seed)?),
            "balance" => Self::Balance(Many::new(len, seed)?),
            "acrobot_float64" => Self::Reference(Many::new(len, seed)?),
            "swingup_float64" => Self::ReferenceSwingup(Many::new(len, seed)?),
            "balance_float64" => Self::ReferenceBalance(Many::new(len, seed)?),
            _ => Self::Fast(Many::new(len, seed)?),
        })
    }

    /// Changes a parameter. Gymnasium's task has an arithmetic with friction only where there is
    /// friction, because the other one saves time.
    pub fn change(
        &mut self,
        name: &str,
        change: impl Fn(&mut Self) -> PyResult<()>,
    ) -> PyResult<()> {
        let changed = change(self);
        if !name.starts_with("FRICTION") {
            return changed;
        }
        if let Err(error) = changed {
            let mut damped = match self {
                Self::Fast(many) => Self::DampedFast(converted(many)?),
                Self::Reference(many) => Self::DampedReference(converted(many)?),
                _ => return Err(error),
            };
            change(&mut damped)?;
            *self = damped;
        }
        let undamped = match self {
            Self::DampedFast(many) => converted(many).map(Self::Fast),
            Self::DampedReference(many) => converted(many).map(Self::Reference),
            _ => return Ok(()),
        };
        // It fails where there is friction.
        if let Ok(undamped) = undamped {
            *self = undamped;
        }
        Ok(())
    }
}

/// The same batch in the arithmetic with friction, or in that without: both have one snapshot.
fn converted<A: Arithmetic, B: Arithmetic>(many: &Many<A>) -> PyResult<Many<B>> {
    load(&to_bytes(many)?)
}

/// Does something with the batch in an engine, whatever its arithmetic and task.
macro_rules! with_batch {
    ($engine:expr, $many:ident => $result:expr) => {
        match $engine {
            $crate::engine::Engine::Fast($many) => $result,
            $crate::engine::Engine::DampedFast($many) => $result,
            $crate::engine::Engine::Host($many) => $result,
            $crate::engine::Engine::Swingup($many) => $result,
            $crate::engine::Engine::Balance($many) => $result,
            $crate::engine::Engine::Reference($many) => $result,
            $crate::engine::Engine::DampedReference($many) => $result,
            $crate::engine::Engine::ReferenceSwingup($many) => $result,
            $crate::engine::Engine::ReferenceBalance($many) => $result,
        }
    };
}
pub(crate) use with_batch;

/// A batch, and memory for its inputs. Numbers are `f64` outside, which `f32` becomes exactly.
#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Many<A: Arithmetic, T: Task = Gymnasium> {
    pub batch: VecBatch<A, T>,
    #[serde(skip)]
    actions: Vec<u8>,
    /// Empty if the inputs of the next step are actions.
    #[serde(skip)]
    torques: Vec<A::Scalar>,
}

impl<A: Arithmetic, T: Task> Many<A, T> {
    pub fn new(len: usize, seed: SeedSequence) -> PyResult<Self> {
        let batch = VecBatch::new(seed, len).map_err(out_of_memory)?;
        Ok(Self { batch, actions: Vec::new(), torques: Vec::new() })
    }

    pub fn params(&self, index: usize) -> Params {
        self.batch.params_of(index).unwrap_or_default().cast()
    }

    pub fn state(&self, index: usize) -> State {
        self.batch.state_of(index).unwrap_or_default().cast()
    }

    /// Sets all states, if all are valid.
    pub fn set_states(&mut self, states: &[[f64; 4]]) -> PyResult<()> {
        check_states::<A::Scalar>(states)?;
        for (index, state) in states.iter().enumerate() {
            let state = State::from(*state).cast();
            self.batch.set_state_of(index, state).map_err(rejected)?;
        }
        Ok(())
    }

    /// The draws, of which one is to change. That of `LINK_MOI` becomes one of each link.
    fn draws_beside(&self, name: &str) -> Params<Draw<A::Scalar>> {
        let mut draws = *self.batch.draws().params();
        if name == "LINK_MOI_1" && draws.inertia2 == Draw::<A::Scalar>::AsBefore {
            draws.inertia2 = draws.inertia1;
        }
        draws
    }

    /// Sets a parameter of all acrobots to a value from Python, or to a value for each.
    pub fn set(&mut self, name: &str, values: &[Bound<'_, PyAny>]) -> PyResult<()> {
        let mut draws = self.draws_beside(name);
        places(name).for_each(|place| *draws.numbers_mut()[place] = Draw::Fixed);
        let draws = Draws::new(draws).map_err(rejected)?;
        let is_own = values.len() > 1 || self.batch.has_own_params();
        let count = if is_own { self.batch.len() } else { 1 };
        let mut each = Vec::with_capacity(count);
        // An acrobot alone tries them: a rejected value must change no acrobot of the batch.
        let mut alone = Acrobot::<A, T>::new(0);
        for (index, value) in values.iter().cycle().take(count).enumerate() {
            let index_in_name = (values.len() > 1).then_some(index);
            let name = Name(name, [index_in_name, None]);
            let given = with::<A::Scalar>(self.params(index), name, value)?.cast();
            let tried = alone.set_params(given).and_then(|()| alone.draw_params(&draws));
            tried.map_err(|error| invalid(error, index_in_name))?;
            each.push(given);
        }
        if each.iter().all(|params| *params == each[0]) {
            self.batch.set_params(each[0])
        } else {
            self.batch.own_params().map_err(out_of_memory)?;
            let mut each = each.into_iter().enumerate();
            each.try_for_each(|(index, params)| self.batch.set_params_of(index, params))
        }
        .and_then(|()| self.batch.set_draws(draws))
        .map_err(rejected)
    }

    /// Sets a parameter that each reset draws.
    pub fn set_drawn(&mut self, name: &str, drawn: &Bound<'_, PyAny>) -> PyResult<()> {
        let kind = drawn.get_type().name()?.to_string();
        let numbers: &[&str] = match kind.as_str() {
            "Normal" => &["low", "high", "mean", "std"],
            _ => &["low", "high"],
        };
        let given = numbers.iter().map(|&number| {
            with::<A::Scalar>(Params::DEFAULT, Name(name, [None; 2]), &drawn.getattr(number)?)
        });
        let given = given.collect::<PyResult<Vec<_>>>()?;
        let mut draws = self.draws_beside(name);
        for place in places(name) {
            let number = |i: usize| A::Scalar::from_f64(given[i].numbers()[place].1);
            let (low, high) = (number(0), number(1));
            *draws.numbers_mut()[place] = match kind.as_str() {
                "Normal" => Draw::Normal { mean: number(2), std: number(3), low, high },
                "LogUniform" => Draw::LogUniform { low, high },
                _ => Draw::Uniform { low, high },
            };
        }
        if name == "LINK_MOI" {
            draws.inertia2 = Draw::AsBefore;
        }
        let rejected = |error| invalid(error, None);
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
    pub fn read(&mut self, inputs: Inputs<'_>) -> PyResult<()> {
        match inputs {
            Inputs::Actions(from) => {
                self.torques.clear();
                read(
                    from.as_slice()?,
                    &mut self.actions,
                    |action| (0..3).contains(action),
                    |_, action| action as u8,
                    "0 (negative torque), 1 (none) or 2 (positive)",
                )
            }
            Inputs::Torques(from) => {
                let is_own = from.len() > 1 && self.batch.has_own_params();
                let bounds = |index| {
                    let params = self.batch.params_of(index).unwrap_or_default();
                    let [a, b, c] = params.torques.map(Real::to_f64);
                    (a.min(b).min(c), a.max(b).max(c))
                };
                let first = bounds(0);
                read(
                    from.as_slice()?,
                    &mut self.torques,
                    |torque| !torque.is_nan(),
                    |index, torque| {
                        let (low, high) = if is_own { bounds(index) } else { first };
                        A::Scalar::from_f64(torque_of(T::NAME, torque.into(), low, high))
                    },
                    if T::NAME == Swingup::NAME {
                        "a number from -1 to 1"
                    } else {
                        "a number, N m"
                    },
                )
            }
        }
    }

    /// Steps on this thread, or on all threads of rayon's current pool, into the buffers.
    pub fn step(
        &mut self,
        buffers: StepBuffers<'_, T::Observation>,
        parallel: bool,
    ) -> Result<(), Error> {
        let (actions, torques) = (&self.actions, &self.torques);
        match (torques.is_empty(), parallel) {
            (true, false) => self.batch.step_into(actions, buffers),
            (true, true) => self.batch.par_step_into(actions, buffers),
            (false, false) => self.batch.step_into(torques, buffers),
            (false, true) => self.batch.par_step_into(torques, buffers),
        }
    }
}

/// Checks all inputs, then converts them.
fn read<T: Copy + std::fmt::Display, U>(
    from: &[T],
    to: &mut Vec<U>,
    valid: impl Fn(&T) -> bool,
    convert: impl Fn(usize, T) -> U,
    rule: &str,
) -> PyResult<()> {
    // No early exit, so that the compiler vectorizes the loop.
    if !from.iter().fold(true, |all, input| all & valid(input))
        && let Some((index, input)) = from.iter().enumerate().find(|(_, input)| !valid(input))
    {
        let name = format!("actions[{index}]");
        return Err(InvalidAction::new_err(must_be(&name, rule, input)));
    }
    to.clear();
    reserve(to, from.len())?;
    to.extend(from.iter().enumerate().map(|(index, &input)| convert(index, input)));
    Ok(())
}

/// `len` copies of a value.
pub fn memory<T: Clone>(value: T, len: usize) -> PyResult<Vec<T>> {
    let mut memory = Vec::new();
    reserve(&mut memory, len)?;
    memory.resize(len, value);
    Ok(memory)
}

fn reserve<T>(memory: &mut Vec<T>, len: usize) -> PyResult<()> {
    let no_memory = |_| PyMemoryError::new_err("a step does not fit into memory");
    memory.try_reserve_exact(len).map_err(no_memory)
}

fn out_of_memory(error: Error) -> PyErr {
    match error {
        Error::OutOfMemory { len } => {
            let rule = "so few that they fit into memory";
            PyMemoryError::new_err(must_be("num_envs", rule, len))
        }
        error => rejected(error),
    }
}
