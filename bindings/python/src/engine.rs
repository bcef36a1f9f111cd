//! A batch of one of seven pairs of arithmetic and task.

use std::ops::DerefMut;

use acrobot::arithmetic::{Arithmetic, Damped, Host, Real, Reference};
use acrobot::batch::{StepBuffers, VecBatch};
use acrobot::numpy::SeedSequence;
use acrobot::task::{Gymnasium, ParamsRange, Swingup, SwingupSparse, Task};
use acrobot::{Error, Fast, State};
use numpy::{
    PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::draws::{Distribution, Draws};
use crate::{InvalidAction, NUMBERS, Params, invalid, must_be, rejected, torque_of, unknown, with};

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
    /// Computes as Gymnasium does.
    Host(Many<Host>),
    Swingup(Many<Damped<Fast>, Swingup>),
    SwingupSparse(Many<Damped<Fast>, SwingupSparse>),
    Reference(Many<Reference>),
    ReferenceSwingup(Many<Damped<Reference>, Swingup>),
    ReferenceSwingupSparse(Many<Damped<Reference>, SwingupSparse>),
}

impl Engine {
    pub fn new(name: &str, len: usize, seed: SeedSequence) -> PyResult<Self> {
        Ok(match name {
            "acrobot" => Self::Fast(Many::new(len, seed)?),
            "gymnasium" => Self::Host(Many::new(len, seed)?),
            "swingup" => Self::Swingup(Many::new(len, seed)?),
            "swingup_sparse" => Self::SwingupSparse(Many::new(len, seed)?),
            "acrobot_float64" => Self::Reference(Many::new(len, seed)?),
            "swingup_float64" => Self::ReferenceSwingup(Many::new(len, seed)?),
            "swingup_sparse_float64" => Self::ReferenceSwingupSparse(Many::new(len, seed)?),
            other => return Err(unknown("engine", "the name of an engine", other)),
        })
    }
}

/// Does something with the batch in an engine, whatever its arithmetic and task.
macro_rules! with_batch {
    ($engine:expr, $many:ident => $result:expr) => {
        match $engine {
            $crate::engine::Engine::Fast($many) => $result,
            $crate::engine::Engine::Host($many) => $result,
            $crate::engine::Engine::Swingup($many) => $result,
            $crate::engine::Engine::SwingupSparse($many) => $result,
            $crate::engine::Engine::Reference($many) => $result,
            $crate::engine::Engine::ReferenceSwingup($many) => $result,
            $crate::engine::Engine::ReferenceSwingupSparse($many) => $result,
        }
    };
}
pub(crate) use with_batch;

/// A batch, and memory for its inputs. Numbers are `f64` outside, which `f32` becomes exactly.
#[derive(Serialize, Deserialize)]
#[serde(bound(serialize = "A::Scalar: Serialize", deserialize = "A::Scalar: Deserialize<'de>"))]
pub struct Many<A: Arithmetic, T: Task = Gymnasium> {
    pub batch: VecBatch<A, T>,
    /// Whether each acrobot has its own parameters, which takes more memory.
    pub own: bool,
    pub draws: Draws,
    #[serde(skip)]
    actions: Vec<u8>,
    /// Empty if the inputs of the next step are actions.
    #[serde(skip)]
    torques: Vec<A::Scalar>,
}

impl<A: Arithmetic, T: Task> Many<A, T> {
    pub fn new(len: usize, seed: SeedSequence) -> PyResult<Self> {
        Ok(Self {
            batch: VecBatch::new(seed, len).map_err(out_of_memory)?,
            own: false,
            draws: Draws::default(),
            actions: Vec::new(),
            torques: Vec::new(),
        })
    }

    pub fn params(&self, index: usize) -> Params {
        self.batch.params_of(index).unwrap_or_default().cast()
    }

    pub fn state(&self, index: usize) -> State {
        self.batch.state(index).unwrap_or_default().cast()
    }

    /// The parameters with one of them changed.
    pub fn with(&self, params: Params, name: &str, value: &Bound<'_, PyAny>) -> PyResult<Params> {
        with(T::NAME, params, name, value)
    }

    /// The parameters of all acrobots, or one for all if they share them.
    pub fn all_params(&self) -> Vec<Params> {
        let count = if self.own { self.batch.len() } else { 1 };
        (0..count).map(|index| self.params(index)).collect()
    }

