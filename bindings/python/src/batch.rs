//! The vector environment: steps many acrobots at once.

use std::num::NonZeroU32;

use acrobot::batch::{Autoreset, StepBuffers};
use acrobot::numpy::SeedSequence;
use acrobot::task::ResetBounds;
use acrobot::{ResetOptions, State};
use numpy::{
    PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray2,
};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::engine::{Engine, Inputs, with_batch};
use crate::pool::Pool;
use crate::{alone, check_states, load, places, rejected, render, save, task, wrong};

#[pyclass(module = "acrobot_rs._native")]
pub struct Batch {
    engine: Engine,
    /// Whether the actions are torques.
    continuous: bool,
    threads: NonZeroU32,
    pool: Pool,
}

#[pymethods]
impl Batch {
    #[new]
    #[pyo3(signature = (num_envs=NonZeroU32::MIN, seed=None, max_episode_steps=NonZeroU32::MAX,
        autoreset_mode="NextStep", kind=("gymnasium", "float32"), continuous=false,
        threads=NonZeroU32::MIN))]
    fn new(
        num_envs: NonZeroU32,
        seed: Option<Bound<'_, PyAny>>,
        max_episode_steps: NonZeroU32,
        autoreset_mode: &str,
        kind: (&str, &str),
        continuous: bool,
        threads: NonZeroU32,
    ) -> PyResult<Self> {
        let mode = match autoreset_mode {
            "NextStep" => Autoreset::NextStep,
            "SameStep" => Autoreset::SameStep,
            "Disabled" => Autoreset::Disabled,
            mode => return Err(wrong("autoreset_mode", "NextStep, SameStep or Disabled", mode)),
        };
        let ((name, arithmetic), len) = (kind, num_envs.get() as usize);
        let seed = seed.map_or(Ok(SeedSequence::new(0)), parse)?;
        let mut engine = Engine::new(arithmetic, task(name)?, len, seed)?;
        with_batch!(&mut engine, many => {
            many.batch.set_max_steps(max_episode_steps);
            many.batch.set_autoreset(mode);
        });
        Ok(Self { engine, continuous, threads, pool: Pool::default() })
    }

    fn __len__(&self) -> usize {
        with_batch!(&self.engine, many => many.batch.len())
    }

    /// Sets a parameter of all acrobots to one value, or to a value for each.
    fn set(slf: &Bound<'_, Self>, name: &str, values: Vec<Bound<'_, PyAny>>) -> PyResult<()> {
        with_batch!(&mut alone(slf)?.engine, many => many.set(name, &values))
    }

    /// Sets a parameter that each reset draws.
    fn set_drawn(slf: &Bound<'_, Self>, name: &str, drawn: &Bound<'_, PyAny>) -> PyResult<()> {
        with_batch!(&mut alone(slf)?.engine, many => many.set_drawn(name, drawn))
    }

    /// Sets an instrument of all acrobots: no value, one, one for each, or what each reset draws.
    fn set_instrument(
        slf: &Bound<'_, Self>,
        name: &str,
        values: Vec<Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        alone(slf)?.engine.set_instrument(name, &values)
    }

    /// The number of an instrument of each acrobot.
    fn instrument<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let this = alone(slf)?;
        let numbers = match &this.engine {
            Engine::Measured(many) => many.instrument(name),
            _ => vec![0.0; this.__len__()],
        };
        Ok(PyArray1::from_vec(slf.py(), numbers))
    }

    /// The numbers of a parameter of each acrobot: three of `AVAIL_TORQUE`, two of `LINK_MOI`.
    fn get<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let this = alone(slf)?;
        let numbers = (0..this.__len__()).flat_map(|index| {
            let numbers = with_batch!(&this.engine, many => many.params(index)).numbers();
            places(name).map(move |place| numbers[place].1)
        });
        Ok(PyArray1::from_iter(slf.py(), numbers))
    }

    /// Resets all acrobots, or those that the mask selects, to initial states within these bounds,
    /// or to given states. With a seed, each first takes the stream of its child; with seeds, each
    /// whose seed is not `None` that of `default_rng(seed)`. Writes the observations of all into an
    /// array.
    fn reset(
        slf: &Bound<'_, Self>,
        seed: Option<Bound<'_, PyAny>>,
        seeds: Option<Vec<Option<Bound<'_, PyAny>>>>,
        bounds: [f64; 2],
        mask: Option<PyReadonlyArray1<'_, bool>>,
        states: Option<PyReadonlyArray2<'_, f64>>,
        observations: &Bound<'_, PyArray2<f32>>,
    ) -> PyResult<()> {
        let [low, high] = bounds;
        let options = ResetOptions {
            seed: seed.map(parse).transpose()?,
            bounds: Some(ResetBounds::new(low, high).map_err(rejected)?),
        };
        let seeds = seeds.unwrap_or_default().into_iter();
        let seeds = seeds.map(|seed| seed.map(parse).transpose());
        let seeds = seeds.collect::<PyResult<Vec<_>>>()?;
        let mask = mask.as_ref().map(|mask| mask.as_slice()).transpose()?;
        let states = states.as_ref().map(|rows| rows.as_slice()).transpose()?;
        let states = states.unwrap_or_default().as_chunks::<4>().0;
        check_states::<f32>(states)?; // observations are `f32`
        let engine = &mut alone(slf)?.engine;
        let mut observations = observations.try_readwrite()?; // all calls can share this array
        let rows = observations.as_slice_mut()?.as_chunks_mut().0;
        slf.py()
            .detach(|| {
                with_batch!(engine, many => {
                    for (rng, seed) in many.batch.generators_mut().iter_mut().zip(seeds) {
                        if let Some(seed) = seed {
                            *rng = seed.into();
                        }
                    }
                    match mask {
                        Some(mask) => many.batch.reset_masked(mask, options)?,
                        None => many.batch.reset_with(options),
                    }
                    for (index, state) in states.iter().enumerate() {
                        if mask.is_none_or(|mask| mask[index]) {
                            many.batch.set_state(index, State::from(*state).cast())?;
                        }
                    }
                    many.batch.observe(rows)
                })
            })
            .map_err(rejected)
    }

    /// Steps without Python's lock, and writes the observations into an array. The environment
    /// converts or rejects actions in another type or shape. Returns rewards, terminated and
    /// truncated.
    #[pyo3(signature = (env, actions, observations, finals=None))]
    fn step<'py>(
        slf: &Bound<'py, Self>,
        env: &Bound<'py, PyAny>,
        actions: &Bound<'py, PyAny>,
        observations: &Bound<'py, PyArray2<f32>>,
        mut finals: Option<PyReadwriteArray2<'py, f32>>,
    ) -> PyResult<impl IntoPyObject<'py>> {
        let py = slf.py();
        let (len, continuous) = {
            let this = alone(slf)?;
            (this.__len__(), this.continuous)
        };
        let inputs = match Inputs::of(actions, len, continuous) {
            Some(inputs) => inputs,
            None => env.call_method1("_inputs", (actions,))?.extract()?,
        };
        let this = &mut *alone(slf)?;
        let task = this.engine.task();
        with_batch!(&mut this.engine, many => many.read(task, inputs))?;
        let mut rewards = vec![0.0; len];
        let (mut terminated, mut truncated) = (vec![false; len], vec![false; len]);
        let mut observations = observations.try_readwrite()?; // all calls can share this array
        let rows = observations.as_slice_mut()?.as_chunks_mut().0;
        let mut buffers =
            StepBuffers::new(&mut rewards, &mut terminated, &mut truncated).with_observations(rows);
        if let Some(finals) = &mut finals {
            buffers.final_observations = Some(finals.as_slice_mut()?.as_chunks_mut().0);
        }
        let engine = &mut this.engine;
        // The crate does not share less work than this between threads.
        let is_single = matches!(engine, Engine::Float32(_) | Engine::Measured(_));
        let share = if is_single { 16_384 } else { 1024 };
        match len.div_ceil(share).min(this.threads.get() as usize) {
            1 => py.detach(|| with_batch!(engine, many => many.step(buffers, false))),
            threads => {
                let pool = this.pool.of_this_process(threads)?;
                let step = || with_batch!(engine, many => many.step(buffers, true));
                py.detach(|| pool.install(step))
            }
        }
        .map_err(rejected)?;
        Ok((
            PyArray1::from_vec(py, rewards),
            PyArray1::from_vec(py, terminated),
            PyArray1::from_vec(py, truncated),
        ))
    }

    /// θ1, θ2 and their velocities of each acrobot.
    fn states<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let this = alone(slf)?;
        let states = (0..this.__len__()).flat_map(|index| {
            <[f64; 4]>::from(with_batch!(&this.engine, many => many.state(index)))
        });
        Ok(PyArray1::from_iter(slf.py(), states))
    }

    /// Sets all states. Episodes continue.
    fn set_states(slf: &Bound<'_, Self>, states: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let mut this = alone(slf)?;
        let rows = states.as_slice()?.as_chunks::<4>().0;
        with_batch!(&mut this.engine, many => many.set_states(rows))
    }

    /// The first environment, if any, whose episode has ended and that waits for a reset.
    fn first_done(slf: &Bound<'_, Self>) -> PyResult<Option<usize>> {
        let this = alone(slf)?;
        Ok(with_batch!(&this.engine, many => {
            (0..many.batch.len()).find(|&index| many.batch.is_done(index) == Ok(true))
        }))
    }

    /// The number of steps of each acrobot's episode.
    fn elapsed<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let this = alone(slf)?;
        let steps = (0..this.__len__()).filter_map(|index| {
            with_batch!(&this.engine, many => many.batch.elapsed_steps(index)).ok()
        });
        Ok(PyArray1::from_iter(slf.py(), steps.map(i64::from)))
    }

    fn render<'py>(
        slf: &Bound<'py, Self>,
        index: usize,
        mode: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let this = alone(slf)?;
        let (params, state) =
            with_batch!(&this.engine, many => (many.params(index), many.state(index)));
        render(slf.py(), params, state, mode)
    }

    /// Every protocol of pickle calls this, and `copy.deepcopy`.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<impl IntoPyObject<'py>> {
        Ok((slf.get_type(), (), Self::__getstate__(slf)?))
    }

    fn __getstate__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyBytes>> {
        let this = alone(slf)?;
        save(slf.py(), &(this.continuous, this.threads, &this.engine))
    }

    fn __setstate__(slf: &Bound<'_, Self>, bytes: &[u8]) -> PyResult<()> {
        let mut this = alone(slf)?;
        (this.continuous, this.threads, this.engine) = load(bytes)?;
        this.pool = Pool::default();
        Ok(())
    }
}

/// A seed, an integer of at least 0.
pub fn parse(seed: Bound<'_, PyAny>) -> PyResult<SeedSequence> {
    seed.str()?.to_str()?.parse::<SeedSequence>().map_err(rejected)
}
