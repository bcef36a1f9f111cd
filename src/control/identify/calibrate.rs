//! Calibrates a machine from a recording: the zeros of its encoders, its delay and its parameters.

use core::fmt;

use super::recording::{Correction, Sample, angle_noise};
use super::regression::{FRICTION, Fit, Regression, UNITS};
use super::windows::{corrected_prediction_error, in_steps};
use crate::error::Error;
use crate::physics::Params;

/// The largest zero that is tried, rad.
const ZERO: f64 = 0.5;
// Times as in `windows.rs`, with the least steps. Short windows show a delay best.
const DELAY: (usize, f64) = (1, 0.5);
/// How much earlier a torque may act, so that an error names it: a quarter of this is an error.
const EARLY: (usize, f64) = (1, 0.1);
const HALF: (usize, f64) = (1, 0.005);
const WINDOW: (usize, f64) = (8, 0.93);
const AHEAD: (usize, f64) = (8, 1.0);
/// The parts of both recorded angles in θ2, which should be the first.
const FRAMES: [[f64; 2]; 4] = [[0.0, 1.0], [0.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
/// The most sweeps of a search, which needs about 20, and its finest change: a part of a range.
const SWEEPS: u32 = 100;
const FINEST: f64 = 1e-3;
/// How much of the torque may be unexplained. Of 144 random machines at most 2.6 % was.
const UNEXPLAINED: f64 = 0.03;
/// A frame that leaves less is the right one.
const CERTAIN: f64 = 0.01;
/// How large a standard error may be, divided by its number.
const UNKNOWN: f64 = 0.03;
/// Errors are up to so many times as large as standard errors.
const LARGER: f64 = 5.0;
/// A link whose angle has a smaller range, rad, hardly moved.
const HARDLY: f64 = 0.2;
/// How many samples may be lost: with 0.5 % masses are up to 4 % wrong.
const LOST: f64 = 0.005;
/// In another unit, such as mN m or N cm, torques make masses at least 100 times too large.
const OTHER_UNIT: f64 = 30.0;

/// What [`calibrate`] finds.
#[derive(Clone, Copy, Debug)]
pub struct Calibration {
    /// The given parameters with those that the recording determines.
    pub params: Params,
    /// The numbers that they follow from.
    pub fit: Fit,
    /// The recorded angles where those of the machine are 0, rad.
    pub zeros: [f64; 2],
    /// From a torque until it acts, with the time constant of the motor, s.
    pub delay: f64,
    /// The root of the mean square of the errors of angles, rad, if parameters of the first two
    /// thirds of the recording predict the last third, T ahead.
    pub prediction_error: f64,
    /// The standard deviation of the noise of the angles, rad, which encoders add by counting. At
    /// ticks above 5 ms this may be several times too large.
    pub angle_noise: f64,
}

/// A report in words: each number, how well it predicts, and what the recording does not tell.
impl fmt::Display for Calibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { params, fit, zeros: [zero1, zero2], delay, prediction_error, angle_noise } =
            self;
        let numbers = Fit::NAMES.into_iter().zip(fit.values).zip(fit.std_errors).zip(UNITS);
        for (((name, value), error), unit) in numbers.clone() {
            writeln!(f, "{name:8} {value:9.5} ± {error:.5} {unit}")?;
        }
        writeln!(f, "zeros    {zero1:9.5} {zero2:9.5} rad")?;
        writeln!(f, "delay    {delay:9.5} s")?;
        if *prediction_error > 0.0 {
            let ahead = in_steps(params, AHEAD) as f64 * params.dt;
            let ratio = prediction_error / angle_noise;
            writeln!(f, "The first two thirds predict the last third, {ahead:.1} s ahead, within")?;
            writeln!(f, "{prediction_error:.5} rad: {ratio:.0} times the noise of the angles.")?;
        } else {
            writeln!(f, "The recording is too short to tell how well it predicts.")?;
        }
        for (((name, value), error), unit) in numbers.skip(FRICTION) {
            if LARGER * error > value {
                let most = value + LARGER * error;
                writeln!(f, "{name} is not told, only that it is below {most:.5} {unit}.")?;
            }
        }
        Ok(())
    }
}

