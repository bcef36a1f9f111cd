//! The linear-quadratic regulator of a discrete model.

use super::matrix::{
    Matrix, add, add_outer, add_scaled, apply, check_finite, congruence, dot, eliminate, identity,
    inner, largest, product, scale, symmetrize, transpose,
};
use super::{ControlError, DiscreteModel};
use crate::error::Range;
use crate::math::Real;
use crate::physics::{Arithmetic, Pendulum, State, wrap};

/// A linear-quadratic regulator: of all state feedbacks that make every deviation vanish, the one with the least sum of
/// xᵀ Q x + R u² over all steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Lqr<S = f64> {
    /// K in u = −K x, N m per rad and per rad/s.
    pub gain: [S; 4],
    /// P, the solution of the discrete algebraic Riccati equation: xᵀ P x is the cost of all steps from x on. It is
    /// symmetric.
    pub cost_to_go: [[S; 4]; 4],
}

impl<S: Real> Lqr<S> {
    /// The torque −K x, N m, for a deviation x from the state of the linearization, rad and rad/s: see
    /// [`Pendulum::deviation`]. Add the torque of the linearization if it is not 0. [`bound`](crate::physics::bound) limits
    /// it to that of a motor.
    #[must_use]
    pub fn torque(&self, x: [S; 4]) -> S {
        -dot(self.gain, x)
    }
}

/// The deviation of `state` from `target`, rad and rad/s. The differences of the angles are wrapped to \[−π, π\], so
/// that it is continuous upright, where θ1 jumps from π to −π. Velocities near the limit of the scalar can overflow.
///
/// ```
/// use acrobot::physics::control::difference;
/// use acrobot::{Portable, State};
///
/// let beyond = State { theta1: -3.0, ..State::UPRIGHT };
/// let x = difference::<Portable>(beyond, State::UPRIGHT);
/// assert!((x[0] - 0.14159).abs() < 1e-5);
/// ```
#[must_use]
pub fn difference<A: Arithmetic>(
    state: State<A::Scalar>,
    target: State<A::Scalar>,
) -> [A::Scalar; 4] {
    // Wrapped first, so that no difference overflows.
    let between = |x, y| wrap::<A>(wrap::<A>(x) - wrap::<A>(y));
    [
        between(state.theta1, target.theta1),
        between(state.theta2, target.theta2),
        state.dtheta1 - target.dtheta1,
        state.dtheta2 - target.dtheta2,
    ]
}

impl<A: Arithmetic> Pendulum<A> {
    /// The [`difference`] of the state from `target`, rad and rad/s.
    #[must_use]
    pub fn deviation(&self, target: State<A::Scalar>) -> [A::Scalar; 4] {
        difference::<A>(self.state(), target)
    }
}

