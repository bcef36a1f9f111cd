//! The motor and the sensors of environments.

use acrobot::arithmetic::{Arithmetic, Damped, Real};
use acrobot::batch::{Member, VecBatch};
use acrobot::task::{AnyTask, Draw, Instruments, Measured, Remembered};
use acrobot::{Error, Fast};
use pyo3::prelude::*;

use crate::engine::{Many, draw, out_of_memory};
use crate::{convert, held, named, rejected, wrong};

/// A task through instruments, with delays of up to 8 steps.
pub type Through = Measured<AnyTask, 8>;

/// What Python sets an instrument to.
pub enum Setting {
    Ideal,
    /// A number for all acrobots, or one for each.
    Numbers(Vec<f32>),
    Drawn(Draw<f32>),
}

impl Setting {
    /// From no values, from one or more numbers, or from an object that each reset draws from.
    pub fn read(name: &str, values: &[Bound<'_, PyAny>]) -> PyResult<Self> {
        let number = |value: &Bound<'_, PyAny>| {
            let number = held::<f32>(name, convert(name, "a number", value)?)?;
            Ok(number as f32)
        };
        let Some(first) = values.first() else { return Ok(Self::Ideal) };
        let Ok(kind) = first.getattr("_KIND") else {
            return values.iter().map(number).collect::<PyResult<_>>().map(Self::Numbers);
        };
        let kind: String = kind.extract()?;
        let attributes = ["low", "high", "mean", "std"];
        let given = attributes[..if kind == "normal" { 4 } else { 2 }].iter();
        let given = given.map(|each| Ok(f64::from(number(&first.getattr(*each)?)?)));
        Ok(Self::Drawn(draw(&kind, &given.collect::<PyResult<Vec<_>>>()?)))
    }

    /// The task with this instrument.
    pub fn task(&self, task: &Through, name: &str) -> PyResult<Through> {
        let mut instruments = *task.instruments();
        *place(&mut instruments, name) = match self {
            Self::Ideal => None,
            Self::Numbers(_) => Some(Draw::Fixed),
            Self::Drawn(draw) => Some(*draw),
        };
        Measured::new(*task.task(), instruments).map_err(|error| invalid(error, name))
    }

    /// What acrobot `index` then remembers.
    pub fn remember<A: Arithmetic>(
        &self,
        name: &str,
        index: usize,
        mut memory: Remembered<Through, A::Scalar>,
    ) -> PyResult<Remembered<Through, A::Scalar>> {
        if let Self::Numbers(numbers) = self {
            let mut drawn = Through::drawn(&memory);
            let number = numbers[index % numbers.len()];
            *place(&mut drawn, name) = Real::from_f64(number.into());
            Through::set_drawn(&mut memory, drawn).map_err(|error| match numbers.len() {
                1 => invalid(error, name),
                _ => invalid(error, &format!("{name}[{index}]")),
            })?;
        }
        Ok(memory)
    }
}

/// The error of a rejected instrument, with its name in Python.
fn invalid(error: Error, name: &str) -> PyErr {
    match error {
        Error::OutOfRange { value, unit: "steps", .. } => {
            wrong(name, "a whole number of steps from 0 to 8, or Uniform of two", value)
        }
        error => named(error, name),
    }
}

/// An instrument, by its name in Python.
pub fn place<'a, D: Copy>(instruments: &'a mut Instruments<D>, name: &str) -> &'a mut D {
    let names = instruments.numbers().map(|(name, _)| name);
    let is_named = |known: &&str| known.replace("zero", "zero_") == name;
    let place = names.iter().position(is_named).expect("a name in Instruments of parameters.py");
    instruments.numbers_mut().into_iter().nth(place).expect("as many numbers as names")
}

impl Many<Damped<Fast>, Through> {
    /// The same acrobots, through ideal instruments.
    pub fn through(many: &Many<Damped<Fast>>) -> PyResult<Self> {
        let from = &many.batch;
        let task = Through::new(*from.task(), Instruments::IDEAL).map_err(rejected)?;
        let mut batch = VecBatch::with_task(0, task, from.len()).map_err(out_of_memory)?;
        let mut copy = || {
            batch.set_max_steps(from.max_steps());
            if from.has_own_params() {
                batch.own_params()?;
            } else {
                batch.set_all_params(from.params(0)?)?;
            }
            for index in 0..from.len() {
                let Member { params, state, elapsed_steps, is_done, rng, .. } =
                    from.member(index)?;
                let memory = batch.memory(index)?;
                batch.set_member(
                    index,
                    Member { params, state, elapsed_steps, is_done, rng, memory },
                )?;
                batch.set_state(index, state)?;
            }
            batch.set_draws(*from.draws())?;
            batch.set_autoreset(from.autoreset());
            Ok(())
        };
        copy().map_err(|error: Error| rejected(error))?;
        Ok(Self::from(batch))
    }

    /// Sets an instrument of all acrobots, if all numbers are valid.
    pub fn set_instrument(&mut self, name: &str, setting: &Setting) -> PyResult<()> {
        let task = setting.task(self.batch.task(), name)?;
        let memories = (0..self.batch.len()).map(|index| {
            let memory = self.batch.memory(index).map_err(rejected)?;
            setting.remember::<Damped<Fast>>(name, index, memory)
        });
        let memories = memories.collect::<PyResult<Vec<_>>>()?;
        self.batch.set_task(task);
        let mut memories = memories.into_iter().enumerate();
        let set = memories.try_for_each(|(index, memory)| self.batch.set_memory(index, memory));
        set.map_err(rejected)
    }

    /// The number of an instrument of each acrobot.
    pub fn instrument(&self, name: &str) -> Vec<f64> {
        let memories = (0..self.batch.len()).filter_map(|index| self.batch.memory(index).ok());
        memories.map(|memory| (*place(&mut Through::drawn(&memory), name)).into()).collect()
    }
}
