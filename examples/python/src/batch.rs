//! The vector environment: steps many acrobots at once.

use acrobot::arithmetic::Host;
use acrobot::batch::{Autoreset, Member, StepBuffers};
use acrobot::numpy::SeedSequence;
use acrobot::physics::ResetBounds;
use acrobot::{Params, ResetOptions, State};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray1, PyReadwriteArray2};
use pyo3::exceptions::{PyIndexError, PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyType};

use crate::engine::{Engine, Inputs, Range, Settings, memory, with_batch};
use crate::pool::Pool;
use crate::{Reduced, fields, load, must_be, positive, rejected, render, save, unknown, with};

#[pyclass(module = "acrobot_rs._native")]
pub struct Batch {
    settings: Settings,
    engine: Engine,
    pool: Option<Pool>,
}

#[pymethods]
impl Batch {
    #[new]
    #[pyo3(signature = (num_envs=1, seed="0", max_episode_steps=500, mode="NextStep", gymnasium=false, continuous=false, threads=1))]
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
            mode: match mode {
                "NextStep" => Autoreset::NextStep,
                "SameStep" => Autoreset::SameStep,
                "Disabled" => Autoreset::Disabled,
                other => {
                    let rule = r#""NextStep", "SameStep" or "Disabled""#;
                    return Err(unknown("autoreset_mode", rule, other));
                }
            },
            gymnasium,
            continuous,
            threads: positive("threads", threads)?,
        };
        Ok(Self {
            settings,
            engine: Engine::new(&settings, false, parse(seed)?)?,
            pool: None,
        })
    }

    fn __len__(&self) -> usize {
        self.settings.num_envs
    }

    /// Sets a parameter of all acrobots: a value, or a `Uniform` between whose bounds each reset draws it.
    fn set(slf: &Bound<'_, Self>, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let this = &mut *alone(slf)?;
        if let Some([low, high]) = bounds(value)? {
            return this.draw(name, &low, &high);
        }
        let both =
            |[low, high]: Range| PyResult::Ok([with(low, name, value)?, with(high, name, value)?]);
        let range = this.range().map(both).transpose()?;
        let own = with_batch!(&this.engine, many => many.own);
        let count = if own { this.settings.num_envs } else { 1 };
        let each = (0..count).map(|index| this.changed(index, name, value));
        let each = each.collect::<PyResult<_>>()?;
        this.change(each, range)
    }

    /// Sets a parameter of each acrobot. No parameter is drawn then.
    fn set_each(slf: &Bound<'_, Self>, name: &str, values: Vec<Bound<'_, PyAny>>) -> PyResult<()> {
        let mut this = alone(slf)?;
        let num_envs = this.settings.num_envs;
        if values.len() != num_envs {
            let rule = format_args!("one value, or one for each of {num_envs} environments");
            let got = format_args!("{} values", values.len());
            return Err(PyValueError::new_err(must_be(name, rule, got)));
        }
        let each = values.iter().enumerate().map(|(index, value)| {
            let changed = this.changed(index, name, value);
            changed.map_err(|error| indexed(value.py(), error, index))
        });
        let each = each.collect::<PyResult<_>>()?;
        this.change(each, None)
    }

    /// A parameter of each acrobot.
    fn get<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let (py, this) = (slf.py(), alone(slf)?);
        let each = (0..this.settings.num_envs).map(|index| {
            let mut params = this.member(index)?.params;
            Ok(match fields(name).next() {
                Some(field) => field(&mut params).into_pyobject(py)?.into_any(),
                None => params.torques.into_pyobject(py)?.into_any(),
            })
        });
        each.collect()
    }

    /// Gives acrobots streams of their own: those of `default_rng(seed)`, for each seed that is not `None`.
    fn seed(slf: &Bound<'_, Self>, seeds: Vec<Option<String>>) -> PyResult<()> {
        let this = &mut *alone(slf)?;
        let generators = with_batch!(&mut this.engine, many => many.batch.generators_mut());
        for (rng, seed) in generators.iter_mut().zip(seeds) {
            if let Some(seed) = seed {
                *rng = parse(&seed)?.into();
            }
        }
        Ok(())
    }

    /// Resets all acrobots, or those that the mask selects, to initial states within these bounds. With a seed, each
    /// acrobot that is reset first takes the stream of its child.
    fn reset(
        slf: &Bound<'_, Self>,
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
        let engine = &mut alone(slf)?.engine;
        slf.py().detach(|| {
            with_batch!(engine, many => match mask {
                Some(mask) => many.batch.reset_masked(mask, options).map_err(rejected),
                None => {
                    many.batch.reset_with(options);
                    Ok(())
                }
            })
        })
    }

    fn observe(
        slf: &Bound<'_, Self>,
        mut observations: PyReadwriteArray2<'_, f32>,
    ) -> PyResult<()> {
        let rows = observations.as_slice_mut()?.as_chunks_mut().0;
        let this = alone(slf)?;
        with_batch!(&this.engine, many => many.batch.observe(rows)).map_err(rejected)
    }

    /// Steps, and writes the observations into an array. Releases Python's lock meanwhile. The environment converts the
    /// actions that are in another type or shape, or rejects them.
    #[pyo3(signature = (env, actions, observations, finals=None))]
    fn step<'py>(
        slf: &Bound<'py, Self>,
        env: &Bound<'py, PyAny>,
        actions: &Bound<'py, PyAny>,
        mut observations: PyReadwriteArray2<'py, f32>,
        mut finals: Option<PyReadwriteArray2<'py, f32>>,
    ) -> PyResult<Results<'py>> {
        let py = slf.py();
        let Settings {
            num_envs: len,
            continuous,
            ..
        } = alone(slf)?.settings;
        let inputs = match Inputs::of(actions, len, continuous) {
            Some(inputs) => inputs,
            None => env.call_method1("_inputs", (actions,))?.extract()?,
        };
        let this = &mut *alone(slf)?;
        with_batch!(&mut this.engine, many => many.read(inputs))?;
        let no_memory = || PyMemoryError::new_err("the results do not fit into memory");
        let mut rewards = memory(0.0, len).ok_or_else(no_memory)?;
        let mut terminated = memory(false, len).ok_or_else(no_memory)?;
        let mut truncated = memory(false, len).ok_or_else(no_memory)?;
        let rows = observations.as_slice_mut()?.as_chunks_mut().0;
        let mut buffers =
            StepBuffers::new(&mut rewards, &mut terminated, &mut truncated).with_observations(rows);
        if let Some(finals) = &mut finals {
            buffers.final_observations = Some(finals.as_slice_mut()?.as_chunks_mut().0);
        }
        let engine = &mut this.engine;
        // The crate does not share less work than this between threads.
        let task = if this.settings.gymnasium {
            1024
        } else {
            16_384
        };
        let tasks = len.div_ceil(task);
        match tasks.min(this.settings.threads.get() as usize) {
            1 => py.detach(|| with_batch!(engine, many => many.step(buffers, false))),
            threads => {
                let pool = Pool::of_this_process(&mut this.pool, threads)?;
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

    /// Writes θ1, θ2 and their velocities, a row for each acrobot.
    fn states(slf: &Bound<'_, Self>, mut states: PyReadwriteArray2<'_, f64>) -> PyResult<()> {
        let this = alone(slf)?;
        let rows = states.as_slice_mut()?.as_chunks_mut().0;
        for (index, row) in rows.iter_mut().enumerate() {
            let state = with_batch!(&this.engine, many => many.batch.state(index).map(State::cast));
            *row = state.ok_or_else(no_such(index))?.into();
        }
        Ok(())
    }

    /// Sets all states, which must be finite. Episodes continue.
    fn set_states(slf: &Bound<'_, Self>, states: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let mut this = alone(slf)?;
        let rows = states.as_slice()?.as_chunks::<4>().0;
        for (index, row) in rows.iter().enumerate() {
            let state = State::from(*row);
            with_batch!(&mut this.engine, many => many.batch.set_state(index, state.cast()))
                .map_err(rejected)?;
        }
        Ok(())
    }

    /// Writes the number of steps of each acrobot's episode.
    fn elapsed(slf: &Bound<'_, Self>, mut elapsed: PyReadwriteArray1<'_, i64>) -> PyResult<()> {
        let this = alone(slf)?;
        for (index, elapsed) in elapsed.as_slice_mut()?.iter_mut().enumerate() {
            *elapsed = this.member(index)?.elapsed.into();
        }
        Ok(())
    }

    fn render<'py>(
        slf: &Bound<'py, Self>,
        index: usize,
        mode: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Member { params, state, .. } = alone(slf)?.member(index)?;
        render(slf.py(), params, state, mode)
    }

    /// Every protocol of pickle calls this, and `copy.deepcopy`. `__setstate__` replaces the smallest batch.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        Ok((slf.get_type(), (), Self::__getstate__(slf)?))
    }

    fn __getstate__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyBytes>> {
        let this = alone(slf)?;
        save(slf.py(), &(this.settings, this.range(), this.members()?))
    }

    fn __setstate__(slf: &Bound<'_, Self>, bytes: &[u8]) -> PyResult<()> {
        let mut this = alone(slf)?;
        let (settings, range, members) = load(bytes)?;
        *this = Self::of_members(settings, range, members)?;
        Ok(())
    }
}

