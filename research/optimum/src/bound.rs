//! A lower bound: no policy reaches the goal in fewer steps than a function of the initial state
//! says.
//!
//! Taylor models prove the statement of docs/optimum.md about the function P and the target for all
//! states, in boxes that are halved until it is certain: for Gymnasium's parameters, the book's
//! dynamics, `f64`, and angles from −π to π.

use std::array::from_fn;
use std::ops::Add;

use acrobot::{Params, State};
use anyhow::bail;
use indicatif::ParallelProgressIterator;
use rayon::prelude::*;

use crate::certificate::{AT_TARGET, QUADRATIC, QUARTIC, RADIAL, UNIT};
use crate::taylor::{PAIRS, TaylorModel};

/// (m1 lc1 + m2 l1) g and m2 lc2 g, N m, of docs/equations.md with Gymnasium's parameters, as are
/// the numbers in `derivative` and `energy_height_progress`.
const GRAVITY: [f64; 2] = [14.7, 4.9];
/// The torques, N m.
const TORQUES: [f64; 3] = Params::<f64>::DEFAULT.torques;
/// More than rounding can change in a step of `f64`, and in its check of the goal.
const SLACK: f64 = 1e-6;
/// The energy above hanging at rest, J, from which a state is in the target.
const MOST: f64 = 30.0;

/// θ1, θ1 + θ2 and their velocities, rad and rad/s, of all states up to the energy `MOST`, except
/// mirror images and whole turns. Outside there is more kinetic energy: docs/optimum.md. These
/// numbers are multiples of 1/4, so halving them is exact.
const STATES: [[f64; 2]; 4] = [[-3.25, 3.25], [-3.25, 3.25], [0.0, 5.5], [-7.5, 7.5]];

/// θ1, θ1 + θ2 and their velocities.
type Space = [TaylorModel; 4];

fn derivative([alpha, beta, v, w]: Space, torque: f64) -> Space {
    const LEAST: f64 = 2.5625;
    let [[sin1, _], [sin_sum, _], [sin2, cos2]] = [alpha, beta, beta - alpha].map(|x| x.sin_cos());
    let torque = TaylorModel::from(torque);
    let force1 = 0.5 * (sin2 * w.square()) - GRAVITY[0] * sin1 - torque;
    let force2 = torque - GRAVITY[1] * sin_sum - 0.5 * (sin2 * v.square());
    let inverse = (TaylorModel::from(LEAST) + 0.25 * sin2.square()).inverse(LEAST);
    let coupling = 0.5 * cos2;
    let dv = (1.25 * force1 - coupling * force2) * inverse;
    let dw = (2.25 * force2 - coupling * force1) * inverse;
    [v, w, dv, dw]
}