/// Calibrates a machine from a recording with a sample in each `dt` of `given`, under its gravity.
///
/// Tries zeros up to 0.5 rad and delays up to T / 2, where T is
/// √((`length1` + `center_of_mass2`) / `gravity`), so that link 1's length and link 2's centre of
/// mass should be about right. Those are best that leave the least of the torques unexplained.
/// [A machine of your own](crate::guide::real#2-identify) has an example with counts.
///
/// ```
/// # use acrobot::control::identify::{Sample, calibrate};
/// # use acrobot::numpy::{Pcg64, uniform};
/// # use acrobot::{Params, Portable, State, arithmetic::Damped, physics::Pendulum};
/// let mut machine = Pendulum::<Damped<Portable>>::new(Params::SWINGUP, State::HANGING)?;
/// let (mut rng, mut torque, mut sent) = (Pcg64::new(1), 0.0, [0.0; 3]);
/// let recording: [Sample; 1000] = std::array::from_fn(|tick| {
///     if tick % 15 == 0 {
///         torque = uniform(&mut rng, -2.0, 2.0); // N m
///     }
///     let State { theta1, theta2, .. } = machine.state();
///     sent = [torque, sent[0], sent[1]];
///     machine.step(sent[2]).unwrap(); // it acts two samples later
///     Sample { angles: [theta1 + 0.1, theta2 - 0.2], torques: [0.0, torque] }
/// });
/// let given: Params = Params { damping1: 0.0, ..Params::SWINGUP };
/// let found = calibrate(&recording, given)?;
/// assert!((found.zeros[0] - 0.1).abs() < 5e-3 && (found.zeros[1] + 0.2).abs() < 5e-3); // rad
/// assert!((found.delay - 2.0 * given.dt).abs() < 1e-3); // s
/// assert!((found.params.damping1 - 0.05).abs() < 2e-3); // N m s/rad
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// # Errors
///
/// The errors of [`Regression::add`] and of [`Fit::params`]. More than 0.5 % of the samples are
/// lost, more than 3 % of the torques is unexplained, a number is not known within 3 %, or a link
/// hardly moved, by less than 0.2 rad. An angle
/// or the torque has the wrong sign, or the second angle is not that from link 1. A zero or the
/// delay is at the end of its range, or torques act before they are recorded. Both links together
/// have more than 30 times the given masses or less than 1/30 of them, because torques are in
/// another unit: a smaller factor in the torques cannot be told from one in the masses.
pub fn calibrate(recording: &[Sample], given: Params) -> Result<Calibration, Error> {
    let (mut correction, mut least) = (Correction::NONE, f64::INFINITY);
    for theta2 in FRAMES {
        let (of_frame, unexplained) = search(recording, &given, theta2)?;
        if unexplained < least {
            (correction, least) = (of_frame, unexplained);
        }
        if least < CERTAIN {
            break;
        }
    }
    let regression = regress(recording, &given, &correction)?;
    let fit = regression.fit();
    if fit.rank_deficiency > 0 {
        moved(recording)?;
        fit.params(given)?;
    }
    let lost = lost(recording);
    if lost > LOST {
        let rule = "at most 0.5 (both angles turn twice as far as before and after), in";
        return out_of_range("lost samples", 100.0 * lost, "%", rule);
    }
    if let Err(error) = check(&correction, least, &regression.fit_free([true; _]), given.dt) {
        moved(recording)?;
        return Err(error);
    }
    let (first, last) =
        recording.split_at_checked(recording.len() / 3 * 2).unwrap_or((recording, &[]));
    let of_first = regress(first, &given, &correction)?.fit().params(given)?;
    let ahead = in_steps(&given, AHEAD);
    let params = fit.params(given)?;
    let mass = params.mass1 + params.mass2;
    let ratio = mass / (given.mass1 + given.mass2);
    if !(1.0 / OTHER_UNIT..=OTHER_UNIT).contains(&ratio) {
        let rule = "from 1/30 to 30 times that of the given ones (are torques in N m?), in";
        return out_of_range("mass1 + mass2", mass, "kg", rule);
    }
    Ok(Calibration {
        params,
        fit,
        zeros: correction.zeros,
        delay: correction.delay.max(0.0) * given.dt,
        prediction_error: corrected_prediction_error(of_first, last, ahead, &correction)?,
        angle_noise: angle_noise(recording),
    })
}

fn regress(
    samples: &[Sample],
    given: &Params,
    correction: &Correction,
) -> Result<Regression, Error> {
    let (half, window) = (in_steps(given, HALF), in_steps(given, WINDOW));
    let mut regression = Regression::EMPTY;
    regression.add_corrected(samples, given.dt, given.gravity, half, window, correction)?;
    Ok(regression)
}

/// The zeros and the delay that leave the least unexplained, and what they leave. Each sweep
/// changes one after the other; without a gain the next changes are half as large.
fn search(
    recording: &[Sample],
    given: &Params,
    theta2: [f64; 2],
) -> Result<(Correction, f64), Error> {
    let (early, longest) = (in_steps(given, EARLY), in_steps(given, DELAY));
    let (least_delay, range) = (-(early as f64), (early + longest) as f64);
    let correction = |[zero1, zero2, delay]: [f64; 3]| Correction {
        zeros: [ZERO * zero1, ZERO * zero2],
        theta2,
        delay: least_delay + 0.5 * (1.0 + delay) * range,
        early,
        longest,
    };
    let unexplained =
        |at| Ok::<_, Error>(regress(recording, given, &correction(at))?.unexplained());
    // Without a delay.
    let (mut at, mut change) = ([0.0, 0.0, -2.0 * least_delay / range - 1.0], 0.25);
    let mut least = unexplained(at)?;
    for _ in 0..SWEEPS {
        let before = least;
        for (i, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)] {
            let mut other = at;
            if let Some(x) = other.get_mut(i) {
                *x = (*x + sign * change).clamp(-1.0, 1.0);
            }
            let left = unexplained(other)?;
            if left < least {
                (at, least) = (other, left);
            }
        }
        change *= if least < before { 1.0 } else { 0.5 };
        if change < FINEST {
            break;
        }
    }
    Ok((correction(at), least))
}