/// The [linear-quadratic regulator](Lqr) of a discrete model.
///
/// `q` weights the deviation of the state: it is symmetric and positive semidefinite, by rows, in 1/rad², s/rad² and
/// s²/rad². `r` weights the torque, in 1/(N m)²; above 0. Only their ratio matters for the gain.
///
/// Both scalars are computed in `f64`. The residual of the Riccati equation says how large the error of the gain is; above
/// 1e-9 of the largest element it is an error. The acrobot has a gain, upright and hanging, for each `dt` from 0.002 to
/// 0.05 s and each ratio of `q` to `r` from 1e-8 to 1e8.
///
/// The structured doubling algorithm (E. K.-W. Chu, H.-Y. Fan, W.-W. Lin and C.-S. Wang, *Structure-Preserving
/// Algorithms for Periodic Discrete-Time Algebraic Riccati Equations*, 2004) finds a gain, and Newton's method (G. A.
/// Hewer, *An Iterative Technique for the Computation of the Steady State Gains for the Discrete Optimal Regulator*,
/// 1971) makes it exact up to rounding.
///
/// ```
/// use acrobot::physics::control::{DiscreteModel, lqr};
///
/// // A force moves a mass of 1 kg in steps of 0.1 s: position and velocity are the first and the third number. The
/// // others decay.
/// let a: [[f64; 4]; 4] = [[1.0, 0.0, 0.1, 0.0], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.5]];
/// let model = DiscreteModel { a, b: [0.005, 0.0, 0.1, 0.0] };
/// let q = [[1.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4], [0.0; 4]];
/// let regulator = lqr(&model, &q, 1.0)?;
/// assert!((regulator.gain[0] - 0.9317).abs() < 1e-4 && regulator.gain[1] == 0.0);
/// # Ok::<(), acrobot::physics::control::ControlError>(())
/// ```
///
/// # Errors
///
/// - [`ControlError::Invalid`] for an `r` that is not above 0.
/// - [`ControlError::NotFinite`] for an element of the model or of `q` that is not finite, or an element of the result
///   that the scalar cannot hold.
/// - [`ControlError::NotSymmetric`] and [`ControlError::NotSemidefinite`] for such a `q`. Elements smaller than 16
///   machine epsilons of the largest one count as 0.
/// - [`ControlError::NotStabilizable`] if the torque does not reach a motion that grows or persists, as far as `f64`
///   shows.
/// - [`ControlError::NotDetectable`] if `q` does not weight a motion that persists: it would need more than 2⁴⁰ steps to
///   vanish.
/// - [`ControlError::IllConditioned`] if the estimated error of the gain is above 1e-9 of its largest element.
pub fn lqr<S: Real>(
    model: &DiscreteModel<S>,
    q: &[[S; 4]; 4],
    r: S,
) -> Result<Lqr<S>, ControlError> {
    check_finite("a", model.a.as_flattened())?;
    check_finite("b", &model.b)?;
    check_finite("q", q.as_flattened())?;
    let wide = |m: &Matrix<S>| m.map(|row| row.map(S::to_f64));
    let (a, b, q, r) = (wide(&model.a), model.b.map(S::to_f64), wide(q), r.to_f64());
    check_symmetric(&q)?;
    check_semidefinite(&q, 16.0 * S::EPSILON.to_f64())?;
    Range::AboveZero.check("r", r, "per (N m)²")?;

    let (gain, cost_to_go) = regulator(&a, &b, &q, r)?;
    let regulator = Lqr {
        gain: gain.map(S::from_f64),
        cost_to_go: cost_to_go.map(|row| row.map(S::from_f64)),
    };
    check_finite("gain", &regulator.gain)?;
    check_finite("cost_to_go", regulator.cost_to_go.as_flattened())?;
    Ok(regulator)
}

/// How often the number of steps is doubled before deviations that have not vanished count as persistent.
const DOUBLINGS: u32 = 40;
/// Newton's method converges quadratically, but first it may halve a gain that is too large by many decades.
const NEWTON_ITERATIONS: u32 = 60;
/// The largest estimated error of a gain, relative to its largest element. An estimate can be too small, so this is a
/// tenth of the error that the tests allow.
const TOLERANCE: f64 = 1e-9;

/// A model and its weights, in coordinates y in which the torque changes one number only: where R is small, P b would
/// otherwise be a difference of large numbers.
struct Problem {
    a: Matrix,
    b: [f64; 4],
    q: Matrix,
    r: f64,
    /// y = t x for the state x.
    t: Matrix,
}

/// K and P.
type Solution = ([f64; 4], Matrix);

fn regulator(a: &Matrix, b: &[f64; 4], q: &Matrix, r: f64) -> Result<Solution, ControlError> {
    let cost_unit = r.max(largest(q.as_flattened())); // so that no cost overflows
    let problem = Problem::new(a, b, q, r, 1.0 / cost_unit);
    let (gain, mut cost) = problem.solve()?;
    cost = congruence(&cost, &problem.t);
    scale(&mut cost, cost_unit);
    Ok((apply(&transpose(&problem.t), &gain), cost))
}

