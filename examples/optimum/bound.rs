//! A lower side: no policy reaches the goal in fewer steps than a function of the initial state says.
//!
//! The function W estimates the progress towards the goal, in steps. Two statements about all states are proved by
//! interval arithmetic, in boxes that are halved until the statement is certain:
//!
//! 1. From a state whose energy is below that of every goal state, no step increases W by more than 1.
//! 2. States with the energy of goal states have at least the progress `LEAST`.
//!
//! So from a state s the goal is at least `LEAST` − W(s) steps away.

use std::array::from_fn;
use std::error::Error;
use std::io::{self, Write};
use std::time::Instant;

use acrobot::State;

use crate::interval::{Interval, Jet};

/// (m1 lc1 + m2 l1) g and m2 lc2 g, N m, with Gymnasium's parameters, as in docs/equations.md. So are all numbers of
/// `energy` and `derivative`.
const GRAVITY: [f64; 2] = [14.7, 4.9];
/// More than rounding can change in a step of `f64`.
const SLACK: f64 = 1e-6;
/// Every goal state has at least this energy, J above hanging at rest: 14.7 J for a horizontal link 1, and 9.8 J for
/// link 2 that points up from there. Any other position of the tip at this height takes more.
const GOAL: f64 = 24.5 - SLACK;
/// No step from below `GOAL` leads above this energy, J.
const MOST: f64 = 27.0;

/// θ1, θ1 + θ2 and their velocities, rad and rad/s, in all states of at most the energy `MOST`, except mirror images.
const STATES: [[f64; 2]; 4] = [[-2.7, 2.7], [-3.2, 3.2], [0.0, 5.2], [-6.9, 6.9]];

/// The coefficients of W, from certificate.py.
const RADIAL: [f64; 5] = [6.1533, 1.0326, -0.11795, 0.00042032, -1.2626];
const PRODUCTS: [[f64; 3]; 5] = [
    [-1.6093, 5.4123, 0.10411],
    [2.0395, -6.0451, -0.19695],
    [1.8789, -6.3962, -0.16449],
    [-0.10754, 7.6804, -0.17387],
    [-0.87584, 3.4994, 0.050403],
];
/// The largest increase of W by a step, with a margin: a proof of less takes more boxes.
const UNIT: f64 = 1.2;
/// The least W with the energy of goal states, with a margin.
const LEAST: f64 = 39.5;

/// θ1, θ1 + θ2 and their velocities.
type Space<const N: usize> = [Jet<N>; 4];

/// The energy above hanging at rest, J.
fn energy<const N: usize>([alpha, beta, v, w]: Space<N>) -> Jet<N> {
    let [[_, cos1], [_, cos_sum], [_, cos2]] = [alpha, beta, beta - alpha].map(Jet::sin_cos);
    let kinetic = 1.125 * (v * v) + 0.625 * (w * w) + 0.5 * (cos2 * v * w);
    let one = Jet::constant(1.0);
    kinetic + GRAVITY[0] * (one - cos1) + GRAVITY[1] * (one - cos_sum)
}

fn derivative<const N: usize>([alpha, beta, v, w]: Space<N>, torque: f64) -> Space<N> {
    let [[sin1, _], [sin_sum, _], [sin2, cos2]] = [alpha, beta, beta - alpha].map(Jet::sin_cos);
    let torque = Jet::constant(torque);
    let force1 = 0.5 * (sin2 * w * w) - GRAVITY[0] * sin1 - torque;
    let force2 = torque - GRAVITY[1] * sin_sum - 0.5 * (sin2 * v * v);
    let inverse = (Jet::constant(2.5625) + 0.25 * (sin2 * sin2)).inverse();
    let coupling = 0.5 * cos2;
    let dv = (1.25 * force1 - coupling * force2) * inverse;
    let dw = (2.25 * force2 - coupling * force1) * inverse;
    [v, w, dv, dw]
}

/// The Runge-Kutta step of 0.2 s.
fn step<const N: usize>(y: Space<N>, torque: f64) -> Space<N> {
    let along = |h: f64, k: Space<N>| from_fn(|i| y[i] + h * k[i]);
    let k1 = derivative(y, torque);
    let k2 = derivative(along(0.1, k1), torque);
    let k3 = derivative(along(0.1, k2), torque);
    let k4 = derivative(along(0.2, k3), torque);
    along(
        0.2 / 6.0,
        from_fn(|i| k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]),
    )
}

/// W: a function of the energy, and a correction by the phase of the swing, because the motor gains most energy where
/// link 2 is fast.
fn progress<const N: usize>(y: Space<N>) -> Jet<N> {
    const AT_REST: f64 = 0.3;
    let [alpha, beta, v, w] = y;
    let [[sin1, _], [sin_sum, _], [sin2, _]] = [alpha, beta, beta - alpha].map(Jet::sin_cos);
    let r = (energy(y) + Jet::constant(AT_REST)).sqrt(AT_REST);
    let inverse = r.inverse();
    let [a, b, c, d, e] = RADIAL;
    let polynomial = ((d * r + Jet::constant(c)) * r + Jet::constant(b)) * r + Jet::constant(a);
    let radial = polynomial * r + e * inverse;
    let products = [sin2 * (w - v), sin1 * v, sin_sum * w, sin1 * w, sin_sum * v];
    products
        .into_iter()
        .zip(PRODUCTS)
        .fold(radial, |sum, (product, [p, q, s])| {
            sum + product * ((q * inverse + Jet::constant(p)) * inverse + Jet::constant(s))
        })
}

