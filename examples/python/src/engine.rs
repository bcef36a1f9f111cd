//! A batch of any arithmetic, with shared or own parameters, behind one trait.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Host, Real};
use acrobot::batch::{
    Autoreset, Block, Member, Observations, OwnParams, ParamsKind, SharedParams, StepBuffers,
};
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
    fn params(&self, index: usize) -> Option<Params>;
    /// Rejects what `set_params` rejects.
    fn check(&self, params: Params) -> Result<(), Error>;
    /// Sets the parameters of an acrobot, or of all if they share them.
    fn set_params(&mut self, index: usize, params: Params) -> Result<(), Error>;
    /// Rejects what `set_range` rejects.
    fn check_range(&self, range: Range) -> Result<(), Error>;
    /// Draws parameters from a range, if the acrobots do not share them.
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
    fn step(&mut self, buffers: StepBuffers<'_>) -> Result<(), Error>;
    /// As `step`, on all threads of rayon's current pool.
    fn par_step(&mut self, buffers: StepBuffers<'_>) -> Result<(), Error>;
}

type Acrobots<A, P> = acrobot::batch::Batch<A, Vec<Block<A, 16, P>>, Vec<Pcg64>, 16, P>;

/// How to access the parameters of a batch.
trait Access<A: Arithmetic>: ParamsKind<A> {
    /// Whether each acrobot has its own.
    const OWN: bool;

    fn params(batch: &Acrobots<A, Self>, index: usize) -> Option<&Params<A::Scalar>>;
    fn set_params(
        batch: &mut Acrobots<A, Self>,
        index: usize,
        params: Params<A::Scalar>,
    ) -> Result<(), Error>;
    fn set_range(batch: &mut Acrobots<A, Self>, range: Option<ParamsRange<A::Scalar>>);
}

impl<A: Arithmetic> Access<A> for SharedParams {
    const OWN: bool = false;

    fn params(batch: &Acrobots<A, Self>, _: usize) -> Option<&Params<A::Scalar>> {
        Some(batch.params())
    }

    fn set_params(
        batch: &mut Acrobots<A, Self>,
        _: usize,
        params: Params<A::Scalar>,
    ) -> Result<(), Error> {
        batch.set_params(params)
    }

    fn set_range(_: &mut Acrobots<A, Self>, _: Option<ParamsRange<A::Scalar>>) {}
}

impl<A: Arithmetic> Access<A> for OwnParams {
    const OWN: bool = true;

    fn params(batch: &Acrobots<A, Self>, index: usize) -> Option<&Params<A::Scalar>> {
        batch.params_of(index)
    }

    fn set_params(
        batch: &mut Acrobots<A, Self>,
        index: usize,
        params: Params<A::Scalar>,
    ) -> Result<(), Error> {
        batch.set_params_of(index, params)
    }

    fn set_range(batch: &mut Acrobots<A, Self>, range: Option<ParamsRange<A::Scalar>>) {
        batch.set_params_range(range);
    }
}

struct Many<A: Arithmetic, P: Access<A>> {
    batch: Acrobots<A, P>,
    /// Empty if the actions are torques.
    actions: Vec<u8>,
    /// Empty if they are not.
    torques: Vec<A::Scalar>,
}

impl<A: Arithmetic, P: Access<A> + 'static> Many<A, P> {
    /// `None` if it does not fit into memory.
    fn assemble(settings: &Settings, seed: SeedSequence) -> PyResult<Option<Box<dyn Engine>>> {
        let len = settings.num_envs;
        let (actions, torques) = if settings.continuous {
            (0, len)
        } else {
            (len, 0)
        };
        let (Some(blocks), Some(generators), Some(actions), Some(torques)) = (
            memory(Block::EMPTY, len.div_ceil(16)),
            memory(Pcg64::UNSEEDED, len),
            memory(0, actions),
            memory(A::Scalar::ZERO, torques),
        ) else {
            return Ok(None);
        };
        let mut batch =
            acrobot::batch::Batch::with_seed(seed, blocks, generators).map_err(rejected)?;
        batch.set_limit(settings.limit);
        let mode = MODES.get(settings.mode).ok_or_else(|| {
            let rule = format_args!("below {}", MODES.len());
            PyValueError::new_err(must_be(
                "the snapshot's autoreset mode",
                rule,
                settings.mode,
            ))
        });
        batch.set_autoreset(mode?.1);
        Ok(Some(Box::new(Self {
            batch,
            actions,
            torques,
        })))
    }
}

