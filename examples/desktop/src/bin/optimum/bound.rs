//! A lower bound: no policy reaches the goal in fewer steps than a function of the initial state says.
//!
//! The function W estimates the progress towards the goal, in steps. Two statements about all states are proved by
//! affine arithmetic, in boxes that are halved until the statement is certain:
//!
//! 1. From a state whose energy is below `GOAL`, no step increases W by more than `UNIT` or ends above `MOST`.
//! 2. States with an energy from `GOAL` to `MOST` have at least the progress `LEAST`.
//!
//! So from a state s below `GOAL` the goal is at least (`LEAST` − W(s)) / `UNIT` steps away. This holds for Gymnasium's
//! parameters, the book's dynamics and `f64`.

use std::array::from_fn;
use std::time::Instant;

use acrobot::State;
use anyhow::bail;
use indicatif::ProgressBar;
use rayon::prelude::*;

use crate::affine::Affine;

/// (m1 lc1 + m2 l1) g and m2 lc2 g, N m, of docs/equations.md with Gymnasium's parameters, as are the numbers in `energy`
/// and `derivative`.
const GRAVITY: [f64; 2] = [14.7, 4.9];
/// More than rounding can change in a step of `f64`.
const SLACK: f64 = 1e-6;
/// The threshold of the energy, J above hanging at rest. Every goal state has more than 24.5 J; docs/optimum.md says why.
const GOAL: f64 = 24.5 - SLACK;
/// No step from below `GOAL` leads above this energy, J.
const MOST: f64 = 27.5;

/// θ1, θ1 + θ2 and their velocities, rad and rad/s, of all states up to the energy `MOST`, except mirror images and whole
/// turns. Outside there is more: a potential energy of 14.7 (1 − cos 2.75) = 28.2 J, or a kinetic energy of at least
/// (1.125 − 0.1) 5.25² = 28.2 J or (0.625 − 0.0556) 7² = 27.9 J. Within, no velocity reaches its bound. These numbers are
/// multiples of 1/4, so halving them is exact.
const STATES: [[f64; 2]; 4] = [[-2.75, 2.75], [-3.25, 3.25], [0.0, 5.25], [-7.0, 7.0]];

/// The coefficients of W, from certificate.py.
const RADIAL: [f64; 5] = [3.8966, 1.9878, -0.30848, 0.014542, -2.2048];
const PRODUCTS: [[f64; 3]; 5] = [
    [-1.1093, 4.625, 0.036812],
    [2.6725, -6.9567, -0.30744],
    [1.8384, -6.5274, -0.15029],
    [0.16131, 7.0408, -0.19725],
    [0.47063, 1.2797, -0.13048],
];
/// The largest increase of W by a step, with a margin: a proof of less takes more boxes.
const UNIT: f64 = 1.02;
/// The least W with the energy of goal states, with a margin.
const LEAST: f64 = 38.3;

/// θ1, θ1 + θ2 and their velocities.
type Space = [Affine; 4];

/// The energy above hanging at rest, J.
fn energy([alpha, beta, v, w]: Space) -> Affine {
    let [[_, cos1], [_, cos_sum], [_, cos2]] = [alpha, beta, beta - alpha].map(Affine::sin_cos);
    let kinetic = 1.125 * v.square() + 0.625 * w.square() + 0.5 * (cos2 * v * w);
    let one = Affine::from(1.0);
    kinetic + GRAVITY[0] * (one - cos1) + GRAVITY[1] * (one - cos_sum)
}

fn derivative([alpha, beta, v, w]: Space, torque: f64) -> Space {
    const LEAST: f64 = 2.5625;
    let [[sin1, _], [sin_sum, _], [sin2, cos2]] = [alpha, beta, beta - alpha].map(Affine::sin_cos);
    let torque = Affine::from(torque);
    let force1 = 0.5 * (sin2 * w.square()) - GRAVITY[0] * sin1 - torque;
    let force2 = torque - GRAVITY[1] * sin_sum - 0.5 * (sin2 * v.square());
    let inverse = (Affine::from(LEAST) + 0.25 * sin2.square()).inverse(LEAST);
    let coupling = 0.5 * cos2;
    let dv = (1.25 * force1 - coupling * force2) * inverse;
    let dw = (2.25 * force2 - coupling * force1) * inverse;
    [v, w, dv, dw]
}