/// The number of the state that the torque changes most, as a unit vector, and its element of `b`. The rows and columns
/// of `a` say how the units of the numbers compare.
fn pivot(a: &Matrix, b: &[f64; 4]) -> ([f64; 4], f64) {
    let size = |row: &[f64; 4]| row.iter().fold(f64::MIN_POSITIVE, |sum, x| sum + x.abs());
    let mut chosen = ([0.0; 4], 1.0);
    let mut most = 0.0;
    for (((unit, &b_i), row), column) in identity().into_iter().zip(b).zip(a).zip(&transpose(a)) {
        let share = b_i / largest(b);
        let effect = share * share * (size(column) / size(row));
        if effect > most {
            (chosen, most) = ((unit, b_i), effect);
        }
    }
    chosen
}

impl Problem {
    #[inline(never)]
    fn new(a: &Matrix, b: &[f64; 4], q: &Matrix, r: f64, weight: f64) -> Self {
        let (unit, pivot) = pivot(a, b);
        // x = basis y, where the column of the pivot is b / pivot.
        let mut column = *b;
        add_scaled(&mut column, -pivot, &unit);
        let mut basis = identity();
        add_outer(&mut basis, 1.0 / pivot, &column, &unit);
        let mut problem = Self {
            a: product(a, &basis),
            b: unit.map(|x| x * pivot),
            q: congruence(q, &basis),
            r: r * weight,
            t: identity(),
        };
        add_outer(&mut problem.t, -1.0 / pivot, &column, &unit);
        problem.a = product(&problem.t, &problem.a);
        scale(&mut problem.q, weight);
        problem
    }

    fn solve(&self) -> Result<Solution, ControlError> {
        let solution = self.solve_from(&self.q, self.r);
        if solution.is_ok() {
            return solution;
        }
        // Where these weights give no gain that stabilizes, because Q does not weight a motion that grows or R is extreme,
        // others do.
        let weight = match largest(self.q.as_flattened()) {
            0.0 => 1.0,
            weight => weight,
        };
        let mut q = identity();
        scale(&mut q, weight);
        self.solve_from(&q, self.r.max(weight * inner(&self.b, &self.b)))
    }

    /// The solution, beginning with the gain for other weights.
    fn solve_from(&self, q: &Matrix, r: f64) -> Result<Solution, ControlError> {
        let gain = self.double(q, r).ok_or(ControlError::NotStabilizable)?;
        self.refine(gain)
    }

    /// K for the weights `q` and `r`, by the doubling algorithm. Rounding can make it wrong.
    ///
    /// With A, G = B Bᵀ / R and P = Q for one step, the iteration computes the same for twice as many steps:
    /// P + Aᵀ P W⁻¹ A, G + A W⁻¹ G Aᵀ and A W⁻¹ A, where W = 1 + G P. A vanishes as the closed loop does.
    #[inline(never)]
    fn double(&self, q: &Matrix, r: f64) -> Option<[f64; 4]> {
        let (mut a, mut p, mut g) = (self.a, *q, [[0.0; 4]; 4]);
        add_outer(&mut g, 1.0 / r, &self.b, &self.b);
        for _ in 0..DOUBLINGS {
            let mut w = identity();
            add(&mut w, 1.0, &product(&g, &p));
            let mut rows = [
                [w[0], a[0], g[0]],
                [w[1], a[1], g[1]],
                [w[2], a[2], g[2]],
                [w[3], a[3], g[3]],
            ];
            eliminate(&mut rows)?;
            let mut change = product(&a, &product(&rows.map(|[.., w_g]| w_g), &transpose(&a)));
            symmetrize(&mut change);
            add(&mut g, 1.0, &change);
            let w_a = rows.map(|[_, w_a, _]| w_a);
            change = product(&transpose(&a), &product(&p, &w_a));
            symmetrize(&mut change);
            add(&mut p, 1.0, &change);
            a = product(&a, &w_a);
            if has_vanished(&a) {
                return Some(self.gain(&p, r).0);
            }
        }
        None
    }