    /// The draws of resets with one more parameter.
    pub fn drawing(
        &self,
        name: &str,
        distribution: Distribution,
        [low, high]: [Bound<'_, PyAny>; 2],
    ) -> PyResult<Draws> {
        let mut draws = self.draws.clone();
        let [lows, highs] = draws.ends(self.params(0));
        let bounds = [self.with(lows, name, &low)?, self.with(highs, name, &high)?];
        Self::check_range(bounds)?;
        draws.bounds = bounds.map(|bound| bound.cast::<A::Scalar>().cast());
        draws.distributions.insert(name.to_owned(), distribution);
        Ok(draws)
    }

    /// Checks the parameters of an acrobot, with all that these draws can make of them.
    pub fn check(&self, params: Params, draws: &Draws) -> PyResult<()> {
        Self::check_range(draws.ends(params))
    }

    fn check_range(ends: [Params; 2]) -> PyResult<()> {
        let [low, high] = ends.map(|end| end.cast::<A::Scalar>());
        ParamsRange::new(low, high).map(drop).map_err(|error| {
            let mut message = error.to_string();
            for (_, own, field) in &NUMBERS {
                for mut end in ends {
                    let given = *field(&mut end);
                    let held = A::Scalar::from_f64(given).to_f64();
                    let is_lost = held.is_infinite() || held == 0.0 && given != 0.0;
                    // Names the number given, not the infinity or the 0 that it becomes.
                    if is_lost && given.is_finite() && message.starts_with(own) {
                        let rule = "in the range of float32, from 1.2e-38 to 3.4e38";
                        message = must_be(own, rule, format_args!("{given:?}"));
                    }
                }
            }
            invalid(T::NAME, message)
        })
    }

    /// Sets the parameters of all acrobots, or one for all if they are the same, and the draws of
    /// resets. Gives each acrobot its own parameters if necessary.
    pub fn change(&mut self, params: &[Params], draws: Draws) -> PyResult<()> {
        for each in params {
            self.check(*each, &draws)?;
        }
        let bits = |params: &Params| {
            let numbers = NUMBERS.map(|(.., field)| field(&mut { *params }).to_bits());
            (params.dynamics, numbers)
        };
        let own = !draws.distributions.is_empty()
            || params.iter().any(|each| bits(each) != bits(&params[0]));
        if own && !self.own {
            self.batch = self.owning()?;
            self.own = true;
        }
        for index in 0..if self.own { self.batch.len() } else { 1 } {
            let params = params.get(index).unwrap_or(&params[0]).cast();
            if self.own {
                self.batch.set_params_of(index, params)
            } else {
                self.batch.set_params(params)
            }
            .map_err(|error| invalid(T::NAME, error))?;
        }
        self.draws = draws;
        Ok(())
    }

    /// Draws the parameters of acrobots that were reset. A range of the crate would have one
    /// distribution, another LINK_MOI for each link, and no different values.
    pub fn draw(
        &mut self,
        were_reset: impl Fn(&VecBatch<A, T>, usize) -> bool,
    ) -> Result<(), Error> {
        if self.draws.distributions.is_empty() {
            return Ok(());
        }
        for index in 0..self.batch.len() {
            if were_reset(&self.batch, index) {
                let params = self.params(index);
                let rng = &mut self.batch.generators_mut()[index];
                let drawn = self.draws.draw(params, rng);
                self.batch.set_params_of(index, drawn.cast())?;
            }
        }
        Ok(())
    }

    /// The same batch with memory for the parameters of each acrobot.
    fn owning(&self) -> PyResult<VecBatch<A, T>> {
        let seed = SeedSequence::new(0);
        let mut batch = VecBatch::with_own_params(seed, self.batch.len()).map_err(out_of_memory)?;
        batch.set_limit(self.batch.limit());
        batch.set_autoreset(self.batch.autoreset());
        for index in 0..batch.len() {
            if let Some(member) = self.batch.member(index) {
                batch.set_member(index, member).map_err(rejected)?;
            }
        }
        Ok(batch)
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
                        let (low, high) = if self.own { bounds(index) } else { first };
                        A::Scalar::from_f64(torque_of(T::NAME, torque.into(), low, high))
                    },
                    if T::NAME == Gymnasium::NAME {
                        "a number, N m"
                    } else {
                        "a number from -1 to 1"
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
        let batch = self.batch.deref_mut();
        match (torques.is_empty(), parallel) {
            (true, false) => batch.step(actions, buffers),
            (true, true) => batch.par_step(actions, buffers),
            (false, false) => batch.step(torques, buffers),
            (false, true) => batch.par_step(torques, buffers),
        }?;
        self.draw(|batch, index| batch.elapsed(index) == Some(0))
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