/// The Runge-Kutta step of 0.2 s.
fn step(y: Space, torque: f64) -> Space {
    let along = |h: f64, k: Space| from_fn(|i| y[i] + h * k[i]);
    let k1 = derivative(y, torque);
    let k2 = derivative(along(0.1, k1), torque);
    let k3 = derivative(along(0.1, k2), torque);
    let k4 = derivative(along(0.2, k3), torque);
    along(
        0.2 / 6.0,
        from_fn(|i| k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]),
    )
}

/// The energy and W. W is a function of the energy, corrected by the phase of the swing, because the motor gains most
/// energy where link 2 is fast.
fn energy_and_progress(y: Space) -> [Affine; 2] {
    const AT_REST: f64 = 0.3;
    let [alpha, beta, v, w] = y;
    let [[sin1, _], [sin_sum, _], [sin2, _]] = [alpha, beta, beta - alpha].map(Affine::sin_cos);
    let energy = energy(y);
    let r = (energy + Affine::from(AT_REST)).sqrt(AT_REST);
    let inverse = r.inverse(AT_REST.sqrt().next_down());
    let [a, b, c, d, e] = RADIAL.map(Affine::from);
    let radial = (((d * r + c) * r + b) * r + a) * r + e * inverse;
    let products = [sin2 * (w - v), sin1 * v, sin_sum * w, sin1 * w, sin_sum * v];
    let products = products.into_iter().zip(PRODUCTS);
    let progress = products.fold(radial, |sum, (product, factors)| {
        let [p, q, s] = factors.map(Affine::from);
        sum + product * ((q * inverse + p) * inverse + s)
    });
    [energy, progress]
}

/// From a state below `GOAL`, no step with this torque increases W by more than `unit` or ends above `MOST`.
fn no_step_is_longer(unit: f64, y: Space, torque: f64) -> bool {
    let [energy, before] = energy_and_progress(y);
    energy.low() > GOAL || {
        let [energy, after] = energy_and_progress(step(y, torque));
        (after - before).high() < unit - SLACK && energy.high() < MOST - SLACK
    }
}

/// States from `GOAL` to `MOST` have at least the progress `least`.
fn no_goal_is_nearer(least: f64, y: Space) -> bool {
    let [energy, progress] = energy_and_progress(y);
    energy.high() < GOAL || energy.low() > MOST || progress.low() > least
}

/// Proves a statement in a box, given its centre and its radius in each dimension. Halves the box where the statement is
/// not certain, at most `halvings` times. Returns the number of boxes.
fn prove_in(
    centre: [f64; 4],
    mut radius: [f64; 4],
    halvings: u32,
    holds: &impl Fn(Space) -> bool,
) -> anyhow::Result<u64> {
    if holds(Affine::coordinates(centre, radius)) {
        return Ok(1);
    }
    if halvings == 0 {
        bail!("not proved near {centre:?}");
    }
    // An angle of 1 rad changes W about as much as 3 rad/s.
    let size = |&d: &usize| radius[d] * [3.0, 3.0, 1.0, 1.0][d];
    let widest = (0..4).max_by(|a, b| size(a).total_cmp(&size(b)));
    let widest = widest.expect("four dimensions");
    radius[widest] /= 2.0;
    [-1.0, 1.0].into_iter().try_fold(0, |boxes, sign| {
        let mut centre = centre;
        centre[widest] += sign * radius[widest];
        Ok(boxes + prove_in(centre, radius, halvings - 1, holds)?)
    })
}

/// Proves a statement for all states, on all cores.
fn prove_in_all(holds: &(impl Fn(Space) -> bool + Sync)) -> anyhow::Result<u64> {
    /// Parts in each dimension.
    const PARTS: u32 = 16;
    /// More than a true statement with these margins needs.
    const HALVINGS: u32 = 40;
    let radius = STATES.map(|[low, high]| (high - low) / f64::from(2 * PARTS));
    let progress = ProgressBar::new(PARTS.pow(4).into());
    let boxes = (0..PARTS.pow(4)).into_par_iter().map(|part| {
        let centre = from_fn(|d| {
            let i = part / PARTS.pow(d as u32) % PARTS;
            STATES[d][0] + f64::from(2 * i + 1) * radius[d]
        });
        let boxes = prove_in(centre, radius, HALVINGS, holds);
        progress.inc(1);
        boxes
    });
    let boxes = boxes.try_reduce(|| 0, |a, b| Ok(a + b));
    progress.finish_and_clear();
    boxes
}

