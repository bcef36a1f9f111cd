//! Identifies the parameters of a machine from recorded angles and torques: of many ways to find
//! velocities the one that predicts best.

use super::recording::{Correction, Sample};
use super::regression::{Fit, Regression};
use crate::arithmetic::{Damped, Portable};
use crate::error::Error;
use crate::math::Real;
use crate::physics::{Params, Pendulum, State, wrap};

// Times, in T = √(l / g), where l is the distance of the second centre of mass from the fixed joint
// while the elbow is straight. Masses and inertias are not known yet. For RealAIGym's machine these
// are 0.2, 0.3, 0.5 and 0.8 s.
/// The windows that are tried.
const WINDOWS: [f64; 3] = [0.93, 1.4, 2.32];
/// Half of the parabolas that are tried: at least so many samples, and so long.
const HALVES: [(usize, f64); 4] = [(1, 0.01), (2, 0.02), (3, 0.03), (5, 0.05)];
/// How far the rest of a recording is predicted.
const AHEAD: f64 = 3.715;
/// Half of the parabola of a first state.
const FIRST: (usize, f64) = (3, 0.03);

/// Identifies a machine: its parameters, and the numbers that they follow from.
///
/// Each recording has a sample in each `dt` of `given`, under its gravity. Its lengths, too, should
/// be about right: with T = √((`length1` + `center_of_mass2`) / `gravity`), many fits and windows
/// of about T to 2.3 T are tried on the first three quarters of each recording. Those count that
/// predict the last quarters best, 3.7 T ahead. A recording of less than 15 T has no such quarter.
///
/// It believes the recordings. A wrong sign, a zero that is off, an absolute θ2, a torque that acts
/// late or is in another unit, and lost samples give wrong numbers without an error:
/// [`calibrate`](super::calibrate()) finds or names them.
///
/// ```
/// # use acrobot::control::identify::{Sample, identify};
/// # use acrobot::{Params, Portable, State, arithmetic::Damped, physics::Pendulum};
/// let mut machine = Pendulum::<Damped<Portable>>::new(Params::SWINGUP, State::HANGING)?;
/// let recording: [Sample; 1000] = std::array::from_fn(|tick| {
///     let (state, torque) = (machine.state(), 2.0 * (0.02 * tick as f64).sin()); // N m
///     machine.step(torque).unwrap();
///     Sample { angles: [state.theta1, state.theta2], torques: [0.0, torque] }
/// });
/// let (found, _) = identify(&[&recording], Params { damping1: 0.0, ..Params::SWINGUP })?;
/// assert!((found.damping1 - 0.05).abs() < 2e-3); // N m s/rad
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// # Errors
///
/// The errors of [`Regression::add`] and of [`Fit::params`].
pub fn identify(recordings: &[&[Sample]], given: Params) -> Result<(Params, Fit), Error> {
    let fit = |part: usize, half, window| {
        let mut regression = Regression::EMPTY;
        for samples in recordings {
            let samples = samples.get(..samples.len() * part / 4).unwrap_or(samples);
            regression.add(samples, given.dt, given.gravity, half, window)?;
        }
        let found = regression.fit();
        Ok::<_, Error>((found.params(given)?, found))
    };
    let windows = WINDOWS.map(|window| in_steps(&given, (8, window)));
    let halves = HALVES.map(|half| in_steps(&given, half));
    // These count where no recording is long enough for a prediction, whose error is then 0.
    let ([.., longest], [_, short, ..]) = (windows, halves);
    let (mut chosen, mut least) = ((short, longest), f64::INFINITY);
    for half in halves {
        for window in windows {
            let Ok((params, _)) = fit(3, half, window) else { continue };
            let mut error = 0.0;
            for samples in recordings {
                let last = samples.get(samples.len() * 3 / 4..).unwrap_or(samples);
                error += prediction_error(params, last, in_steps(&given, (8, AHEAD)))?;
            }
            if error > 0.0 && error < least {
                (chosen, least) = ((half, window), error);
            }
        }
    }
    let (half, window) = chosen;
    fit(4, half, window)
}

/// A time in steps of `dt`, but no fewer than the given steps. Without gravity it is these.
pub(super) fn in_steps(params: &Params, (least, time): (usize, f64)) -> usize {
    let unit = Real::sqrt((params.length1 + params.center_of_mass2) / params.gravity.abs());
    match time * unit / params.dt {
        steps if steps <= 1e6 => least.max(steps as usize),
        _ => least,
    }
}

/// The root of the mean square of the errors of angles, rad, if they are predicted `horizon` steps
/// ahead, from states that follow from seven angles each, or from more at a high rate. 0 for a
/// recording that is too short.
///
/// ```
/// use acrobot::Params;
/// use acrobot::control::identify::{Sample, prediction_error};
///
/// let params = Params { dt: 0.01, ..Params::DEFAULT };
/// let held = Sample { angles: [-0.32175, 1.5708], torques: [0.0, 4.6486] }; // rad, N m
/// let error = |mass2| prediction_error(Params { mass2, ..params }, &[held; 100], 20);
/// assert!(error(1.0)? < 1e-4 && error(1.1)? > 1e-3); // rad, after 0.2 s
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// # Errors
///
/// The errors of [`Pendulum::new`], and a recorded or a predicted number is not finite.
pub fn prediction_error(
    params: Params,
    recording: &[Sample],
    horizon: usize,
) -> Result<f64, Error> {
    corrected_prediction_error(params, recording, horizon, &Correction::NONE)
}

/// As [`prediction_error`], of a recording that needs a correction.
pub(super) fn corrected_prediction_error(
    params: Params,
    recording: &[Sample],
    horizon: usize,
    correction: &Correction,
) -> Result<f64, Error> {
    let half = in_steps(&params, FIRST);
    let fit = 2 * half + 1;
    let mut pendulum = Pendulum::<Damped<Portable>>::new(params, State::HANGING)?;
    let (mut squares, mut count) = (0.0, 0.0);
    let Correction { early, longest, .. } = *correction;
    let length = early.saturating_add(longest).saturating_add(horizon).saturating_add(fit);
    for samples in recording.windows(length).step_by((horizon / 2).max(1)) {
        let angles = samples.get(longest..).unwrap_or(samples);
        let ahead = angles.get(horizon..horizon + fit);
        let (Some(first), Some(last)) = (angles.get(..fit), ahead) else { break };
        let [[theta1, theta2], [dtheta1, dtheta2]] = correction.motion(first, params.dt);
        pendulum.set_state(State { theta1, theta2, dtheta1, dtheta2 })?;
        for step in 0..horizon {
            let [torque1, torque2] = correction.torques(samples, longest + half + step, 0.0);
            pendulum.push([torque1 * params.dt, 0.0])?;
            pendulum.step(torque2)?;
        }
        let [[measured1, measured2], _] = correction.motion(last, params.dt);
        let State { theta1, theta2, .. } = pendulum.state();
        let [error1, error2] = [wrap(theta1 - measured1), wrap(theta2 - measured2)];
        squares += error1 * error1 + error2 * error2;
        count += 2.0;
    }
    Ok(if count > 0.0 { Real::sqrt(squares / count) } else { 0.0 })
}
