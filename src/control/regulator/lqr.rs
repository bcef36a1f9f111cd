//! The linear-quadratic regulator in continuous time.

use super::dlqr::{Lqr, problem, rounded};
use super::riccati::Problem;
use crate::control::model::LinearModel;
use crate::error::Error;
use crate::math::Real;
use crate::math::matrix::{apply, congruence, diagonal, inner, product, scale, spread};

/// The [linear-quadratic regulator](Lqr) of a model in continuous time: of all torques, those with
/// the least integral of xᵀ Q x + R u².
///
/// As [`dlqr`](super::dlqr::dlqr) in all else, after a Cayley transform whose unit of time follows
/// from the model (E. K.-W. Chu, H.-Y. Fan and W.-W. Lin, *A Structure-Preserving Doubling
/// Algorithm for Continuous-Time Algebraic Riccati Equations*, 2005).
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

    let ([gain], cost) = problem.solve()?;
    let mut cost_to_go = congruence(&cost, &to);
    scale(&mut cost_to_go, time);
    rounded(&apply(&to, &gain), &cost_to_go, |gain| problem.is_stable(&[apply(&from, gain)]))
}

/// A quarter to an eighth of the time in which the fastest motion grows or vanishes by a factor of
/// e, or swings by a radian, with and without the regulator. A power of 2.
///
/// The largest |λ| of A is at most 1.03 times the largest |tr Aᵏ|^(1/k) for k from 1 to 4, and at
/// least a quarter of it. The regulator's are near (vᵀ Q v / R)^(1/2k) for v = Aᵏ⁻¹ B, if this is
/// larger. No unit of the state changes these numbers.
fn time_unit(problem: &Problem<false>) -> f64 {
    let [(b, r)] = problem.inputs;
    let root = Real::sqrt(r);
    let (mut power, mut v) = (problem.a, b.map(|x| x / root));
    let mut rate = -1022;
    for k in 1..=4 {
        let trace: f64 = diagonal(&power).into_iter().sum();
        let weight = inner(&v, &apply(&problem.q, &v));
        rate = rate.max(exponent(trace).div_euclid(k)).max(exponent(weight).div_euclid(2 * k));
        (power, v) = (product(&power, &problem.a), apply(&problem.a, &v));
    }
    f64::from_bits(((1021 - rate).max(1) as u64) << 52)
}

/// The exponent of the largest power of 2 up to |x|.
fn exponent(x: f64) -> i32 {
    (x.abs().to_bits() >> 52) as i32 - 1023
}
