//! The vector environment: steps many acrobots at once.

use std::num::NonZeroU32;

use acrobot::batch::{Autoreset, Block, Member, Observations, StepBuffers};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::ResetBounds;
use acrobot::{Fast, Params, ResetOptions};
use numpy::{PyArray1, PyReadonlyArray1, PyReadwriteArray1, PyReadwriteArray2};
use pyo3::exceptions::{PyIndexError, PyMemoryError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::{Deserialize, Serialize};

use crate::{
    ACTIONS, InvalidAction, load, must_be, positive, rejected, render, save, unknown, with,
};

type Native = acrobot::batch::Batch<Fast, Vec<Block>, Vec<Pcg64>>;

/// A batch, and memory for its actions, which Python passes as 64-bit integers.
#[pyclass(module = "acrobot_rs._native")]
pub struct Batch {
    batch: Native,
    actions: Vec<u8>,
}

/// All autoreset modes, with Gymnasium's names.
const MODES: [(&str, Autoreset); 3] = [
    ("NextStep", Autoreset::NextStep),
    ("SameStep", Autoreset::SameStep),
    ("Disabled", Autoreset::Disabled),
];

#[derive(Serialize, Deserialize)]
struct Snapshot {
    limit: NonZeroU32,
    /// The index in [`MODES`].
    mode: usize,
    params: Params<f32>,
    members: Vec<Member<Fast>>,
}

#[pymethods]
impl Batch {
    #[new]
    fn new(num_envs: i64, seed: &str, max_episode_steps: i64, mode: &str) -> PyResult<Self> {
        let num_envs = positive("num_envs", num_envs)?.get() as usize;
        let limit = positive("max_episode_steps", max_episode_steps)?;
        let seed = parse(seed)?;
        let Some((_, mode)) = MODES.iter().find(|(name, _)| *name == mode) else {
            let rule = r#""NextStep", "SameStep" or "Disabled""#;
            return Err(unknown("autoreset_mode", rule, mode));
        };
        Self::assemble(num_envs, seed, limit, *mode)
    }

    fn set(&mut self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let params = with(self.batch.params().cast(), name, value)?;
        self.batch.set_params(params.cast()).map_err(rejected)
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
        let Some(mask) = mask else {
            py.detach(|| self.batch.reset_with(options));
            return Ok(());
        };
        let mask = mask.as_slice()?;
        py.detach(|| self.batch.reset_masked(mask, options))
            .map_err(rejected)
    }

    fn observe(&self, mut observations: PyReadwriteArray2<'_, f32>) -> PyResult<()> {
        let rows = observations.as_slice_mut()?.as_chunks_mut().0;
        self.batch
            .observe(Observations::Rows(rows))
            .map_err(rejected)
    }

    /// Steps, and writes the results into the arrays. Releases Python's lock meanwhile.
    #[expect(clippy::too_many_arguments, reason = "an array for each result")]
    fn step(
        &mut self,
        py: Python<'_>,
        actions: PyReadonlyArray1<'_, i64>,
        mut observations: PyReadwriteArray2<'_, f32>,
        mut rewards: PyReadwriteArray1<'_, f32>,
        mut terminated: PyReadwriteArray1<'_, bool>,
        mut truncated: PyReadwriteArray1<'_, bool>,
        mut finals: Option<PyReadwriteArray2<'_, f32>>,
    ) -> PyResult<()> {
        self.read(actions.as_slice()?)?;
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
        py.detach(|| self.batch.step(&self.actions, buffers))
            .map_err(rejected)
    }

    /// θ1, θ2 and their velocities, one acrobot after the other.
    fn states<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        let states = (0..self.batch.len()).filter_map(|index| self.batch.state(index));
        PyArray1::from_iter(py, states.flat_map(<[f32; 4]>::from))
    }

    fn render<'py>(
        &self,
        py: Python<'py>,
        index: usize,
        mode: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let state = self.batch.state(index);
        let state = state.ok_or_else(|| PyIndexError::new_err(index))?;
        render(py, self.batch.params().cast(), state.cast(), mode)
    }

    /// Arguments with which pickle makes the smallest batch. `__setstate__` then replaces it.
    fn __getnewargs__(&self) -> (i64, &str, i64, &str) {
        (1, "0", 1, "NextStep")
    }

    fn __getstate__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let autoreset = self.batch.autoreset();
        let mode = MODES.iter().position(|(_, mode)| *mode == autoreset);
        let members = (0..self.batch.len()).filter_map(|index| self.batch.member(index));
        let bytes = save(&Snapshot {
            limit: self.batch.limit(),
            mode: mode.unwrap_or_default(),
            params: *self.batch.params(),
            members: members.collect(),
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn __setstate__(&mut self, bytes: &[u8]) -> PyResult<()> {
        let Snapshot {
            limit,
            mode,
            params,
            members,
        } = load(bytes)?;
        let mode = MODES.get(mode).ok_or_else(|| {
            let rule = format_args!("below {}", MODES.len());
            PyValueError::new_err(must_be("the snapshot's autoreset mode", rule, mode))
        });
        let mut batch = Self::assemble(members.len(), SeedSequence::new(0), limit, mode?.1)?;
        batch.batch.set_params(params).map_err(rejected)?;
        for (index, member) in members.into_iter().enumerate() {
            batch.batch.set_member(index, member).map_err(rejected)?;
        }
        *self = batch;
        Ok(())
    }
}

impl Batch {
    fn assemble(
        num_envs: usize,
        seed: SeedSequence,
        limit: NonZeroU32,
        autoreset: Autoreset,
    ) -> PyResult<Self> {
        let blocks = num_envs.div_ceil(Block::<Fast>::LANES);
        let (Some(blocks), Some(generators), Some(actions)) = (
            memory(Block::EMPTY, blocks),
            memory(Pcg64::UNSEEDED, num_envs),
            memory(0, num_envs),
        ) else {
            let message = must_be("num_envs", "so few that they fit into memory", num_envs);
            return Err(PyMemoryError::new_err(message));
        };
        let mut batch = Native::with_seed(seed, blocks, generators).map_err(rejected)?;
        batch.set_limit(limit);
        batch.set_autoreset(autoreset);
        Ok(Self { batch, actions })
    }

    /// Checks the actions and copies them as bytes, which the batch takes.
    fn read(&mut self, actions: &[i64]) -> PyResult<()> {
        let (len, expected) = (actions.len(), self.actions.len());
        if len != expected {
            let message = format!("actions must have {expected} elements, got {len}");
            return Err(InvalidAction::new_err(message));
        }
        let known = |action: &i64| (0..3).contains(action);
        // No early exit, so that the compiler vectorizes the loop.
        if !actions.iter().fold(true, |all, action| all & known(action)) {
            let unknown = actions
                .iter()
                .enumerate()
                .find(|(_, action)| !known(action));
            let (index, action) = unknown.unwrap_or((0, &0));
            let name = format!("actions[{index}]");
            return Err(InvalidAction::new_err(must_be(&name, ACTIONS, action)));
        }
        for (to, &action) in self.actions.iter_mut().zip(actions) {
            *to = action as u8;
        }
        Ok(())
    }
}

/// Parses a seed: a decimal integer of at least 0, of any size.
fn parse(seed: &str) -> PyResult<SeedSequence> {
    seed.parse::<SeedSequence>().map_err(rejected)
}

/// `len` copies of a value, if they fit into memory.
fn memory<T: Clone>(value: T, len: usize) -> Option<Vec<T>> {
    let mut memory = Vec::new();
    memory.try_reserve_exact(len).ok()?;
    memory.resize(len, value);
    Some(memory)
}
