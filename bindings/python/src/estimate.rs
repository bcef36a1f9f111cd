//! The state of a machine from its angles, and its parameters.

use acrobot::Portable;
use acrobot::arithmetic::Damped;
use acrobot::control;
use acrobot::control::estimate::{Noise, ParameterEstimator, ParameterStd};
use acrobot::control::identify::{Calibration, Fit, Sample};
use pyo3::prelude::*;

use crate::single::Acrobot;
use crate::{NAMES, Params, alone, load, named, place_of, rejected, save};

/// Estimates a state and parameters. Those with a standard deviation of 0 are known.
#[pyclass(module = "acrobot_rs._native")]
pub struct Estimator(ParameterEstimator<Damped<Portable>>);

#[pymethods]
impl Estimator {
    #[new]
    fn new(
        acrobot: &Bound<'_, Acrobot>,
        angle_std: f64,
        torque_std: f64,
        parameter_std: [f64; 13],
    ) -> PyResult<Self> {
        let [mass1, mass2, length1, inertia1, inertia2, ..] = parameter_std;
        let [.., damping1, damping2, coulomb1, coulomb2, rotor, _, _, _] = parameter_std;
        let [.., zero1, zero2, torque_factor] = parameter_std;
        let links =
            ParameterStd { mass1, mass2, length1, inertia1, inertia2, ..Default::default() };
        let links = ParameterStd { damping1, damping2, coulomb1, coulomb2, rotor, ..links };
        let std = ParameterStd { zero1, zero2, torque_factor, ..links };
        let noise = Noise { angle_std, torque_std };
        let estimator = ParameterEstimator::new(alone(acrobot)?.acrobot.params(), std, noise);
        estimator.map(Self).map_err(|error| {
            let name = match error.name() {
                "zero1" => "ZERO_1",
                "zero2" => "ZERO_2",
                "torque_factor" => "TORQUE_FACTOR",
                _ => place_of(error).map_or("", |place| NAMES[place]),
            };
            match name {
                "" => rejected(error),
                name => named(error, format_args!("parameter_std['{name}']")),
            }
        })
    }

    fn correct(slf: &Bound<'_, Self>, angles: [f64; 2]) -> PyResult<[f64; 4]> {
        let mut this = alone(slf)?;
        this.0.correct(angles).map_err(rejected)?;
        Ok(this.0.state().into())
    }

    fn predict(slf: &Bound<'_, Self>, torque: f64) -> PyResult<()> {
        alone(slf)?.0.predict(torque).map_err(rejected)
    }

    fn state_std(slf: &Bound<'_, Self>) -> PyResult<Option<[f64; 4]>> {
        Ok(alone(slf)?.0.state_std())
    }

    fn zeros(slf: &Bound<'_, Self>) -> PyResult<[f64; 2]> {
        Ok(alone(slf)?.0.zeros())
    }

    fn torque_factor(slf: &Bound<'_, Self>) -> PyResult<f64> {
        Ok(alone(slf)?.0.torque_factor())
    }

    fn params(slf: &Bound<'_, Self>) -> PyResult<Named<f64>> {
        Ok(named_numbers(alone(slf)?.0.params()))
    }

    /// Makes any estimator, which `__setstate__` then replaces by a copy of this one.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<impl IntoPyObject<'py>> {
        let any = (Acrobot::new(false, "gymnasium")?, 1.0, 1.0, [0.0; 13]);
        Ok((slf.get_type(), any, save(slf.py(), &alone(slf)?.0)?))
    }

    fn __setstate__(slf: &Bound<'_, Self>, bytes: &[u8]) -> PyResult<()> {
        alone(slf)?.0 = load(bytes)?;
        Ok(())
    }
}

fn samples(rows: Vec<[f64; 4]>) -> Vec<Sample> {
    let sample = |[angle1, angle2, torque1, torque2]: [f64; 4]| Sample {
        angles: [angle1, angle2],
        torques: [torque1, torque2],
    };
    rows.into_iter().map(sample).collect()
}

/// Parameters; the numbers that they follow from, with standard errors and parts of the weakest
/// combination; and the rank deficiency.
type Found = (Named<f64>, Named<[f64; 3]>, usize);

fn found(params: &Params, fit: Fit) -> Found {
    let Fit { values, std_errors, weakest, rank_deficiency } = fit;
    let numbers = Fit::NAMES.into_iter().enumerate();
    let numbers = numbers.map(|(i, name)| (name, [values[i], std_errors[i], weakest[i]])).collect();
    (named_numbers(params), numbers, rank_deficiency)
}

/// Angles and torques, a row for each sample of each recording.
#[pyfunction]
pub fn identify(acrobot: &Bound<'_, Acrobot>, recordings: Vec<Vec<[f64; 4]>>) -> PyResult<Found> {
    let recordings: Vec<Vec<_>> = recordings.into_iter().map(samples).collect();
    let recordings: Vec<&[_]> = recordings.iter().map(Vec::as_slice).collect();
    let given = alone(acrobot)?.acrobot.params();
    let (params, fit) = control::identify::identify(&recordings, given).map_err(rejected)?;
    Ok(found(&params, fit))
}

/// Of one recording also the zeros, the delay, the error of the prediction, the noise of the angles
/// and the report.
#[pyfunction]
pub fn calibrate(
    acrobot: &Bound<'_, Acrobot>,
    recording: Vec<[f64; 4]>,
) -> PyResult<(Found, [f64; 2], [f64; 3], String)> {
    let given = alone(acrobot)?.acrobot.params();
    let calibration = control::identify::calibrate(&samples(recording), given).map_err(rejected)?;
    let report = calibration.to_string();
    let Calibration { params, fit, zeros, delay, prediction_error, angle_noise } = calibration;
    Ok((found(&params, fit), zeros, [delay, prediction_error, angle_noise], report))
}

/// Names and what they stand for.
pub type Named<T> = Vec<(&'static str, T)>;

/// The parameters that are one number, by Python's names.
pub fn named_numbers(params: &Params) -> Named<f64> {
    let numbers = NAMES.into_iter().zip(params.numbers()).map(|(name, (_, number))| (name, number));
    numbers.filter(|(name, _)| *name != "AVAIL_TORQUE").collect()
}
