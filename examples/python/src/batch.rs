//! Many acrobots in one step.

use std::num::NonZeroU32;

use acrobot::{
    Autoreset, Block, Fast, Member, Observations, Output, Params, Pcg64, SeedSequence, StartBounds,
    State,
};
use numpy::{PyArray1, PyReadonlyArray1, PyReadwriteArray1, PyReadwriteArray2};
use pyo3::exceptions::{PyIndexError, PyMemoryError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::{Deserialize, Serialize};

use crate::{InvalidAction, load, positive, refused, render, save, with};

type Native = acrobot::Batch<Fast, Vec<Block>, Vec<Pcg64>>;

/// A batch, what was set of it, and memory for the actions.
#[pyclass(module = "acrobot_rs._native")]
pub struct Batch {
    batch: Native,
    settings: Settings,
    actions: Vec<u8>,
}

/// What a batch does not tell again.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Settings {
    limit: NonZeroU32,
    same_step: bool,
}

#[derive(Serialize, Deserialize)]
struct Snapshot {
    settings: Settings,
    params: Params<f32>,
    members: Vec<Member>,
}

#[pymethods]
impl Batch {
    #[new]
    fn new(num_envs: i64, seed: &str, max_episode_steps: i64, same_step: bool) -> PyResult<Self> {
        let num_envs = positive("num_envs", num_envs)?.get() as usize;
        let settings = Settings {
            limit: positive("max_episode_steps", max_episode_steps)?,
            same_step,
        };
        Self::assemble(num_envs, parse(seed)?, settings)
    }

    fn set(&mut self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let params = with(self.batch.params().cast(), name, value)?;
        self.batch.set_params(params.cast()).map_err(refused)
    }

    /// Begins all episodes anew within these bounds: in the stream that each has, or where there is a seed in
    /// its children's.
    fn reset(&mut self, py: Python<'_>, seed: Option<&str>, low: f64, high: f64) -> PyResult<()> {
        let bounds = StartBounds::new(low, high).map_err(refused)?;
        let seed = seed.map(parse).transpose()?;
        py.detach(|| {
            self.batch.set_start_bounds(bounds);
            match seed {
                Some(seed) => self.batch.reset_seeded(seed),
                None => self.batch.reset(),
            }
            // Those of Gymnasium's options hold for this reset alone.
            self.batch.set_start_bounds(StartBounds::DEFAULT);
        });
        Ok(())
    }

    fn observe(&self, mut observations: PyReadwriteArray2<'_, f32>) -> PyResult<()> {
        let rows = observations.as_slice_mut()?.as_chunks_mut().0;
        self.batch
            .observe(Observations::Rows(rows))
            .map_err(refused)
    }

    /// Writes into the arrays, without Python's lock; into `finals` where there is one.
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
        let output = Output {
            rewards: rewards.as_slice_mut()?,
            terminated: terminated.as_slice_mut()?,
            truncated: truncated.as_slice_mut()?,
            observations: Observations::Rows(observations.as_slice_mut()?.as_chunks_mut().0),
            final_observations: match &mut finals {
                Some(finals) => Observations::Rows(finals.as_slice_mut()?.as_chunks_mut().0),
                None => Observations::None,
            },
        };
        py.detach(|| self.batch.step(&self.actions, output))
            .map_err(refused)
    }

    /// θ1, θ2 and their velocities of one after the other.
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
        let state: Option<State<f32>> = self.batch.state(index);
        let state = state.ok_or_else(|| PyIndexError::new_err(index))?;
        render(py, self.batch.params().cast(), state.cast(), mode)
    }

    /// Those of the smallest batch: all else is in the state.
    fn __getnewargs__(&self) -> (i64, &str, i64, bool) {
        (1, "0", 1, false)
    }

    fn __getstate__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let members = (0..self.batch.len()).filter_map(|index| self.batch.member(index));
        let bytes = save(&Snapshot {
            settings: self.settings,
            params: *self.batch.params(),
            members: members.collect(),
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn __setstate__(&mut self, bytes: &[u8]) -> PyResult<()> {
        let Snapshot {
            settings,
            params,
            members,
        } = load(bytes)?;
        let mut batch = Self::assemble(members.len(), 0.into(), settings)?;
        batch.batch.set_params(params).map_err(refused)?;
        for (index, member) in members.into_iter().enumerate() {
            batch.batch.set_member(index, member).map_err(refused)?;
        }
        *self = batch;
        Ok(())
    }
}

impl Batch {
    fn assemble(num_envs: usize, seed: SeedSequence, settings: Settings) -> PyResult<Self> {
        let blocks = memory(Block::EMPTY, num_envs.div_ceil(Block::<f32>::LANES))?;
        let generators = memory(Pcg64::UNSEEDED, num_envs)?;
        let mut batch = Native::new(seed, blocks, generators).map_err(refused)?;
        batch.set_limit(settings.limit);
        batch.set_autoreset(match settings.same_step {
            true => Autoreset::SameStep,
            false => Autoreset::NextStep,
        });
        Ok(Self {
            batch,
            settings,
            actions: memory(0, num_envs)?,
        })
    }

    /// The actions in the width that a batch takes.
    fn read(&mut self, actions: &[i64]) -> PyResult<()> {
        if actions.len() != self.actions.len() {
            let (found, expected) = (actions.len(), self.actions.len());
            let message = format!("actions has {found} elements; allowed is {expected}");
            return Err(InvalidAction::new_err(message));
        }
        // One pass without an exit, so that it is done by vectors.
        let known = actions
            .iter()
            .fold(true, |all, action| all & (0..3).contains(action));
        if !known {
            let unknown = actions
                .iter()
                .enumerate()
                .find(|(_, action)| !(0..3).contains(*action));
            let (index, action) = unknown.unwrap_or((0, &0));
            return Err(InvalidAction::new_err(format!(
                "action {index} is {action}; allowed is 0 (negative torque), 1 (none) or 2 (positive)"
            )));
        }
        for (to, &action) in self.actions.iter_mut().zip(actions) {
            *to = action as u8;
        }
        Ok(())
    }
}

/// A decimal integer, 0 or more, of any size.
fn parse(seed: &str) -> PyResult<SeedSequence> {
    seed.parse::<SeedSequence>().map_err(refused)
}

/// As much memory as was asked for, or a `MemoryError`.
fn memory<T: Clone>(value: T, len: usize) -> PyResult<Vec<T>> {
    let mut memory = Vec::new();
    memory
        .try_reserve_exact(len)
        .map_err(|error| PyMemoryError::new_err(error.to_string()))?;
    memory.resize(len, value);
    Ok(memory)
}
