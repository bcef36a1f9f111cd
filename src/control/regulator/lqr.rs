//! The linear-quadratic regulator in continuous time.

use super::dlqr::{Lqr, problem, rounded};
use super::double::narrow;
use super::riccati::Problem;
use crate::control::model::LinearModel;
use crate::error::Error;
use crate::math::Real;
use crate::math::matrix::{apply, congruence, diagonal, inner, product, scale, spread};

/// The [linear-quadratic regulator](Lqr) of a model in continuous time: of all torques, those with
/// the least integral of xᵀ Q x + R u².
///
/// All else is as in [`dlqr`](super::dlqr::dlqr), after a Cayley transform, whose unit of time
/// follows from the model (E. K.-W. Chu, H.-Y. Fan and W.-W. Lin, *A Structure-Preserving Doubling
/// Algorithm for Continuous-Time Algebraic Riccati Equations*, 2005).
///
/// ```
/// use acrobot::control::regulator::lqr;
/// use acrobot::physics::Pendulum;
/// use acrobot::{Params, Portable, State};
///
/// let upright = Pendulum::<Portable>::new(Params::DEFAULT, State::UPRIGHT)?;
/// let q = [[1.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4], [0.0; 4]]; // θ1 alone
/// let lqr = lqr(&upright.linearize(0.0)?, &q, 1.0)?;
/// assert!(lqr.torque([0.01, 0.0, 0.0, 0.0]) > 0.0); // against a lean
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// A model of steps does not compile:
///
/// ```compile_fail,E0308
/// # use acrobot::control::regulator::lqr;
/// # use acrobot::physics::Pendulum;
/// # use acrobot::{Params, Portable, State};
/// # let upright = Pendulum::<Portable>::new(Params::DEFAULT, State::UPRIGHT)?;
/// # let q = [[1.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4], [0.0; 4]];
/// let lqr = lqr(&upright.linearize_step(0.0)?, &q, 1.0)?;
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// # Errors
///
/// Those of `dlqr`.
pub fn lqr<S: Real>(model: &LinearModel<S>, q: &[[S; 4]; 4], r: S) -> Result<Lqr<S>, Error> {
    let mut problem: Problem<false> = problem(&model.a, &model.b, q, r)?;
    let time = time_unit(&problem);
    let [to, from] = [time, 1.0 / time].map(|time| spread([1.0, 1.0, time, time]));
    problem.a = product(&to, &product(&problem.a, &from));
    scale(&mut problem.a, time);
    problem.inputs = problem.inputs.map(|(b, r)| (apply(&to, &b).map(|x| x * time), r));
    problem.q = congruence(&problem.q, &from);

    let ([gain], cost, unit) = problem.solve()?;
    let mut cost_to_go = congruence(&narrow(&cost), &to);
    scale(&mut cost_to_go, unit * time);
    rounded(&apply(&to, &gain), &cost_to_go, |gain| problem.is_stable(&[apply(&from, gain)]))
}

/// The unit of time of the Cayley transform: a power of 2 for which rates are near 1.
///
/// The model's fastest rate is near the largest |tr Aᵏ|^(1/k) for k from 1 to 4: the largest |λ| of
/// A is at least a quarter of it and at most 1.03 times it. The regulator's is near the largest
/// (vᵀ Q v / R)^(1/2k) with v = Aᵏ⁻¹ B. No unit of the state changes these. If the regulator is
/// faster, the rate is between both. The unit is a quarter, because no motion may grow at a rate
/// of 1.
fn time_unit(problem: &Problem<false>) -> f64 {
    let [(b, r)] = problem.inputs;
    let root = Real::sqrt(r);
    let (mut power, mut v) = (problem.a, b.map(|x| x / root));
    // 24 times logarithms to base 2.
    let [mut own, mut fastest] = [i32::MIN; 2];
    for by in [12, 6, 4, 3] {
        let trace = diagonal(&power).into_iter().sum();
        let weight = inner(&v, &apply(&problem.q, &v));
        own = own.max(exponent(trace) * by * 2);
        fastest = fastest.max(exponent(weight) * by);
        (power, v) = (product(&power, &problem.a), apply(&problem.a, &v));
    }
    // The model of a double integrator has no rate but 0.
    let between = (own.max(fastest - 480) + fastest).div_euclid(2);
    let rate = own.max(between).div_euclid(24);
    f64::from_bits(((1021 - rate).max(1) as u64) << 52)
}

/// The exponent of the largest power of 2 up to |x|.
fn exponent(x: f64) -> i32 {
    (x.abs().to_bits() >> 52) as i32 - 1023
}