/// Rewards, terminated and truncated.
type Results<'py> = (
    Bound<'py, PyArray1<f32>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
);

impl Batch {
    /// A batch with these acrobots. They share their parameters if these are the same.
    fn of_members(
        settings: Settings,
        range: Option<Range>,
        members: Vec<Member<Host>>,
    ) -> PyResult<Self> {
        if members.is_empty() || members.len() != settings.num_envs {
            let (rule, got) = (settings.num_envs, members.len());
            let message = must_be("the snapshot's number of acrobots", rule, got);
            return Err(PyValueError::new_err(message));
        }
        let shared = members[0].params;
        let own = range.is_some() || members.iter().any(|member| member.params != shared);
        Ok(Self {
            settings,
            engine: filled(&settings, own, range, members)?,
            pool: None,
        })
    }

    /// The parameters of an acrobot with one of them changed.
    fn changed(&self, index: usize, name: &str, value: &Bound<'_, PyAny>) -> PyResult<Params> {
        let params = with(self.member(index)?.params, name, value)?;
        with_batch!(&self.engine, many => many.check([params; 2])).map_err(rejected)?;
        Ok(params)
    }

    /// Sets the bounds between which each reset draws a parameter.
    fn draw(
        &mut self,
        name: &str,
        low: &Bound<'_, PyAny>,
        high: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        // The crate would draw another LINK_MOI for each link, and knows no range of equations.
        if matches!(name, "LINK_MOI" | "book_or_nips") {
            let message = format!("{name} must be a value or an array, not a Uniform");
            return Err(PyValueError::new_err(message));
        }
        let [lows, highs] = match self.range() {
            Some(range) => range,
            None => [self.member(0)?.params; 2],
        };
        let range = [with(lows, name, low)?, with(highs, name, high)?];
        self.change(Vec::new(), Some(range))
    }

