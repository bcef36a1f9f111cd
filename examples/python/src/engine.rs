//! A batch of any arithmetic, behind one trait.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Host, Real};
use acrobot::batch::{Autoreset, Batch, Block, LaneParams, Member, StepBuffers};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::ParamsRange;
use acrobot::{Error, Fast, Params};
use numpy::{
    PyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{ACTIONS, InvalidAction, must_be, rejected};

/// The lower and the upper bounds of all parameters. Those that are equal are not drawn.
pub type Range = [Params; 2];

/// What a batch is made of.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub struct Settings {
    pub num_envs: usize,
    pub limit: NonZeroU32,
    pub mode: Autoreset,
    /// Whether to compute as Gymnasium does, with [`Host`].
    pub gymnasium: bool,
    /// Whether the actions are torques.
    pub continuous: bool,
    pub threads: NonZeroU32,
}

/// Actions (0, 1 or 2), or torques, N m.
#[derive(FromPyObject)]
pub enum Inputs<'py> {
    Actions(PyReadonlyArray1<'py, i64>),
    Torques(PyReadonlyArray2<'py, f32>),
}

impl<'py> Inputs<'py> {
    /// The actions, if no conversion is necessary.
    pub fn of(actions: &Bound<'py, PyAny>, len: usize, continuous: bool) -> Option<Self> {
        if !continuous {
            let actions = actions.cast::<PyArray1<i64>>().ok()?;
            let fits = actions.len() == len && is_slice(actions);
            return fits.then(|| Some(Self::Actions(actions.try_readonly().ok()?)))?;
        }
        let torques = actions.cast::<PyArray2<f32>>().ok()?;
        let fits = torques.shape() == [len, 1] && is_slice(torques);
        fits.then(|| Some(Self::Torques(torques.try_readonly().ok()?)))?
    }
}

/// Whether Rust can read the elements: an array over packed bytes is not aligned.
fn is_slice<T, D>(array: &Bound<'_, PyArray<T, D>>) -> bool {
    array.is_c_contiguous() && array.data().is_aligned()
}

/// A batch of one of the two arithmetics.
pub enum Engine {
    Fast(Many<Fast>),
    Host(Many<Host>),
}

impl Engine {
    /// With `own`, each acrobot has its own parameters, which takes more memory.
    pub fn new(settings: &Settings, own: bool, seed: SeedSequence) -> PyResult<Self> {
        Ok(if settings.gymnasium {
            Self::Host(Many::new(settings, own, seed)?)
        } else {
            Self::Fast(Many::new(settings, own, seed)?)
        })
    }
}

/// Does something with the batch in an engine, whatever its arithmetic.
macro_rules! with_batch {
    ($engine:expr, $many:ident => $result:expr) => {
        match $engine {
            $crate::engine::Engine::Fast($many) => $result,
            $crate::engine::Engine::Host($many) => $result,
        }
    };
}
pub(crate) use with_batch;

type Memory<A> = (Vec<Block<A>>, Vec<Pcg64>, Vec<LaneParams<A>>);

/// A batch, and memory for its inputs. Numbers are `f64` outside: conversions from `f32` and back are exact.
pub struct Many<A: Arithmetic> {
    pub batch: Batch<A, Memory<A>>,
    /// Whether each acrobot has its own parameters.
    pub own: bool,
    /// Empty if the actions are torques.
    actions: Vec<u8>,
    /// Empty if they are not.
    torques: Vec<A::Scalar>,
}

impl<A: Arithmetic> Many<A> {
    fn new(settings: &Settings, own: bool, seed: SeedSequence) -> PyResult<Self> {
        let len = settings.num_envs;
        let blocks = len.div_ceil(Block::<A>::LANES);
        let (actions, torques) = if settings.continuous {
            (0, len)
        } else {
            (len, 0)
        };
        let allocate = || {
            let storage = (
                memory(Block::EMPTY, blocks)?,
                memory(Pcg64::UNSEEDED, len)?,
                memory(LaneParams::default(), if own { blocks } else { 0 })?,
            );
            let inputs = (memory(0, actions)?, memory(A::Scalar::ZERO, torques)?);
            Some((storage, inputs))
        };
        let (storage, (actions, torques)) = allocate().ok_or_else(|| {
            let rule = "so few that they fit into memory";
            PyMemoryError::new_err(must_be("num_envs", rule, len))
        })?;
        let mut batch = Batch::new(seed, storage).map_err(rejected)?;
        batch.set_limit(settings.limit);
        batch.set_autoreset(settings.mode);
        Ok(Self {
            batch,
            own,
            actions,
            torques,
        })
    }

    /// Rejects what `set_params` and `set_range` reject.
    pub fn check(&self, [low, high]: Range) -> Result<(), Error> {
        ParamsRange::<A::Scalar>::new(low.cast(), high.cast()).map(drop)
    }

    /// Sets the parameters of an acrobot, or of all if they share them.
    pub fn set_params(&mut self, index: usize, params: Params) -> Result<(), Error> {
        if self.own {
            self.batch.set_params_of(index, params.cast())
        } else {
            self.batch.set_params(params.cast())
        }
    }

    /// The range from which resets draw parameters.
    pub fn range(&self) -> Option<Range> {
        let range = self.batch.params_range()?;
        Some([range.low().cast(), range.high().cast()])
    }

    /// Rejects a range if the acrobots share their parameters.
    pub fn set_range(&mut self, range: Option<Range>) -> Result<(), Error> {
        let cast = |[low, high]: Range| ParamsRange::new(low.cast(), high.cast());
        self.batch.set_params_range(range.map(cast).transpose()?)
    }

    pub fn member(&self, index: usize) -> Option<Member<Host>> {
        self.batch.member(index).map(converted)
    }

    pub fn set_member(&mut self, index: usize, member: Member<Host>) -> Result<(), Error> {
        self.batch.set_member(index, converted(member))
    }

    /// Checks the inputs of the next step and copies them.
    pub fn read(&mut self, inputs: Inputs<'_>) -> PyResult<()> {
        match inputs {
            Inputs::Actions(from) => read(
                from.as_slice()?,
                &mut self.actions,
                |action| (0..3).contains(action),
                |_, action| action as u8,
                ACTIONS,
            ),
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
                        A::Scalar::from_f64(f64::from(torque).max(low).min(high))
                    },
                    "a number, N m",
                )
            }
        }
    }

    /// Steps on this thread, or on all threads of rayon's current pool.
    pub fn step(&mut self, buffers: StepBuffers<'_>, parallel: bool) -> Result<(), Error> {
        let (batch, actions, torques) = (&mut self.batch, &self.actions, &self.torques);
        match (torques.is_empty(), parallel) {
            (true, false) => batch.step(actions, buffers),
            (true, true) => batch.par_step(actions, buffers),
            (false, false) => batch.step(torques, buffers),
            (false, true) => batch.par_step(torques, buffers),
        }
    }
}