    /// The best gain for the next step, if P is the cost after it, and how much it weights the torque.
    fn gain(&self, p: &Matrix, r: f64) -> ([f64; 4], f64) {
        let p_b = apply(p, &self.b);
        let weight = r + inner(&self.b, &p_b);
        (apply(&transpose(&self.a), &p_b).map(|x| x / weight), weight)
    }

    /// The solution near a gain that stabilizes, by Newton's method. It alternates between the cost of a gain and the
    /// gain that is best for this cost.
    #[inline(never)]
    fn refine(&self, mut gain: [f64; 4]) -> Result<Solution, ControlError> {
        let (mut change, mut noise) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..NEWTON_ITERATIONS {
            let (mut closed, mut stage) = (self.a, self.q);
            add_outer(&mut closed, -1.0, &self.b, &gain);
            add_outer(&mut stage, self.r, &gain, &gain);
            let Some(cost) = lyapunov(&closed, &stage) else {
                if noise < change {
                    // The gain approaches one that lets a motion persist.
                    return Err(ControlError::NotDetectable);
                }
                break;
            };
            // What the residual of the equation adds to the cost, and thereby to the gain.
            add(&mut stage, 1.0, &congruence(&cost, &closed));
            add(&mut stage, -1.0, &cost);
            let Some(missing) = lyapunov(&closed, &stage) else {
                break;
            };
            let (better, weight) = self.gain(&cost, self.r);
            let missing = apply(&transpose(&closed), &apply(&missing, &self.b));
            noise = largest(&missing) / weight;
            add_scaled(&mut gain, -1.0, &better);
            change = largest(&gain);
            gain = better;
            if change.max(noise) <= TOLERANCE * largest(&gain) {
                return Ok((gain, cost));
            }
        }
        Err(ControlError::IllConditioned {
            error: change.max(noise) / largest(&gain),
        })
    }
}

/// The solution P of P = mᵀ P m + stage, the discrete Lyapunov equation, by doubling. None if the powers of m do not
/// vanish.
#[inline(never)]
fn lyapunov(m: &Matrix, stage: &Matrix) -> Option<Matrix> {
    let (mut m, mut p) = (*m, *stage);
    for _ in 0..=DOUBLINGS {
        let change = congruence(&p, &m);
        add(&mut p, 1.0, &change);
        if has_vanished(&m) {
            return p.as_flattened().iter().all(|x| x.is_finite()).then_some(p);
        }
        m = product(&m, &m);
    }
    None
}

fn has_vanished(m: &Matrix) -> bool {
    m.iter().fold(0.0, |sum, row| sum + inner(row, row)) < 1e-24
}

fn check_symmetric(q: &Matrix) -> Result<(), ControlError> {
    let transposed = transpose(q);
    let mut pairs = q.as_flattened().iter().zip(transposed.as_flattened());
    match pairs.find(|(upper, lower)| upper != lower) {
        Some((upper, lower)) => Err(ControlError::NotSymmetric {
            name: "q",
            upper: *upper,
            lower: *lower,
        }),
        None => Ok(()),
    }
}

/// Subtracts (column columnᵀ) / pivot for the largest pivot on the diagonal, until none is above the rounding. What
/// remains of a positive semidefinite matrix is rounding.
fn check_semidefinite(q: &Matrix, relative_rounding: f64) -> Result<(), ControlError> {
    let mut rest = *q;
    let rounding = relative_rounding * largest(q.as_flattened());
    for _ in 0..4 {
        let mut greatest = (rounding, [0.0; 4]);
        for (i, row) in rest.iter().enumerate() {
            if let Some(&pivot) = row.get(i)
                && pivot > greatest.0
            {
                greatest = (pivot, *row);
            }
        }
        let (pivot, row) = greatest;
        for (x, factor) in rest.iter_mut().zip(row) {
            add_scaled(x, -(factor / pivot), &row);
        }
    }
    let most = largest(rest.as_flattened());
    if most > rounding {
        return Err(ControlError::NotSemidefinite {
            name: "q",
            value: most,
        });
    }
    Ok(())
}