    /// Sets the range, and the parameters of each acrobot, one for all if they share them, or none if they stay. The
    /// parameters are checked. Gives each acrobot its own parameters if necessary.
    fn change(&mut self, params: Vec<Params>, range: Option<Range>) -> PyResult<()> {
        let owns = with_batch!(&self.engine, many => {
            if let Some(range) = range {
                many.check(range).map_err(rejected)?;
            }
            many.own
        });
        if !owns && (range.is_some() || params.iter().any(|each| *each != params[0])) {
            self.engine = filled(&self.settings, true, None, self.members()?)?;
        }
        with_batch!(&mut self.engine, many => {
            many.set_range(range).map_err(rejected)?;
            for (index, params) in params.into_iter().enumerate() {
                many.set_params(index, params).map_err(rejected)?;
            }
        });
        Ok(())
    }

    fn range(&self) -> Option<Range> {
        with_batch!(&self.engine, many => many.range())
    }

    fn member(&self, index: usize) -> PyResult<Member<Host>> {
        with_batch!(&self.engine, many => many.member(index)).ok_or_else(no_such(index))
    }

    fn members(&self) -> PyResult<Vec<Member<Host>>> {
        let each = (0..self.settings.num_envs).map(|index| self.member(index));
        each.collect()
    }
}

/// An engine with these settings, this range of parameters and these acrobots.
fn filled(
    settings: &Settings,
    own: bool,
    range: Option<Range>,
    members: Vec<Member<Host>>,
) -> PyResult<Engine> {
    let mut engine = Engine::new(settings, own, SeedSequence::new(0))?;
    with_batch!(&mut engine, many => {
        many.set_range(range).map_err(rejected)?;
        for (index, member) in members.into_iter().enumerate() {
            // The first has the parameters that all share.
            if index == 0 {
                many.set_params(0, member.params).map_err(rejected)?;
            }
            many.set_member(index, member).map_err(rejected)?;
        }
    });
    Ok(engine)
}

/// The only access to a batch. Only its steps and resets let other threads run.
fn alone<'py>(batch: &Bound<'py, Batch>) -> PyResult<PyRefMut<'py, Batch>> {
    batch.try_borrow_mut().map_err(|_| {
        PyRuntimeError::new_err(
            "another thread is stepping or resetting an environment; \
             change parameters and call methods between its steps",
        )
    })
}

/// The bounds of a `Uniform`.
fn bounds<'py>(value: &Bound<'py, PyAny>) -> PyResult<Option<[Bound<'py, PyAny>; 2]>> {
    static UNIFORM: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let uniform = UNIFORM.import(value.py(), "acrobot_rs.parameters", "Uniform")?;
    let bounds = || Ok([value.getattr("low")?, value.getattr("high")?]);
    value.is_instance(uniform)?.then(bounds).transpose()
}

/// The same error with an index after the parameter's name, with which its message begins.
fn indexed(py: Python<'_>, error: PyErr, index: usize) -> PyErr {
    let message = error.value(py).to_string();
    let end = message.find([' ', '[']).unwrap_or(message.len());
    let (name, rest) = message.split_at(end);
    PyErr::from_type(error.get_type(py), format!("{name}[{index}]{rest}"))
}

/// Parses a seed: a decimal integer of at least 0, of any size.
fn parse(seed: &str) -> PyResult<SeedSequence> {
    seed.parse::<SeedSequence>().map_err(rejected)
}

fn no_such(index: usize) -> impl Fn() -> PyErr {
    move || PyIndexError::new_err(index)
}
