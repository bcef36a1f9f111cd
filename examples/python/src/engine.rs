//! A batch of any arithmetic, behind one trait.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Host, Real};
use acrobot::batch::{Autoreset, Batch, Block, LaneParams, Member, StepBuffers};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::ParamsRange;
use acrobot::{Error, Fast, Params, ResetOptions, State};
use numpy::{
    PyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{ACTIONS, InvalidAction, must_be, rejected};

/// The lower and the upper bounds of all parameters. Those that are equal are not drawn.
pub type Range = [Params; 2];

/// What a batch is made of. All but `own` is fixed.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub struct Settings {
    pub num_envs: usize,
    pub limit: NonZeroU32,
    /// The index in [`MODES`].
    pub mode: usize,
    /// Whether to compute as Gymnasium does, with [`Host`].
    pub gymnasium: bool,
    /// Whether the actions are torques.
    pub continuous: bool,
    pub threads: NonZeroU32,
    /// Whether each acrobot has its own parameters, which takes more memory.
    pub own: bool,
}

/// All autoreset modes, with Gymnasium's names.
pub const MODES: [(&str, Autoreset); 3] = [
    ("NextStep", Autoreset::NextStep),
    ("SameStep", Autoreset::SameStep),
    ("Disabled", Autoreset::Disabled),
];

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

/// A batch of any arithmetic, and memory for its inputs. Numbers are `f64` here: conversions from `f32` and back are exact.
pub trait Engine: Send + Sync {
    /// Rejects what `set_params` and `set_range` reject.
    fn check(&self, range: Range) -> Result<(), Error>;
    /// Sets the parameters of an acrobot, or of all if they share them.
    fn set_params(&mut self, index: usize, params: Params) -> Result<(), Error>;
    /// The range from which resets draw parameters.
    fn range(&self) -> Option<Range>;
    /// Rejects a range if the acrobots share their parameters.
    fn set_range(&mut self, range: Option<Range>) -> Result<(), Error>;
    fn generators_mut(&mut self) -> &mut [Pcg64];
    fn state(&self, index: usize) -> Option<State>;
    fn set_state(&mut self, index: usize, state: State) -> Result<(), Error>;
    fn member(&self, index: usize) -> Option<Member<Host>>;
    fn set_member(&mut self, index: usize, member: Member<Host>) -> Result<(), Error>;
    fn reset(&mut self, options: ResetOptions, mask: Option<&[bool]>) -> Result<(), Error>;
    fn observe(&self, rows: &mut [[f32; 6]]) -> Result<(), Error>;
    /// Checks the inputs of the next step and copies them.
    fn read(&mut self, inputs: Inputs<'_>) -> PyResult<()>;
    /// Steps on this thread, or on all threads of rayon's current pool.
    fn step(&mut self, buffers: StepBuffers<'_>, parallel: bool) -> Result<(), Error>;
}

type Memory<A> = (Vec<Block<A>>, Vec<Pcg64>, Vec<LaneParams<A>>);

struct Many<A: Arithmetic> {
    batch: Batch<A, Memory<A>>,
    /// Whether each acrobot has its own parameters.
    own: bool,
    /// Empty if the actions are torques.
    actions: Vec<u8>,
    /// Empty if they are not.
    torques: Vec<A::Scalar>,
}

impl<A: Arithmetic> Many<A> {
    fn assemble(settings: &Settings, seed: SeedSequence) -> PyResult<Box<dyn Engine>> {
        let (len, own) = (settings.num_envs, settings.own);
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
        let (_, mode) = MODES.get(settings.mode).ok_or_else(|| {
            let (name, rule) = ("the snapshot's autoreset mode", MODES.len());
            PyValueError::new_err(must_be(name, format_args!("below {rule}"), settings.mode))
        })?;
        batch.set_autoreset(*mode);
        Ok(Box::new(Self {
            batch,
            own,
            actions,
            torques,
        }))
    }
}

impl<A: Arithmetic> Engine for Many<A> {
    fn check(&self, [low, high]: Range) -> Result<(), Error> {
        ParamsRange::<A::Scalar>::new(low.cast(), high.cast()).map(drop)
    }

    fn set_params(&mut self, index: usize, params: Params) -> Result<(), Error> {
        if self.own {
            self.batch.set_params_of(index, params.cast())
        } else {
            self.batch.set_params(params.cast())
        }
    }

    fn range(&self) -> Option<Range> {
        let range = self.batch.params_range()?;
        Some([range.low().cast(), range.high().cast()])
    }

    fn set_range(&mut self, range: Option<Range>) -> Result<(), Error> {
        let cast = |[low, high]: Range| ParamsRange::new(low.cast(), high.cast());
        self.batch.set_params_range(range.map(cast).transpose()?)
    }

    fn generators_mut(&mut self) -> &mut [Pcg64] {
        self.batch.generators_mut()
    }

    fn state(&self, index: usize) -> Option<State> {
        self.batch.state(index).map(State::cast)
    }

    fn set_state(&mut self, index: usize, state: State) -> Result<(), Error> {
        self.batch.set_state(index, state.cast())
    }

    fn member(&self, index: usize) -> Option<Member<Host>> {
        self.batch.member(index).map(converted)
    }

    fn set_member(&mut self, index: usize, member: Member<Host>) -> Result<(), Error> {
        self.batch.set_member(index, converted(member))
    }

    fn reset(&mut self, options: ResetOptions, mask: Option<&[bool]>) -> Result<(), Error> {
        match mask {
            Some(mask) => self.batch.reset_masked(mask, options),
            None => {
                self.batch.reset_with(options);
                Ok(())
            }
        }
    }

    fn observe(&self, rows: &mut [[f32; 6]]) -> Result<(), Error> {
        self.batch.observe(rows)
    }

    fn read(&mut self, inputs: Inputs<'_>) -> PyResult<()> {
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

    fn step(&mut self, buffers: StepBuffers<'_>, parallel: bool) -> Result<(), Error> {
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

/// An engine with these settings.
pub fn assemble(settings: &Settings, seed: SeedSequence) -> PyResult<Box<dyn Engine>> {
    if settings.gymnasium {
        Many::<Host>::assemble(settings, seed)
    } else {
        Many::<Fast>::assemble(settings, seed)
    }
}

/// `len` copies of a value, if they fit into memory.
pub fn memory<T: Clone>(value: T, len: usize) -> Option<Vec<T>> {
    let mut memory = Vec::new();
    memory.try_reserve_exact(len).ok()?;
    memory.resize(len, value);
    Some(memory)
}
