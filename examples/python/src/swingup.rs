//! dm_control's swing-up: a batch in `f32`, or one acrobot in `f64`.

use std::ops::DerefMut;

use acrobot::arithmetic::{Arithmetic, Real, Swingup as Dense, SwingupSparse as Sparse};
use acrobot::batch::{StepBuffers, VecBatch};
use acrobot::{Error, Fast, Portable, ResetOptions, State};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray1, PyReadwriteArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::{Deserialize, Serialize};

use crate::batch::{Results, autoreset, no_such, parse};
use crate::engine::memory;
use crate::pool::Pool;
use crate::{Reduced, load, positive, rejected, render, save};

#[derive(Serialize, Deserialize)]
enum Engine {
    Fast(VecBatch<Dense<Fast>>),
    FastSparse(VecBatch<Sparse<Fast>>),
    Exact(VecBatch<Dense<Portable>>),
    ExactSparse(VecBatch<Sparse<Portable>>),
}

/// Does something with the batch in an engine, whatever its arithmetic.
macro_rules! with_batch {
    ($engine:expr, $batch:ident => $result:expr) => {
        match $engine {
            Engine::Fast($batch) => $result,
            Engine::FastSparse($batch) => $result,
            Engine::Exact($batch) => $result,
            Engine::ExactSparse($batch) => $result,
        }
    };
}

fn step<A: Arithmetic>(
    batch: &mut VecBatch<A>,
    torques: &[f64],
    buffers: StepBuffers<'_>,
    parallel: bool,
) -> Result<(), Error> {
    let torques: Vec<_> = torques.iter().map(|&x| A::Scalar::from_f64(x)).collect();
    match parallel {
        false => batch.deref_mut().step(&torques, buffers),
        true => batch.deref_mut().par_step(&torques, buffers),
    }
}

#[pyclass(module = "acrobot_rs._native")]
pub struct Swingup {
    engine: Engine,
    threads: usize,
    pool: Option<Pool>,
}

#[pymethods]
impl Swingup {
    #[new]
    #[pyo3(signature = (num_envs=1, seed="0", max_episode_steps=1000, mode="Disabled", sparse=false, exact=true, threads=1))]
    fn new(
        num_envs: i64,
        seed: &str,
        max_episode_steps: i64,
        mode: &str,
        sparse: bool,
        exact: bool,
        threads: i64,
    ) -> PyResult<Self> {
        let len = positive("num_envs", num_envs)?.get() as usize;
        let limit = positive("max_episode_steps", max_episode_steps)?;
        let threads = positive("threads", threads)?.get() as usize;
        let (mode, seed) = (autoreset(mode)?, parse(seed)?);
        let mut engine = match (exact, sparse) {
            (false, false) => Engine::Fast(VecBatch::new(seed, len).map_err(rejected)?),
            (false, true) => Engine::FastSparse(VecBatch::new(seed, len).map_err(rejected)?),
            (true, false) => Engine::Exact(VecBatch::new(seed, len).map_err(rejected)?),
            (true, true) => Engine::ExactSparse(VecBatch::new(seed, len).map_err(rejected)?),
        };
        with_batch!(&mut engine, batch => {
            batch.set_limit(limit);
            batch.set_autoreset(mode);
        });
        Ok(Self {
            engine,
            threads,
            pool: None,
        })
    }

    /// Resets those in a mask, or all. A seed seeds them by its children.
    fn reset(
        &mut self,
        seed: Option<&str>,
        mask: Option<PyReadonlyArray1<'_, bool>>,
    ) -> PyResult<()> {
        let seed = seed.map(parse).transpose()?;
        let options = ResetOptions { seed, bounds: None };
        with_batch!(&mut self.engine, batch => match mask {
            Some(mask) => batch.deref_mut().reset_masked(mask.as_slice()?, options).map_err(rejected)?,
            None => batch.deref_mut().reset_with(options),
        });
        Ok(())
    }

