//! The vector environment: steps many acrobots at once.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Host, Real};
use acrobot::batch::{Autoreset, Block, Member, Observations, StepBuffers};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::ResetBounds;
use acrobot::{Error, Fast, Params, ResetOptions, State};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray1, PyReadwriteArray2};
use postcard::experimental::serialized_size;
use pyo3::exceptions::{PyIndexError, PyMemoryError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::{ACTIONS, InvalidAction, VERSION, must_be, positive, rejected, render, unknown, with};

#[pyclass(module = "acrobot_rs._native")]
pub struct Batch {
    settings: Settings,
    engine: Box<dyn Engine>,
    pool: Option<Pool>,
}

/// What cannot change after a batch is made.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Settings {
    num_envs: usize,
    limit: NonZeroU32,
    /// The index in [`MODES`].
    mode: usize,
    /// Whether to compute as Gymnasium does, with [`Host`].
    gymnasium: bool,
    /// Whether the actions are torques.
    continuous: bool,
    threads: NonZeroU32,
}

/// All autoreset modes, with Gymnasium's names.
const MODES: [(&str, Autoreset); 3] = [
    ("NextStep", Autoreset::NextStep),
    ("SameStep", Autoreset::SameStep),
    ("Disabled", Autoreset::Disabled),
];

#[pymethods]
impl Batch {
    #[new]
    #[pyo3(signature = (num_envs, seed, max_episode_steps, mode, gymnasium=false, continuous=false, threads=1))]
    fn new(
        num_envs: i64,
        seed: &str,
        max_episode_steps: i64,
        mode: &str,
        gymnasium: bool,
        continuous: bool,
        threads: i64,
    ) -> PyResult<Self> {
        let settings = Settings {
            num_envs: positive("num_envs", num_envs)?.get() as usize,
            limit: positive("max_episode_steps", max_episode_steps)?,
            mode: MODES
                .iter()
                .position(|(name, _)| *name == mode)
                .ok_or_else(|| {
                    let rule = r#""NextStep", "SameStep" or "Disabled""#;
                    unknown("autoreset_mode", rule, mode)
                })?,
            gymnasium,
            continuous,
            threads: positive("threads", threads)?,
        };
        Self::assemble(settings, parse(seed)?)
    }

    fn __len__(&self) -> usize {
        self.settings.num_envs
    }

    fn set(&mut self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let params = with(self.engine.params(), name, value)?;
        self.engine.set_params(params).map_err(rejected)
    }

    /// Gives acrobots streams of their own: those of `default_rng(seed)`, for each seed that is not `None`.
    fn seed(&mut self, seeds: Vec<Option<String>>) -> PyResult<()> {
        for (rng, seed) in self.engine.generators_mut().iter_mut().zip(seeds) {
            if let Some(seed) = seed {
                *rng = parse(&seed)?.into();
            }
        }
        Ok(())
    }

    /// Resets all acrobots, or those that the mask selects, to initial states within these bounds. With a seed, each
    /// acrobot that is reset first takes the stream of its child.
    fn reset(
        &mut self,
        py: Python<'_>,
        seed: Option<&str>,
        low: f64,
        high: f64,
        mask: Option<PyReadonlyArray1<'_, bool>>,
    ) -> PyResult<()> {
        let options = ResetOptions {
            seed: seed.map(parse).transpose()?,
            bounds: Some(ResetBounds::new(low, high).map_err(rejected)?),
        };
        let mask = mask.as_ref().map(|mask| mask.as_slice()).transpose()?;
        py.detach(|| self.engine.reset(options, mask))
            .map_err(rejected)
    }

    fn observe(&self, mut observations: PyReadwriteArray2<'_, f32>) -> PyResult<()> {
        let rows = observations.as_slice_mut()?.as_chunks_mut().0;
        self.engine.observe(rows).map_err(rejected)
    }

    /// Steps, and writes the results into the arrays. Releases Python's lock meanwhile.
    #[expect(clippy::too_many_arguments, reason = "an array for each result")]
    fn step(
        &mut self,
        py: Python<'_>,
        inputs: Inputs<'_>,
        mut observations: PyReadwriteArray2<'_, f32>,
        mut rewards: PyReadwriteArray1<'_, f32>,
        mut terminated: PyReadwriteArray1<'_, bool>,
        mut truncated: PyReadwriteArray1<'_, bool>,
        mut finals: Option<PyReadwriteArray2<'_, f32>>,
    ) -> PyResult<()> {
        self.engine.read(inputs)?;
        let buffers = StepBuffers {
            rewards: rewards.as_slice_mut()?,
            terminated: terminated.as_slice_mut()?,
            truncated: truncated.as_slice_mut()?,
            observations: Observations::Rows(observations.as_slice_mut()?.as_chunks_mut().0),
            final_observations: match &mut finals {
                Some(finals) => Observations::Rows(finals.as_slice_mut()?.as_chunks_mut().0),
                None => Observations::None,
            },
        };
        let engine = &mut self.engine;
        // The crate does not share less work than this between threads.
        let task = if self.settings.gymnasium {
            1024
        } else {
            16_384
        };
        let tasks = self.settings.num_envs.div_ceil(task);
        match tasks.min(self.settings.threads.get() as usize) {
            1 => py.detach(|| engine.step(buffers)),
            threads => {
                let pool = Pool::of_this_process(&mut self.pool, threads)?;
                py.detach(|| pool.install(|| engine.par_step(buffers)))
            }
        }
        .map_err(rejected)
    }