/// The Runge-Kutta step of 0.2 s.
fn step(y: Space, torque: f64) -> Space {
    let along = |h: f64, k: Space| from_fn(|i| TaylorModel::sum([(1.0, &y[i]), (h, &k[i])]));
    let k1 = derivative(y, torque);
    let k2 = derivative(along(0.1, k1), torque);
    let k3 = derivative(along(0.1, k2), torque);
    let k4 = derivative(along(0.2, k3), torque);
    let k = from_fn(|i| k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
    along(0.2 / 6.0, k)
}

/// The energy above hanging at rest, J, the height of the free end above the axis, m, and P. With
/// r = √(energy + 0.3):
///
/// P = Σ RADIAL rⁿ + Σ r⁻ⁿ (quadratic polynomials of x, times cosines) + Σ r⁻ⁿ⁻¹ (polynomials of x
/// of degree 4), x = (sin θ1, sin(θ1 + θ2), and the velocities of both angles).
fn energy_height_progress(y: Space) -> [TaylorModel; 3] {
    const AT_REST: f64 = 0.3;
    let sum = TaylorModel::sum;
    let [alpha, beta, v, w] = y;
    let [[sin1, cos1], [sin_sum, cos_sum], [_, cos2]] =
        [alpha, beta, beta - alpha].map(|x| x.sin_cos());
    let one = TaylorModel::from(1.0);
    let kinetic = 1.125 * v.square() + 0.625 * w.square() + 0.5 * (cos2 * v * w);
    let energy = kinetic + GRAVITY[0] * (one - cos1) + GRAVITY[1] * (one - cos_sum);

    let r = (energy + TaylorModel::from(AT_REST)).sqrt(AT_REST);
    let inverse = r.inverse(AT_REST.sqrt().next_down());
    let [a, b, c, d, e] = RADIAL.map(TaylorModel::from);
    let radial = (((d * r + c) * r + b) * r + a) * r + e * inverse;

    let x = [sin1, sin_sum, v, w];
    let pairs = PAIRS.map(|(i, j)| match i == j {
        true => x[i].square(),
        false => x[i] * x[j],
    });
    let cosines = [one, cos1, cos_sum, cos1 * cos_sum];
    let (quadratic, _) = QUADRATIC.as_chunks::<10>();
    let phases = quadratic.chunks(4).zip(QUARTIC.chunks(35)).rev();
    let phase = phases.fold(TaylorModel::from(0.0), |phase, (quadratic, quartic)| {
        let terms = cosines.iter().zip(quadratic);
        let terms =
            terms.map(|(&cosine, factors)| cosine * sum(factors.iter().copied().zip(&pairs)));
        terms.fold((phase + self::quartic(quartic, &pairs)) * inverse, Add::add)
    });
    [energy, -1.0 * (cos1 + cos_sum), radial + phase]
}

/// A polynomial of degree 4, given the products of two of its variables.
fn quartic(mut factors: &[f64], pairs: &[TaylorModel; 10]) -> TaylorModel {
    let terms = from_fn::<_, 10, _>(|n| {
        // x[i] x[j] x[k] x[l] with i <= j <= k <= l.
        let later = &pairs[PAIRS.partition_point(|&(k, _)| k < PAIRS[n].1)..];
        let factors = factors.split_off(..later.len()).expect("35 products of four");
        pairs[n] * TaylorModel::sum(factors.iter().copied().zip(later))
    });
    TaylorModel::sum(terms.iter().map(|term| (1.0, term)))
}

/// Those of the torques for which the statement, with `at_target` and `unit`, is not certain in a
/// box.
fn open([at_target, unit]: [f64; 2], y: Space, torques: &[f64]) -> Vec<f64> {
    let [energy, height, before] = energy_height_progress(y);
    if energy.low() > MOST + SLACK
        || height.low() > 1.0 + SLACK
        || before.low() > at_target - unit + SLACK
    {
        return Vec::new();
    }
    let is_open = |&torque: &f64| {
        let [energy, height, after] = energy_height_progress(step(y, torque));
        let is_certain = energy.high() < MOST - SLACK
            && height.high() < 1.0 - SLACK
            && (after - before).high() < unit - SLACK;
        !is_certain
    };
    torques.iter().copied().filter(is_open).collect()
}

/// Proves the statement in a box, given its centre and its radius in each dimension. Halves the box
/// where the statement is not certain, at most `halvings` times. Returns the number of boxes.
fn prove_in(
    bound: [f64; 2],
    centre: [f64; 4],
    mut radius: [f64; 4],
    torques: &[f64],
    halvings: u32,
) -> anyhow::Result<u64> {
    let open = open(bound, TaylorModel::coordinates(centre, radius), torques);
    if open.is_empty() {
        return Ok(1);
    }
    if halvings == 0 {
        bail!("not proved near {centre:?} with {open:?} N m");
    }
    // An angle of 1 rad changes P about as much as 3 rad/s.
    let size = |&d: &usize| radius[d] * [3.0, 3.0, 1.0, 1.0][d];
    let widest = (0..4).max_by(|a, b| size(a).total_cmp(&size(b)));
    let widest = widest.expect("four dimensions");
    radius[widest] /= 2.0;
    [-1.0, 1.0].into_iter().try_fold(0, |boxes, sign| {
        let mut centre = centre;
        centre[widest] += sign * radius[widest];
        Ok(boxes + prove_in(bound, centre, radius, &open, halvings - 1)?)
    })
}

pub fn prove() -> anyhow::Result<()> {
    /// Parts in each dimension.
    const PARTS: u32 = 16;
    /// More than a true statement with these margins needs.
    const HALVINGS: u32 = 40;
    let radius = STATES.map(|[low, high]| (high - low) / f64::from(2 * PARTS));
    let parts = (0..PARTS.pow(4)).into_par_iter().progress();
    let boxes = parts.map(|part| {
        let centre = from_fn(|d| {
            let i = part / PARTS.pow(d as u32) % PARTS;
            STATES[d][0] + f64::from(2 * i + 1) * radius[d]
        });
        prove_in([AT_TARGET, UNIT], centre, radius, &TORQUES, HALVINGS)
    });
    println!(
        "proved in {} million boxes: from hanging at rest the goal is at least {} steps away",
        boxes.try_reduce(|| 0, |a, b| Ok(a + b))? / 1_000_000,
        least_steps(State::HANGING).expect("a state outside of the target")
    );
    Ok(())
}

/// The bound: from this state no policy reaches the goal in fewer steps. `None` in the target,
/// where the proof gives no bound.
pub fn least_steps(state: State) -> Option<u32> {
    let [theta1, theta2, dtheta1, dtheta2] = state.into();
    let y = [theta1, theta1 + theta2, dtheta1, dtheta1 + dtheta2].map(TaylorModel::from);
    let [energy, height, progress] = energy_height_progress(y);
    let is_outside = energy.high() < MOST && height.high() < 1.0 - SLACK;
    let steps = (AT_TARGET - SLACK - progress.high()) / UNIT;
    is_outside.then_some(steps.ceil() as u32)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use acrobot::Action;
    use acrobot::arithmetic::Reference;
    use acrobot::numpy::{Pcg64, uniform};
    use acrobot::physics::Pendulum;

    use super::*;

    /// Draws a box of any size, a position in it, and the coordinates of this position.
    fn draw(rng: &mut Pcg64) -> (Space, [f64; 4], [f64; 4]) {
        let size = uniform(rng, 0.0, 1.0);
        // The fourth power makes most boxes small.
        let size = size * size * size * size;
        let centre = STATES.map(|[low, high]| uniform(rng, low, high));
        let radius = [size; 4].map(|size| uniform(rng, 0.0, size));
        // The edges are the extreme positions.
        let position = [(); 4].map(|()| uniform(rng, -1.5, 1.5).clamp(-1.0, 1.0));
        let y = from_fn(|d| centre[d] + radius[d] * position[d]);
        (TaylorModel::coordinates(centre, radius), position, y)
    }

    /// The crate's own step, energy and height are independent of this file's.
    #[test]
    fn models_contain_the_steps_energies_and_heights_of_reference() {
        let mut rng = Pcg64::new(1);
        for _ in 0..20_000 {
            let (region, position, [alpha, beta, v, w]) = draw(&mut rng);
            let state = State::from([alpha, beta - alpha, v, w - v]);
            let mut pendulum = Pendulum::<Reference>::new(Params::DEFAULT, state).unwrap();
            let hanging = Pendulum::<Reference>::new(Params::DEFAULT, State::HANGING).unwrap();
            let [energy, height, _] = energy_height_progress(region);
            energy.assert_contains(position, pendulum.energy() - hanging.energy(), 0.0);
            height.assert_contains(position, pendulum.tip_height(), 0.0);

            let torque = pendulum.params().torque(Action::sample(&mut rng));
            pendulum.step(torque).unwrap();
            let [theta1, theta2, dtheta1, dtheta2] = pendulum.state().into();
            let reached = [theta1, theta1 + theta2, dtheta1, dtheta1 + dtheta2];
            for (i, model) in step(region, torque).into_iter().enumerate() {
                let [low, high] = model.range_at(position);
                // The acrobot wraps its angles.
                let turns = match i {
                    0 | 1 => (((low + high) / 2.0 - reached[i]) / TAU).round(),
                    _ => 0.0,
                };
                model.assert_contains(position, reached[i] + turns * TAU, 0.0);
            }
        }
    }

    /// The mirror image has the same progress, so the proof needs only one of both.
    #[test]
    fn models_contain_the_progress_of_each_state() {
        let mut rng = Pcg64::new(2);
        for _ in 0..20_000 {
            let (region, position, y) = draw(&mut rng);
            let [_, _, model] = energy_height_progress(region);
            for y in [y, y.map(|x| -x)] {
                let [_, _, point] = energy_height_progress(y.map(TaylorModel::from));
                assert!(point.high() - point.low() < 1e-6, "{point:?}");
                model.assert_contains(position, (point.low() + point.high()) / 2.0, 0.0);
            }
        }
    }

    #[test]
    fn states_outside_of_the_boxes_have_more_energy() {
        let mut rng = Pcg64::new(4);
        for _ in 0..20_000 {
            let y = STATES.map(|[_, high]| high * uniform(&mut rng, -1.2, 1.2));
            let [energy, ..] = energy_height_progress(y.map(TaylorModel::from));
            let is_inside = y[2].abs() < STATES[2][1] && y[3].abs() < STATES[3][1];
            assert!(is_inside || energy.low() > MOST, "{y:?}");
        }
        assert!(STATES[0][1] > PI && STATES[1][1] > PI);
    }

    #[test]
    fn states_outside_of_the_target_have_a_bound() {
        assert_eq!(least_steps(State::HANGING), Some(52));
        let (goal, fast) = ([1.6, 1.54, 0.0, 0.0], [0.0, 0.0, 0.0, 7.5]);
        assert_eq!([goal, fast].map(|y| least_steps(y.into())), [None; 2]);
    }

    /// Near the states that are nearest to a contradiction, of ten million and of climbs from them.
    #[test]
    fn bounds_that_are_too_tight_are_not_proved() {
        let proves = |at_target, unit| {
            let near = |y| prove_in([at_target, unit], y, [1.0 / 64.0; 4], &TORQUES, 30).is_ok();
            // Steps from the last one reach the target by their height alone.
            [
                [-0.31028, 1.05353, 0.80987, 6.04149],
                [-0.15488, 0.80654, -0.93411, 6.67199],
                [-1.40517, 3.00841, -1.44586, 0.76542],
            ]
            .map(near)
        };
        assert_eq!(proves(AT_TARGET, UNIT), [true, true, true]);
        assert_eq!(proves(AT_TARGET, UNIT - 0.015), [false, true, true]);
        assert_eq!(proves(AT_TARGET + 1.0, UNIT), [true, false, false]);
    }
}
