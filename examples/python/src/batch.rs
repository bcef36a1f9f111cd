//! The vector environment: steps many acrobots at once.

use acrobot::arithmetic::Host;
use acrobot::batch::{Member, StepBuffers};
use acrobot::numpy::SeedSequence;
use acrobot::physics::ResetBounds;
use acrobot::{Params, ResetOptions, State};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray1, PyReadwriteArray2};
use postcard::experimental::serialized_size;
use pyo3::exceptions::{PyIndexError, PyMemoryError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyType};
use serde::Serialize;

use crate::engine::{Engine, Inputs, MODES, Range, Settings, assemble, memory};
use crate::pool::Pool;
use crate::{
    VERSION, alone, failed, load, must_be, number, positive, rejected, render, take, unknown, with,
};

#[pyclass(module = "acrobot_rs._native")]
pub struct Batch {
    settings: Settings,
    engine: Box<dyn Engine>,
    pool: Option<Pool>,
}

/// What `__reduce__` returns: the type, the arguments of `new` and the argument of `__setstate__`.
type Reduced<'py> = (
    Bound<'py, PyType>,
    (i64, &'static str, i64, &'static str),
    Bound<'py, PyBytes>,
);

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
            own: false,
        };
        Ok(Self {
            settings,
            engine: assemble(&settings, parse(seed)?)?,
            pool: None,
        })
    }

    fn __len__(&self) -> usize {
        self.settings.num_envs
    }

    /// Sets a parameter of all acrobots: a value, or a `Uniform` between whose bounds each reset draws it.
    fn set(slf: &Bound<'_, Self>, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        Self::change(slf, name, value)?()
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
        let plan = this.plan(each, None)?;
        this.apply(plan)
    }

    /// A parameter of each acrobot.
    fn get<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let (py, this) = (slf.py(), alone(slf)?);
        let each = (0..this.settings.num_envs).map(|index| {
            let mut params = this.params(index)?;
            Ok(match number(&mut params, name) {
                Some(number) => number.into_pyobject(py)?.into_any(),
                None => params.torques.into_pyobject(py)?.into_any(),
            })
        });
        each.collect()
    }

    /// Gives acrobots streams of their own: those of `default_rng(seed)`, for each seed that is not `None`.
    fn seed(slf: &Bound<'_, Self>, seeds: Vec<Option<String>>) -> PyResult<()> {
        for (rng, seed) in alone(slf)?.engine.generators_mut().iter_mut().zip(seeds) {
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
        slf.py()
            .detach(|| engine.reset(options, mask))
            .map_err(rejected)
    }

    fn observe(
        slf: &Bound<'_, Self>,
        mut observations: PyReadwriteArray2<'_, f32>,
    ) -> PyResult<()> {
        let rows = observations.as_slice_mut()?.as_chunks_mut().0;
        alone(slf)?.engine.observe(rows).map_err(rejected)
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
        this.engine.read(inputs)?;
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
            1 => py.detach(|| engine.step(buffers, false)),
            threads => {
                let pool = Pool::of_this_process(&mut this.pool, threads)?;
                py.detach(|| pool.install(|| engine.step(buffers, true)))
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
            *row = this.engine.state(index).ok_or_else(no_such(index))?.into();
        }
        Ok(())
    }

    /// Sets all states, which must be finite. Episodes continue.
    fn set_states(slf: &Bound<'_, Self>, states: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let mut this = alone(slf)?;
        let rows = states.as_slice()?.as_chunks::<4>().0;
        for (index, row) in rows.iter().enumerate() {
            let state = State::from(*row);
            this.engine.set_state(index, state).map_err(rejected)?;
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

    /// Not a clone of the memory, which would abort the process where it does not fit.
    fn __deepcopy__(slf: &Bound<'_, Self>, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        let this = alone(slf)?;
        Ok(Self {
            settings: this.settings,
            engine: this.copied(&this.settings)?,
            pool: None,
        })
    }

    /// With arguments that make the smallest batch, which `__setstate__` then replaces. Every protocol of pickle calls this;
    /// `__getnewargs__` would serve those from 2 only.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let state = Self::__getstate__(slf)?;
        Ok((slf.get_type(), (1, "0", 1, "NextStep"), state))
    }

    /// A header, and the members one after the other. They are serialized twice, first to learn their size: a buffer
    /// that grows would need twice the memory, and abort the process where there is none.
    fn __getstate__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyBytes>> {
        let this = alone(slf)?;
        let header = (VERSION, this.settings, this.engine.range());
        let mut size = serialized_size(&header).map_err(failed)?;
        for index in 0..this.settings.num_envs {
            size += serialized_size(&this.member(index)?).map_err(failed)?;
        }
        PyBytes::new_with(slf.py(), size, |mut bytes| {
            bytes = put(&header, bytes)?;
            for index in 0..this.settings.num_envs {
                bytes = put(&this.member(index)?, bytes)?;
            }
            Ok(())
        })
    }

    fn __setstate__(slf: &Bound<'_, Self>, bytes: &[u8]) -> PyResult<()> {
        let mut this = alone(slf)?;
        *this = load(bytes, |bytes| {
            let (settings, range): (Settings, _) = take(bytes)?;
            // A member takes at least a byte, so a damaged number cannot ask for more memory than this.
            if settings.num_envs > bytes.len() {
                let rule = format_args!("at most {}", bytes.len());
                let message = must_be("the snapshot's num_envs", rule, settings.num_envs);
                return Err(PyValueError::new_err(message));
            }
            Ok(Self {
                settings,
                engine: filled(&settings, range, |_| take(bytes))?,
                pool: None,
            })
        })?;
        Ok(())
    }
}

/// Rewards, terminated and truncated.
type Results<'py> = (
    Bound<'py, PyArray1<f32>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
);