    /// Writes θ1, θ2 and their velocities, a row for each acrobot.
    fn states(&self, mut states: PyReadwriteArray2<'_, f64>) -> PyResult<()> {
        let rows = states.as_slice_mut()?.as_chunks_mut().0;
        for (index, row) in rows.iter_mut().enumerate() {
            *row = self.engine.state(index).ok_or_else(no_such(index))?.into();
        }
        Ok(())
    }

    /// Sets all states, which must be finite. Episodes continue.
    fn set_states(&mut self, states: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let rows = states.as_slice()?.as_chunks::<4>().0;
        for (index, row) in rows.iter().enumerate() {
            let state = State::from(*row);
            self.engine.set_state(index, state).map_err(rejected)?;
        }
        Ok(())
    }

    /// Writes the number of steps of each acrobot's episode.
    fn elapsed(&self, mut elapsed: PyReadwriteArray1<'_, i64>) -> PyResult<()> {
        for (index, elapsed) in elapsed.as_slice_mut()?.iter_mut().enumerate() {
            *elapsed = self.member(index)?.elapsed.into();
        }
        Ok(())
    }

    fn render<'py>(
        &self,
        py: Python<'py>,
        index: usize,
        mode: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let state = self.engine.state(index).ok_or_else(no_such(index))?;
        render(py, self.engine.params(), state, mode)
    }

    /// Not a clone of the memory, which would abort the process where it does not fit.
    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        let mut twin = Self::assemble(self.settings, SeedSequence::new(0))?;
        let engine = &mut twin.engine;
        engine.set_params(self.engine.params()).map_err(rejected)?;
        for index in 0..self.settings.num_envs {
            let member = self.member(index)?;
            engine.set_member(index, member).map_err(rejected)?;
        }
        Ok(twin)
    }

    /// Arguments with which pickle makes the smallest batch. `__setstate__` then replaces it.
    fn __getnewargs__(&self) -> (i64, &str, i64, &str) {
        (1, "0", 1, "NextStep")
    }

    /// A header, and the members one after the other. They are serialized twice, first to learn their size: a buffer
    /// that grows would need twice the memory, and abort the process where there is none.
    fn __getstate__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let header = (VERSION, self.settings, self.engine.params());
        let mut size = serialized_size(&header).map_err(failed)?;
        for index in 0..self.settings.num_envs {
            size += serialized_size(&self.member(index)?).map_err(failed)?;
        }
        PyBytes::new_with(py, size, |mut bytes| {
            bytes = put(&header, bytes)?;
            for index in 0..self.settings.num_envs {
                bytes = put(&self.member(index)?, bytes)?;
            }
            Ok(())
        })
    }

    fn __setstate__(&mut self, mut bytes: &[u8]) -> PyResult<()> {
        let version: u32 = take(&mut bytes)?;
        if version != VERSION {
            let message = must_be("the snapshot's version", VERSION, version);
            return Err(PyValueError::new_err(message));
        }
        let (settings, params): (Settings, Params) = take(&mut bytes)?;
        // A member takes at least a byte, so a damaged number cannot ask for more memory than this.
        if settings.num_envs > bytes.len() {
            let rule = format_args!("at most {}", bytes.len());
            let message = must_be("the snapshot's num_envs", rule, settings.num_envs);
            return Err(PyValueError::new_err(message));
        }
        let mut batch = Self::assemble(settings, SeedSequence::new(0))?;
        batch.engine.set_params(params).map_err(rejected)?;
        for index in 0..settings.num_envs {
            let member = take(&mut bytes)?;
            batch.engine.set_member(index, member).map_err(rejected)?;
        }
        if !bytes.is_empty() {
            let count = bytes.len();
            let message = format!("the snapshot must have no bytes after its end, got {count}");
            return Err(PyValueError::new_err(message));
        }
        *self = batch;
        Ok(())
    }
}

impl Batch {
    fn assemble(settings: Settings, seed: SeedSequence) -> PyResult<Self> {
        let engine: Option<Box<dyn Engine>> = if settings.gymnasium {
            Many::<Host>::assemble(&settings, seed)?
        } else {
            Many::<Fast>::assemble(&settings, seed)?
        };
        let engine = engine.ok_or_else(|| {
            let rule = "so few that they fit into memory";
            PyMemoryError::new_err(must_be("num_envs", rule, settings.num_envs))
        })?;
        Ok(Self {
            settings,
            engine,
            pool: None,
        })
    }

    fn member(&self, index: usize) -> PyResult<Member<Host>> {
        self.engine.member(index).ok_or_else(no_such(index))
    }
}

