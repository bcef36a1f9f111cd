//! Model-predictive control: from encoder counts to torques.

use std::sync::{Mutex, MutexGuard, PoisonError};

use acrobot::control::mpc::{self, Report, Settings};
use pyo3::prelude::*;

use crate::estimate::{Named, named_numbers};
use crate::single::Acrobot;
use crate::{alone, invalid, rejected};

/// The decisions of a plan.
const DECISIONS: usize = 100;

fn settings(
    acrobot: &Bound<'_, Acrobot>,
    [limit, delay, plan_timeout]: [f32; 3],
    counts: [i32; 2],
) -> PyResult<Settings> {
    let params = alone(acrobot)?.acrobot.params().cast();
    Ok(Settings { params, limit, counts, delay, plan_timeout })
}

/// What each tick calls. Another thread exchanges plans, so calls wait for each other, briefly.
#[pyclass(frozen, module = "acrobot_rs._native")]
pub struct Controller(Mutex<mpc::Controller<DECISIONS>>);

impl Controller {
    fn lock(&self) -> MutexGuard<'_, mpc::Controller<DECISIONS>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Controller {
    #[new]
    fn new(acrobot: &Bound<'_, Acrobot>, numbers: [f32; 3], counts: [i32; 2]) -> PyResult<Self> {
        let controller = mpc::Controller::new(settings(acrobot, numbers, counts)?);
        controller.map(Mutex::new).map(Self).map_err(|error| invalid(error, None))
    }

    fn tick(&self, counts: [i32; 2]) -> PyResult<f32> {
        self.lock().tick(counts).map_err(rejected)
    }

    fn state(&self) -> [f32; 4] {
        self.lock().state().into()
    }

    fn params(&self) -> Named<f64> {
        named_numbers(&self.lock().params().cast())
    }

    fn report(&self) -> ([f32; 2], f32, f32, f32) {
        let Report { zeros, torque_factor, misses, plan_age } = self.lock().report();
        (zeros, torque_factor, misses, plan_age)
    }
}

/// What another thread calls.
#[pyclass(module = "acrobot_rs._native")]
pub struct Replanner(mpc::Replanner<DECISIONS>);

#[pymethods]
impl Replanner {
    #[new]
    fn new(acrobot: &Bound<'_, Acrobot>, numbers: [f32; 3], counts: [i32; 2]) -> PyResult<Self> {
        let replanner = mpc::Replanner::new(settings(acrobot, numbers, counts)?);
        replanner.map(Self).map_err(|error| invalid(error, None))
    }

    fn exchange(slf: &Bound<'_, Self>, controller: &Bound<'_, Controller>) -> PyResult<()> {
        alone(slf)?.0.exchange(&mut controller.get().lock());
        Ok(())
    }

    fn work(slf: &Bound<'_, Self>) -> PyResult<()> {
        let mut this = alone(slf)?;
        let replanner = &mut this.0;
        slf.py().detach(|| replanner.work());
        Ok(())
    }
}