impl<A: Arithmetic, P: Access<A>> Engine for Many<A, P> {
    fn params(&self, index: usize) -> Option<Params> {
        P::params(&self.batch, index).map(Params::cast)
    }

    fn check(&self, params: Params) -> Result<(), Error> {
        params.cast::<A::Scalar>().validate()
    }

    fn set_params(&mut self, index: usize, params: Params) -> Result<(), Error> {
        P::set_params(&mut self.batch, index, params.cast())
    }

    fn check_range(&self, range: Range) -> Result<(), Error> {
        cast::<A::Scalar>(range).map(drop)
    }

    fn set_range(&mut self, range: Option<Range>) -> Result<(), Error> {
        P::set_range(&mut self.batch, range.map(cast).transpose()?);
        Ok(())
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
        self.batch.observe(Observations::Rows(rows))
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
                    let params = P::params(&self.batch, index).copied().unwrap_or_default();
                    let [a, b, c] = params.torques.map(Real::to_f64);
                    (a.min(b).min(c), a.max(b).max(c))
                };
                let first = bounds(0);
                read(
                    from.as_slice()?,
                    &mut self.torques,
                    |torque| !torque.is_nan(),
                    |index, torque| {
                        let (low, high) = if P::OWN { bounds(index) } else { first };
                        A::Scalar::from_f64(f64::from(torque).max(low).min(high))
                    },
                    "a number, N m",
                )
            }
        }
    }

    fn step(&mut self, buffers: StepBuffers<'_>) -> Result<(), Error> {
        if self.torques.is_empty() {
            self.batch.step(&self.actions, buffers)
        } else {
            self.batch.step(&self.torques, buffers)
        }
    }

    fn par_step(&mut self, buffers: StepBuffers<'_>) -> Result<(), Error> {
        if self.torques.is_empty() {
            self.batch.par_step(&self.actions, buffers)
        } else {
            self.batch.par_step(&self.torques, buffers)
        }
    }
}

fn cast<R: Real>([low, high]: Range) -> Result<ParamsRange<R>, Error> {
    ParamsRange::new(low.cast(), high.cast())
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
        state: member.state.cast(),
        elapsed: member.elapsed,
        ended: member.ended,
        rng: member.rng,
    }
}

/// An engine with these settings, if it fits into memory.
pub fn assemble(settings: &Settings, seed: SeedSequence) -> PyResult<Box<dyn Engine>> {
    let engine: Option<Box<dyn Engine>> = match (settings.gymnasium, settings.own) {
        (false, false) => Many::<Fast, SharedParams>::assemble(settings, seed)?,
        (false, true) => Many::<Fast, OwnParams>::assemble(settings, seed)?,
        (true, false) => Many::<Host, SharedParams>::assemble(settings, seed)?,
        (true, true) => Many::<Host, OwnParams>::assemble(settings, seed)?,
    };
    engine.ok_or_else(|| {
        let rule = "so few that they fit into memory";
        PyMemoryError::new_err(must_be("num_envs", rule, settings.num_envs))
    })
}

/// `len` copies of a value, if they fit into memory.
pub fn memory<T: Clone>(value: T, len: usize) -> Option<Vec<T>> {
    let mut memory = Vec::new();
    memory.try_reserve_exact(len).ok()?;
    memory.resize(len, value);
    Some(memory)
}