/// A change of parameters that was checked.
struct Plan {
    /// An engine with own parameters, if there was none.
    engine: Option<Box<dyn Engine>>,
    /// The parameters of each acrobot, one for all if they share them, or none if they stay.
    params: Vec<Params>,
    range: Option<Range>,
}

impl Batch {
    fn params(&self, index: usize) -> PyResult<Params> {
        Ok(self.member(index)?.params)
    }

    /// The parameters of an acrobot with one of them changed.
    fn changed(&self, index: usize, name: &str, value: &Bound<'_, PyAny>) -> PyResult<Params> {
        let params = with(self.params(index)?, name, value)?;
        self.engine.check([params; 2]).map_err(rejected)?;
        Ok(params)
    }

    /// Checks a parameter. Returns what sets it.
    pub fn change<'py>(
        slf: &Bound<'py, Self>,
        name: &str,
        value: &Bound<'py, PyAny>,
    ) -> PyResult<impl FnOnce() -> PyResult<()> + use<'py>> {
        let mut this = alone(slf)?;
        let plan = match bounds(value)? {
            Some([low, high]) => this.drawn(name, &low, &high)?,
            None => this.fixed(name, value)?,
        };
        Ok(move || this.apply(plan))
    }

    /// What sets a parameter of all acrobots.
    fn fixed(&self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<Plan> {
        let both =
            |[low, high]: Range| PyResult::Ok([with(low, name, value)?, with(high, name, value)?]);
        let range = self.engine.range().map(both).transpose()?;
        let count = if self.settings.own {
            self.settings.num_envs
        } else {
            1
        };
        let each = (0..count).map(|index| self.changed(index, name, value));
        self.plan(each.collect::<PyResult<_>>()?, range)
    }

    /// What sets the bounds between which each reset draws a parameter.
    fn drawn(&self, name: &str, low: &Bound<'_, PyAny>, high: &Bound<'_, PyAny>) -> PyResult<Plan> {
        // The crate would draw another LINK_MOI for each link, and knows no range of equations.
        if matches!(name, "LINK_MOI" | "book_or_nips") {
            let message = format!("{name} must be a value or an array, not a Uniform");
            return Err(PyValueError::new_err(message));
        }
        let [lows, highs] = match self.engine.range() {
            Some(range) => range,
            None => [self.params(0)?; 2],
        };
        let range = [with(lows, name, low)?, with(highs, name, high)?];
        self.plan(Vec::new(), Some(range))
    }

    /// Checks a range, and gives each acrobot its own parameters if necessary.
    fn plan(&self, params: Vec<Params>, range: Option<Range>) -> PyResult<Plan> {
        if let Some(range) = range {
            self.engine.check(range).map_err(rejected)?;
        }
        let own = range.is_some() || params.iter().any(|each| *each != params[0]);
        let settings = Settings {
            own,
            ..self.settings
        };
        let engine = (own && !self.settings.own).then(|| self.copied(&settings));
        Ok(Plan {
            engine: engine.transpose()?,
            params,
            range,
        })
    }

    /// Carries out a plan, which cannot fail: everything was checked.
    fn apply(&mut self, plan: Plan) -> PyResult<()> {
        if let Some(engine) = plan.engine {
            self.engine = engine;
            self.settings.own = true;
        }
        self.engine.set_range(plan.range).map_err(rejected)?;
        for (index, params) in plan.params.into_iter().enumerate() {
            self.engine.set_params(index, params).map_err(rejected)?;
        }
        Ok(())
    }

    /// A copy of the acrobots, with these settings.
    fn copied(&self, settings: &Settings) -> PyResult<Box<dyn Engine>> {
        filled(settings, self.engine.range(), |index| self.member(index))
    }

    fn member(&self, index: usize) -> PyResult<Member<Host>> {
        self.engine.member(index).ok_or_else(no_such(index))
    }
}

/// An engine with these settings, this range of parameters and these members.
fn filled(
    settings: &Settings,
    range: Option<Range>,
    mut member: impl FnMut(usize) -> PyResult<Member<Host>>,
) -> PyResult<Box<dyn Engine>> {
    let mut engine = assemble(settings, SeedSequence::new(0))?;
    engine.set_range(range).map_err(rejected)?;
    for index in 0..settings.num_envs {
        let member = member(index)?;
        // The first has the parameters that all share.
        if index == 0 && !settings.own {
            engine.set_params(index, member.params).map_err(rejected)?;
        }
        engine.set_member(index, member).map_err(rejected)?;
    }
    Ok(engine)
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

/// Serializes a value into the first bytes, and returns the others.
fn put<'a>(value: &impl Serialize, bytes: &'a mut [u8]) -> PyResult<&'a mut [u8]> {
    let size = postcard::to_slice(value, bytes).map_err(failed)?.len();
    Ok(&mut bytes[size..])
}