/// The part of the samples that is lost: both angles turn twice as far as before and after.
fn lost(samples: &[Sample]) -> f64 {
    // How far an angle turns in the steps before and after, in the mean, and how much farther in
    // the one between.
    let step = |[a, b, c, d]: [f64; 4]| {
        let mean = (b - a + d - c) / 2.0;
        [mean, c - b - mean]
    };
    let steps = samples.windows(4).filter_map(|window| {
        let [[a1, a2], [b1, b2], [c1, c2], [d1, d2]] =
            <[Sample; 4]>::try_from(window).ok()?.map(|sample| sample.angles);
        Some([step([a1, b1, c1, d1]), step([a2, b2, c2, d2])])
    });
    let sums = steps.clone().fold([0.0; 2], |[sum1, sum2], [[_, farther1], [_, farther2]]| {
        [sum1 + farther1.abs(), sum2 + farther2.abs()]
    });
    let usual = sums.map(|sum: f64| sum / samples.len() as f64);
    let (mut fast, mut doubled) = (0.0, 0.0);
    for both in steps {
        // The others are noise: encoders count whole numbers.
        if both.iter().zip(usual).all(|([mean, _], usual)| mean.abs() > 4.0 * usual) {
            let is_double = |[mean, farther]: [f64; 2]| (farther / mean - 1.0).abs() < 0.25;
            fast += 1.0;
            doubled += if both.into_iter().all(is_double) { 1.0 } else { 0.0 };
        }
    }
    if fast > 0.0 { doubled / fast } else { 0.0 }
}

/// Checks that both links moved. A recording without samples has no range.
fn moved(recording: &[Sample]) -> Result<(), Error> {
    let rules = [
        ("range of angle1", "at least 0.2 (link 1 hardly moved, or its encoder is dead), in"),
        ("range of angle2", "at least 0.2 (link 2 hardly moved, or its encoder is dead), in"),
    ];
    for (i, (name, rule)) in rules.into_iter().enumerate() {
        let angles = recording.iter().filter_map(|sample| sample.angles.get(i).copied());
        let most = angles.clone().fold(f64::NEG_INFINITY, f64::max);
        let range = most - angles.fold(f64::INFINITY, f64::min);
        if (0.0..HARDLY).contains(&range) {
            return out_of_range(name, range, "rad", rule);
        }
    }
    Ok(())
}

fn out_of_range<T>(
    name: &'static str,
    value: f64,
    unit: &'static str,
    rule: &'static str,
) -> Result<T, Error> {
    Err(Error::OutOfRange { name, value, unit, rule })
}

/// Checks what a search found. The signs need a fit whose friction can be below 0: with the wrong
/// sign of the torque all numbers are.
fn check(found: &Correction, unexplained: f64, fit: &Fit, dt: f64) -> Result<(), Error> {
    if unexplained > UNEXPLAINED {
        return out_of_range("unexplained torque", 100.0 * unexplained, "%", "at most 3");
    }
    let numbers = Fit::NAMES.into_iter().zip(fit.values).zip(fit.std_errors);
    for ((name, number), error) in numbers.take(FRICTION) {
        let unknown = (error / number).abs();
        if unknown > UNKNOWN {
            let rule = "known within 3 (shake longer, with more torque), in";
            return out_of_range(name, 100.0 * unknown, "%", rule);
        }
    }
    let [_, _, mass22, ..] = fit.values;
    let counterclockwise = "1 (counterclockwise)";
    match (found.theta2, mass22 > 0.0) {
        ([_, -1.0], true) => return out_of_range("sign of angle2", -1.0, "", counterclockwise),
        ([_, -1.0], false) => return out_of_range("sign of angle1", -1.0, "", counterclockwise),
        (_, false) => return out_of_range("sign of torque", -1.0, "", "1 (θ2 grows)"),
        ([-1.0, _], _) => {
            return out_of_range("angle1 in angle2", 1.0, "", "0 (measure θ2 from link 1)");
        }
        _ => (),
    }
    for (name, zero) in ["zero1", "zero2"].into_iter().zip(found.zeros) {
        if zero.abs() >= ZERO {
            return out_of_range(name, zero, "rad", "between -0.5 and 0.5");
        }
    }
    if found.delay < -0.25 * found.early as f64 {
        let rule = "at least 0 (record a torque before it acts), in";
        return out_of_range("delay", found.delay * dt, "s", rule);
    }
    if found.delay >= found.longest as f64 {
        let rule = "below √((length1 + center_of_mass2) / gravity) / 2, in";
        return out_of_range("delay", found.delay * dt, "s", rule);
    }
    Ok(())
}