/// Proves both statements.
pub fn prove() -> anyhow::Result<()> {
    let began = Instant::now();
    let mut boxes = prove_in_all(&|y| no_goal_is_nearer(LEAST, y))?;
    // The set is symmetric, so `STATES` needs no mirror images.
    for torque in [-1.0, 0.0, 1.0] {
        boxes += prove_in_all(&|y| no_step_is_longer(UNIT, y, torque))?;
    }
    println!(
        "proved in {} million boxes: from hanging at rest the goal is at least {} steps away",
        boxes / 1_000_000,
        least_steps(State::HANGING)
    );
    eprintln!("{:.0} s", began.elapsed().as_secs_f64());
    Ok(())
}

/// No policy reaches the goal in fewer steps. The energy must be below `GOAL`, as the argument needs.
pub fn least_steps(state: State) -> u32 {
    let State {
        theta1,
        theta2,
        dtheta1,
        dtheta2,
    } = state;
    let y = [theta1, theta1 + theta2, dtheta1, dtheta1 + dtheta2].map(Affine::from);
    let [energy, progress] = energy_and_progress(y);
    assert!(
        energy.high() < GOAL,
        "the state must have less energy than every goal state"
    );
    ((LEAST - SLACK - progress.high()) / UNIT).ceil() as u32
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use acrobot::arithmetic::Reference;
    use acrobot::numpy::{Pcg64, uniform};
    use acrobot::physics::Pendulum;
    use acrobot::{Action, Params};

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
        (Affine::coordinates(centre, radius), position, y)
    }

    #[track_caller]
    fn assert_contains(form: Affine, position: [f64; 4], number: f64) {
        let [low, high] = form.range_at(position);
        let is_inside = (low..=high).contains(&number);
        assert!(is_inside, "{number} is not from {low} to {high}");
    }

    /// The crate's own step and energy are independent of this file's.
    #[test]
    fn forms_contain_the_steps_and_energies_of_reference() {
        let mut rng = Pcg64::new(1);
        for _ in 0..20_000 {
            let (region, position, [alpha, beta, v, w]) = draw(&mut rng);
            let state = State::from([alpha, beta - alpha, v, w - v]);
            let mut pendulum = Pendulum::<Reference>::new(Params::DEFAULT, state).unwrap();
            let hanging = Pendulum::<Reference>::new(Params::DEFAULT, State::HANGING).unwrap();
            let above = pendulum.energy() - hanging.energy();
            assert_contains(energy(region), position, above);

            let torque = pendulum.params().torque(Action::sample(&mut rng));
            pendulum.step(torque).unwrap();
            let [theta1, theta2, dtheta1, dtheta2] = pendulum.state().into();
            let reached = [theta1, theta1 + theta2, dtheta1, dtheta1 + dtheta2];
            for (i, form) in step(region, torque).into_iter().enumerate() {
                let [low, high] = form.range_at(position);
                // The acrobot wraps its angles.
                let turns = match i {
                    0 | 1 => (((low + high) / 2.0 - reached[i]) / TAU).round(),
                    _ => 0.0,
                };
                assert_contains(form, position, reached[i] + turns * TAU);
            }
        }
    }

    #[test]
    fn forms_contain_the_progress_of_each_state() {
        let mut rng = Pcg64::new(2);
        for _ in 0..20_000 {
            let (region, position, y) = draw(&mut rng);
            let [_, form] = energy_and_progress(region);
            let [_, point] = energy_and_progress(y.map(Affine::from));
            assert_contains(form, position, (point.low() + point.high()) / 2.0);
        }
    }

    #[test]
    #[should_panic(expected = "less energy than every goal state")]
    fn states_with_the_energy_of_goal_states_have_no_bound() {
        least_steps(State::from([3.0, 0.0, 0.0, 0.0]));
    }

    /// Near the state whose step is the longest of a sample, and near the goal state of the least progress.
    #[test]
    fn bounds_that_are_too_tight_are_not_proved() {
        let near = |y, holds: &dyn Fn(Space) -> bool| {
            prove_in(y, [1.0 / 64.0; 4], 30, &|y| holds(y)).is_ok()
        };
        let longest = [-0.0855, -3.105, 0.6254, 5.0155];
        let proves = |unit| near(longest, &|y| no_step_is_longer(unit, y, 1.0));
        assert_eq!([1.0, 1.008, UNIT].map(proves), [false, false, true]);
        let nearest = [1.0494, -1.0311, 0.4618, -4.7274];
        let proves = |least| near(nearest, &|y| no_goal_is_nearer(least, y));
        assert_eq!([38.6, 38.45, LEAST].map(proves), [false, false, true]);
    }
}
