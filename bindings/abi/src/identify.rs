//! Parameters of a machine from recordings.

use core::ptr;

use acrobot::Params;
use acrobot::control::identify::{self, Calibration, Fit, Regression, Sample};

use crate::data::acrobot_params_t;
use crate::memory::{Holder, Span, array, change, check_apart, get, init, read};
use crate::model::compute;
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t};

/// A sample of a recording, in double precision.
#[repr(C)]
pub struct acrobot_sample_t {
    /// θ1 and θ2, rad, without jumps by whole turns.
    pub angles: [f64; 2],
    /// The torques on θ1 and θ2 from this sample to the next, N m. An acrobot's first is 0.
    pub torques: [f64; 2],
}

/// What fits recordings: the elements of the mass matrix where θ2 is ±π/2, [1, 1], [1, 2] and
/// [2, 2], kg m²; the moments m1 lc1 + m2 l1 and m2 lc2, kg m; the coupling m2 l1 lc2, kg m²;
/// viscous friction of both joints, N m s/rad; their Coulomb friction, N m.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_fit_t {
    pub values: [f64; 10],
    /// Their standard errors; INFINITY for a number that the recordings do not determine.
    pub std_errors: [f64; 10],
    /// The combination that they determine least: the part of each number.
    pub weakest: [f64; 10],
    /// How many combinations they do not determine.
    pub rank_deficiency: usize,
}

impl From<Fit> for acrobot_fit_t {
    fn from(Fit { values, std_errors, rank_deficiency, weakest }: Fit) -> Self {
        Self { values, std_errors, weakest, rank_deficiency }
    }
}

impl From<acrobot_fit_t> for Fit {
    fn from(fit: acrobot_fit_t) -> Self {
        let acrobot_fit_t { values, std_errors, weakest, rank_deficiency } = fit;
        Self { values, std_errors, rank_deficiency, weakest }
    }
}

/// Bytes of an acrobot_regression_t.
pub const ACROBOT_REGRESSION_SIZE: usize = 992;

/// A regression of recordings, of constant size. Call acrobot_regression_init first. You may copy
/// and move it.
#[repr(C, align(16))]
pub struct acrobot_regression_t {
    bytes: [u8; ACROBOT_REGRESSION_SIZE],
}

impl Holder for acrobot_regression_t {
    type Value = Regression;

    const TAG: u32 = u32::from_le_bytes(*b"regr");
}

fn samples_of(samples: *const acrobot_sample_t, count: usize) -> Result<*mut [Sample], Rejected> {
    // Both are `repr(C)` and have the same fields.
    array(samples.cast::<Sample>().cast_mut(), count)
}

/// Rejects parameters that are not finite in single precision.
fn single(params: Params) -> Result<acrobot_params_t, Rejected> {
    let params = params.cast::<f32>();
    params.validate()?;
    Ok(params.into())
}

unsafe fn double(params: *const acrobot_params_t) -> Result<Params, Rejected> {
    Ok(Params::<f32>::try_from(read(params)?)?.cast())
}

/// No recording.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_regression_init(
    regression: *mut acrobot_regression_t,
) -> acrobot_status_t {
    init(regression, ptr::null_mut(), || Ok(Regression::EMPTY))
}

/// Adds a recording with a sample in each `dt`, s, of a machine under `gravity`, m/s². A velocity
/// is that of a parabola through 2 `half` + 1 angles, and a window has so many samples; the next
/// one begins in its middle. Both are above 0. A recording that is too short adds nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_regression_add(
    regression: *mut acrobot_regression_t,
    samples: *const acrobot_sample_t,
    count: usize,
    dt: f64,
    gravity: f64,
    half: usize,
    window: usize,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(regression, ptr::null_mut(), error, |value| {
        let samples = samples_of(samples, count)?;
        check_apart(&[Span::new(regression, 1), Span::of(samples)])?;
        Ok(value.add(&*samples, dt, gravity, half, window)?)
    })
}

/// The numbers that fit the recordings best.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_regression_fit(
    regression: *const acrobot_regression_t,
    fit: *mut acrobot_fit_t,
) -> acrobot_status_t {
    get(regression, fit, |value| Ok(value.fit().into()))
}

/// The parameters of a fit: those of `given` with the length of link 1, masses, inertias, rotor and
/// friction that move as the machine does. Rejected if no machine has these numbers, or the
/// recordings do not determine one that is not a friction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_fit_params(
    fit: *const acrobot_fit_t,
    given: *const acrobot_params_t,
    params: *mut acrobot_params_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(params, error, || single(Fit::from(read(fit)?).params(double(given)?)?))
}

/// The parameters of a recording with a sample in each `dt` of `given`, whose lengths should be
/// about right, too. Tries many windows, and takes those that predict best. Believes the recording:
/// acrobot_calibrate finds or names wrong signs, zeros, a delay and lost samples.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_identify(
    samples: *const acrobot_sample_t,
    count: usize,
    given: *const acrobot_params_t,
    params: *mut acrobot_params_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(params, error, || {
        let samples = samples_of(samples, count)?;
        single(identify::identify(&[&*samples], double(given)?)?.0)
    })
}

/// What acrobot_calibrate finds.
#[repr(C)]
pub struct acrobot_calibration_t {
    /// The recorded angles where those of the machine are 0, rad.
    pub zeros: [f64; 2],
    /// From a torque until it acts, with the time constant of the motor, s.
    pub delay: f64,
    /// The root of the mean square of the errors of angles, rad, if parameters of the first two
    /// thirds of the recording predict the last third, √((length1 + center_of_mass2) / gravity)
    /// ahead.
    pub prediction_error: f64,
    /// The standard deviation of the noise of the angles, rad, which encoders add by counting.
    pub angle_noise: f64,
    pub fit: acrobot_fit_t,
    pub params: acrobot_params_t,
}

/// The zeros of both encoders, the delay and the parameters of a recording with a sample in each
/// `dt` of `given`, whose lengths should be about right, too. Rejected if more than 0.5 % of the
/// samples are lost, more than 3 % of the torques is unexplained, a number is not known within 3 %,
/// a link hardly moved, an angle or the torque has the wrong sign, the second angle is not that
/// from link 1, a zero is beyond 0.5 rad, or the masses are not within a factor of 30 of those
/// given.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_calibrate(
    samples: *const acrobot_sample_t,
    count: usize,
    given: *const acrobot_params_t,
    calibration: *mut acrobot_calibration_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(calibration, error, || {
        let samples = samples_of(samples, count)?;
        let Calibration { params, fit, zeros, delay, prediction_error, angle_noise } =
            identify::calibrate(&*samples, double(given)?)?;
        let (fit, params) = (fit.into(), single(params)?);
        Ok(acrobot_calibration_t { zeros, delay, prediction_error, angle_noise, fit, params })
    })
}

/// The root of the mean square of the errors of angles, rad, if they are predicted `horizon` steps
/// ahead; 0 for a recording that is too short.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_prediction_error(
    params: *const acrobot_params_t,
    samples: *const acrobot_sample_t,
    count: usize,
    horizon: usize,
    prediction_error: *mut f64,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    compute(prediction_error, error, || {
        let samples = samples_of(samples, count)?;
        Ok(identify::prediction_error(double(params)?, &*samples, horizon)?)
    })
}