type Region = [Interval; 4];

/// A region and its middle.
struct Place {
    region: Region,
    all: Space<4>,
    middle: Space<0>,
}

impl Place {
    fn new(region: Region) -> Self {
        let middle = region.map(|x| Interval::point(x.middle()));
        Self {
            region,
            all: Jet::variables(region),
            middle: Jet::variables(middle),
        }
    }

    /// The range of a function, given its values and derivatives in the region and its value in the middle: from the
    /// mean value theorem.
    fn range(&self, all: &Jet<4>, middle: &Jet<0>) -> Interval {
        let offsets = self.region.map(|x| x - Interval::point(x.middle()));
        let terms = offsets.into_iter().zip(all.slopes);
        let mean = terms.fold(middle.value, |sum, (offset, slope)| sum + offset * slope);
        Interval::new(mean.low.max(all.value.low), mean.high.min(all.value.high))
    }

    /// The dimension that contributes most to the range of a function.
    fn widest(&self, f: &Jet<4>) -> usize {
        let width = |d: usize| {
            let Interval { low, high } = f.slopes[d];
            (self.region[d].high - self.region[d].low) * high.abs().max(low.abs())
        };
        (0..4)
            .max_by(|&a, &b| width(a).total_cmp(&width(b)))
            .expect("four dimensions")
    }
}

/// What is known of a statement in a region.
enum Verdict {
    Holds,
    Fails,
    /// Unknown until this dimension is halved.
    Halve(usize),
}

use Verdict::{Fails, Halve, Holds};

/// From a state below `GOAL`, no step increases W by more than `UNIT`, or the energy above `MOST`.
fn no_step_is_long(place: &Place) -> Verdict {
    let Place { all, middle, .. } = place;
    let below = energy(*middle);
    if place.range(&energy(*all), &below).low > GOAL {
        return Holds;
    }
    let before = (progress(*all), progress(*middle));
    for torque in [-1.0, 1.0, 0.0] {
        let after = (step(*all, torque), step(*middle, torque));
        let gain = (progress(after.0) - before.0, progress(after.1) - before.1);
        let energy = (energy(after.0), energy(after.1));
        for (f, limit) in [(gain, UNIT - SLACK), (energy, MOST - SLACK)] {
            if f.1.value.low > limit && below.value.high < GOAL {
                return Fails;
            }
            if place.range(&f.0, &f.1).high > limit {
                return Halve(place.widest(&f.0));
            }
        }
    }
    Holds
}

/// States from `GOAL` to `MOST` have at least the progress `LEAST`.
fn goals_are_far(place: &Place) -> Verdict {
    let energy = (energy(place.all), energy(place.middle));
    let range = place.range(&energy.0, &energy.1);
    if range.high < GOAL || range.low > MOST {
        return Holds;
    }
    let progress = (progress(place.all), progress(place.middle));
    if place.range(&progress.0, &progress.1).low >= LEAST {
        return Holds;
    }
    let middle = energy.1.value;
    if middle.low > GOAL && middle.high < MOST && progress.1.value.high < LEAST {
        return Fails;
    }
    Halve(place.widest(&progress.0))
}

/// Proves a statement in a region. Returns the number of boxes, or one in which it fails.
fn check(region: Region, statement: &(impl Fn(&Place) -> Verdict + Sync)) -> Result<u64, String> {
    match statement(&Place::new(region)) {
        Holds => Ok(1),
        Fails => Err(format!("it fails in {region:?}")),
        Halve(d) => {
            let [mut low, mut high] = [region; 2];
            low[d].high = region[d].middle();
            high[d].low = region[d].middle();
            let halves = || check(low, statement);
            let (low, high) = rayon::join(halves, || check(high, statement));
            Ok(low? + high?)
        }
    }
}

/// Proves both statements.
pub fn prove() -> Result<(), Box<dyn Error>> {
    let states = STATES.map(|[low, high]| Interval::new(low, high));
    let began = Instant::now();
    let far = check(states, &goals_are_far)?;
    let long = check(states, &no_step_is_long)?;
    writeln!(
        io::stdout(),
        "proved in {} boxes and {:.0} s: from hanging at rest the goal is at least {} steps away",
        far + long,
        began.elapsed().as_secs_f64(),
        least_steps(State::HANGING)
    )?;
    Ok(())
}

/// No policy reaches the goal in fewer steps.
pub fn least_steps(state: State) -> u32 {
    let State {
        theta1,
        theta2,
        dtheta1,
        dtheta2,
    } = state;
    let y = [theta1, theta1 + theta2, dtheta1, dtheta1 + dtheta2].map(Interval::point);
    ((LEAST - progress::<0>(Jet::variables(y)).value.high) / UNIT).ceil() as u32
}