/// Checks all inputs, then converts them.
fn read<T: Copy + std::fmt::Display, U>(
    from: &[T],
    to: &mut [U],
    valid: impl Fn(&T) -> bool,
    convert: impl Fn(usize, T) -> U,
    rule: &str,
) -> PyResult<()> {
    if from.len() != to.len() {
        let message = format!(
            "actions must have {} elements, got {}",
            to.len(),
            from.len()
        );
        return Err(InvalidAction::new_err(message));
    }
    // No early exit, so that the compiler vectorizes the loop.
    if !from.iter().fold(true, |all, input| all & valid(input))
        && let Some((index, input)) = from.iter().enumerate().find(|(_, input)| !valid(input))
    {
        let name = format!("actions[{index}]");
        return Err(InvalidAction::new_err(must_be(&name, rule, input)));
    }
    for (index, (to, &input)) in to.iter_mut().zip(from).enumerate() {
        *to = convert(index, input);
    }
    Ok(())
}

/// The same member in another arithmetic. Exact from `f32` to `f64` and back.
fn converted<A: Arithmetic, B: Arithmetic>(member: Member<A>) -> Member<B> {
    Member {
        params: member.params.cast(),
        state: member.state.cast(),
        elapsed: member.elapsed,
        reset_pending: member.reset_pending,
        rng: member.rng,
    }
}

/// `len` copies of a value, if they fit into memory.
pub fn memory<T: Clone>(value: T, len: usize) -> Option<Vec<T>> {
    let mut memory = Vec::new();
    memory.try_reserve_exact(len).ok()?;
    memory.resize(len, value);
    Some(memory)
}