    fn observe(&self, mut observations: PyReadwriteArray2<'_, f32>) -> PyResult<()> {
        let rows = observations.as_slice_mut()?.as_chunks_mut().0;
        with_batch!(&self.engine, batch => batch.observe(rows)).map_err(rejected)
    }

    /// Steps by torques, N m, and writes the observations. Releases Python's lock meanwhile.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        torques: PyReadonlyArray1<'py, f64>,
        mut observations: PyReadwriteArray2<'py, f32>,
        mut finals: Option<PyReadwriteArray2<'py, f32>>,
    ) -> PyResult<Results<'py>> {
        let torques = torques.as_slice()?;
        let mut rewards = memory(0.0, torques.len())?;
        let mut terminated = memory(false, torques.len())?;
        let mut truncated = memory(false, torques.len())?;
        let rows = observations.as_slice_mut()?.as_chunks_mut().0;
        let mut buffers =
            StepBuffers::new(&mut rewards, &mut terminated, &mut truncated).with_observations(rows);
        if let Some(finals) = &mut finals {
            buffers.final_observations = Some(finals.as_slice_mut()?.as_chunks_mut().0);
        }
        let engine = &mut self.engine;
        let step = |parallel| with_batch!(engine, batch => step(batch, torques, buffers, parallel));
        match self.threads {
            1 => py.detach(|| step(false)),
            threads => {
                let pool = Pool::of_this_process(&mut self.pool, threads)?;
                py.detach(|| pool.install(|| step(true)))
            }
        }
        .map_err(rejected)?;
        Ok((
            PyArray1::from_vec(py, rewards),
            PyArray1::from_vec(py, terminated),
            PyArray1::from_vec(py, truncated),
        ))
    }

    /// Writes θ1, θ2 and their velocities, a row for each acrobot.
    fn states(&self, mut states: PyReadwriteArray2<'_, f64>) -> PyResult<()> {
        let rows = states.as_slice_mut()?.as_chunks_mut().0;
        for (index, row) in rows.iter_mut().enumerate() {
            let state = with_batch!(&self.engine, batch => batch.state(index).map(State::cast));
            *row = state.ok_or_else(no_such(index))?.into();
        }
        Ok(())
    }

    /// Sets all states, which must be finite. Episodes continue.
    fn set_states(&mut self, states: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        for (index, row) in states.as_slice()?.as_chunks::<4>().0.iter().enumerate() {
            let state = State::from(*row);
            with_batch!(&mut self.engine, batch => batch.set_state(index, state.cast()))
                .map_err(rejected)?;
        }
        Ok(())
    }

    /// Writes the number of steps of each acrobot's episode.
    fn elapsed(&self, mut elapsed: PyReadwriteArray1<'_, i64>) -> PyResult<()> {
        for (index, elapsed) in elapsed.as_slice_mut()?.iter_mut().enumerate() {
            let steps = with_batch!(&self.engine, batch => batch.elapsed(index));
            *elapsed = steps.ok_or_else(no_such(index))?.into();
        }
        Ok(())
    }

    fn render<'py>(
        &self,
        py: Python<'py>,
        index: usize,
        mode: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (params, state) = with_batch!(&self.engine, batch => (
            batch.params_of(index).unwrap_or_default().without_friction().cast(),
            batch.state(index).map(State::cast),
        ));
        render(py, params, state.ok_or_else(no_such(index))?, mode)
    }

    /// Every protocol of pickle calls this, and `copy.deepcopy`.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let this = slf.try_borrow()?;
        Ok((slf.get_type(), (), this.__getstate__(slf.py())?))
    }

    fn __getstate__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        save(py, &(self.threads, &self.engine))
    }

    fn __setstate__(&mut self, bytes: &[u8]) -> PyResult<()> {
        (self.threads, self.engine) = load(bytes)?;
        self.pool = None;
        Ok(())
    }
}