/// Actions (0, 1 or 2), or torques, N m.
#[derive(FromPyObject)]
enum Inputs<'py> {
    Actions(PyReadonlyArray1<'py, i64>),
    Torques(PyReadonlyArray2<'py, f32>),
}

/// A batch of any arithmetic, and memory for its inputs. Numbers are `f64` here: conversions from `f32` and back are exact.
trait Engine: Send + Sync {
    fn params(&self) -> Params;
    fn set_params(&mut self, params: Params) -> Result<(), Error>;
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

struct Many<A: Arithmetic> {
    batch: acrobot::batch::Batch<A, Vec<Block<A>>, Vec<Pcg64>>,
    /// Empty if the actions are torques.
    actions: Vec<u8>,
    /// Empty if they are not.
    torques: Vec<A::Scalar>,
}

impl<A: Arithmetic> Many<A> {
    /// `None` if it does not fit into memory.
    fn assemble(settings: &Settings, seed: SeedSequence) -> PyResult<Option<Box<dyn Engine>>> {
        let len = settings.num_envs;
        let (actions, torques) = if settings.continuous {
            (0, len)
        } else {
            (len, 0)
        };
        let (Some(blocks), Some(generators), Some(actions), Some(torques)) = (
            memory(Block::EMPTY, len.div_ceil(Block::<A>::LANES)),
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

impl<A: Arithmetic> Engine for Many<A> {
    fn params(&self) -> Params {
        self.batch.params().cast()
    }

    fn set_params(&mut self, params: Params) -> Result<(), Error> {
        self.batch.set_params(params.cast())
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
                |action| action as u8,
                ACTIONS,
            ),
            Inputs::Torques(from) => {
                let [a, b, c] = self.batch.params().torques.map(Real::to_f64);
                let (low, high) = (a.min(b).min(c), a.max(b).max(c));
                read(
                    from.as_slice()?,
                    &mut self.torques,
                    |torque| !torque.is_nan(),
                    |torque| A::Scalar::from_f64(f64::from(torque).max(low).min(high)),
                    "a number, N m",
                )
            }
        }
    }

    fn step(&mut self, buffers: StepBuffers<'_>) -> Result<(), Error> {
        if self.torques.is_empty() {
            self.batch.step(&self.actions, buffers)
        } else {
            self.batch.step_torques(&self.torques, buffers)
        }
    }

    fn par_step(&mut self, buffers: StepBuffers<'_>) -> Result<(), Error> {
        if self.torques.is_empty() {
            self.batch.par_step(&self.actions, buffers)
        } else {
            self.batch.par_step_torques(&self.torques, buffers)
        }
    }
}

/// Checks all inputs, then converts them.
fn read<T: Copy + std::fmt::Display, U>(
    from: &[T],
    to: &mut [U],
    valid: impl Fn(&T) -> bool,
    convert: impl Fn(T) -> U,
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
    for (to, &input) in to.iter_mut().zip(from) {
        *to = convert(input);
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

/// Threads, and the process that started them: a child made by `fork` has none of them, and would wait forever.
struct Pool {
    process: u32,
    threads: Option<rayon::ThreadPool>,
}

impl Pool {
    fn of_this_process(pool: &mut Option<Self>, threads: usize) -> PyResult<&rayon::ThreadPool> {
        let process = std::process::id();
        let is_ours = pool.as_ref().is_some_and(|pool| pool.process == process);
        if !is_ours {
            let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let error = |error: rayon::ThreadPoolBuildError| PyOSError::new_err(error.to_string());
            let threads = Some(builder.build().map_err(error)?);
            *pool = Some(Self { process, threads });
        }
        let threads = pool.as_ref().and_then(|pool| pool.threads.as_ref());
        threads.ok_or_else(|| PyRuntimeError::new_err("there are no threads"))
    }
}

impl Drop for Pool {
    /// In a child made by `fork`, ending the parent's threads could wait forever too.
    fn drop(&mut self) {
        if self.process != std::process::id() {
            std::mem::forget(self.threads.take());
        }
    }
}

/// Parses a seed: a decimal integer of at least 0, of any size.
fn parse(seed: &str) -> PyResult<SeedSequence> {
    seed.parse::<SeedSequence>().map_err(rejected)
}

fn no_such(index: usize) -> impl Fn() -> PyErr {
    move || PyIndexError::new_err(index)
}

/// `len` copies of a value, if they fit into memory.
fn memory<T: Clone>(value: T, len: usize) -> Option<Vec<T>> {
    let mut memory = Vec::new();
    memory.try_reserve_exact(len).ok()?;
    memory.resize(len, value);
    Some(memory)
}

/// Serializes a value into the first bytes, and returns the others.
fn put<'a>(value: &impl Serialize, bytes: &'a mut [u8]) -> PyResult<&'a mut [u8]> {
    let size = postcard::to_slice(value, bytes).map_err(failed)?.len();
    Ok(&mut bytes[size..])
}

/// Deserializes a value from the first bytes, and removes them.
fn take<T: DeserializeOwned>(bytes: &mut &[u8]) -> PyResult<T> {
    let (value, rest) = postcard::take_from_bytes(bytes)
        .map_err(|error| PyValueError::new_err(format!("the snapshot is damaged: {error}")))?;
    *bytes = rest;
    Ok(value)
}

fn failed(error: postcard::Error) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}
