//! What a plan costs.

use crate::arithmetic::Arithmetic;
use crate::control::regulator::{BoundedRegulator, check_weights};
use crate::control::units::Units;
use crate::error::{Error, Range};
use crate::math::matrix::{add, add_outer, apply, dot, scale};
use crate::math::{Real, SinCos};
use crate::physics::{Constants, Modeled, Params, State, directions, plus_scaled, positions, wrap};

/// The weights of what a plan costs: the sum of all terms, over all its steps, and of its end. A
/// larger weight makes its term smaller, at the expense of the others: [a table of what each
/// does](crate::guide::control#what-a-plan-costs). The defaults are those of [`Cost::new`]: u is the
/// largest torque, and T² the inertia of the straight machine about the fixed joint, divided by the
/// sum of the torque of gravity when it is level and u.
///
/// ```
/// use acrobot::Params;
/// use acrobot::control::plan::{Cost, Problem};
///
/// let params = Params::<f64>::DEFAULT;
/// // Less energy, and no jumps of the torque.
/// let cost = Cost { power: 0.5, torque_change: 1.0, ..Cost::new(&params, 1.0)? };
/// assert_eq!(cost.height, 2.0); // m: the tip of the upright machine
/// let problem = Problem { cost, ..Problem::swing_up(params, 1.0)? }; // N m
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)] // for bindings/abi, whose derive.py copies the fields to other languages
pub struct Cost<S = f64> {
    /// Q of xᵀ Q x, for the deviation x from the target, by rows: 1/(rad² s), 1/rad² and s/rad²;
    /// symmetric and positive semidefinite. Default 0.
    ///
    /// Raised: the state is near the target for longer, and slower.
    pub q: [[S; 4]; 4],
    /// The same of the state after the plan: 1/rad², s/rad² and s²/rad². Default 0.
    ///
    /// Raised: the state after the plan is nearer the target.
    pub qf: [[S; 4]; 4],
    /// Of 2 − 2 cos x, for the deviation x of each angle from the target, 1/s: of x² where it is
    /// small. Default 0.
    ///
    /// Raised: the same as `q`.
    pub angles: [S; 2],
    /// R: of the square of the torque's difference from that which holds the target, 1/((N m)² s).
    /// Default 0.1 / (T u²).
    ///
    /// Raised: less torque, more time.
    pub torque: S,
    /// Of the square of the torque's change from one step to the next, 1/(N m)². Default 0.
    ///
    /// Raised: a smoother torque.
    pub torque_change: S,
    /// Of the absolute value of the motor's power, 1/J. Default 0.
    ///
    /// Raised: the motor does less work and brakes less.
    pub power: S,
    /// Of the time that the tip is below `height`, 1/s. Default 0.4 / T.
    ///
    /// Raised: the tip is above `height` − `margin` earlier.
    pub below: S,
    /// The height of the tip above the fixed joint, m, from which on `below` costs nothing. Default
    /// that of the target.
    pub height: S,
    /// `below` costs half where the tip is so far below `height`, m; above 0. Default a tenth of
    /// both lengths.
    pub margin: S,
    /// Of ln(1 + e) for the state after the plan, where e is 1 at the border of the region in which
    /// the regulator holds. Default 20.
    ///
    /// Raised: more plans end where the regulator holds.
    pub arrival: S,
}

/// The power within which its absolute value is smooth, in units of the largest torque and the
/// machine's time.
const SMOOTH: f64 = 0.02;
/// What a velocity beyond its bound costs, in units of the machine's time.
const BEYOND: f64 = 20.0;
/// The weights of the torque and of the time below, in the same units, and of the arrival.
const TORQUE: f64 = 0.1;
const BELOW: f64 = 0.4;
const ARRIVAL: f64 = 20.0;
/// The least damping, which is added to the curvature of the cost by a torque, and the least
/// curvature, in the same units.
const DAMPING: f64 = 1e-3;
const LEAST: f64 = 1e-10;

impl<S: Modeled> Cost<S> {
    /// Weights with which most tries of a swing-up succeed: the acrobot gets up early, with little
    /// torque. The height is that of the upright tip, the margin a tenth of it. The weights follow
    /// from the size of the machine and from its largest torque, N m, so without
    /// Coulomb friction machines of one shape have the same plans in other units.
    ///
    /// # Errors
    ///
    /// A parameter is out of range, or the torque is not finite and above 0.
    #[inline(never)] // saves flash
    pub fn new(params: &Params<S>, limit: S) -> Result<Self, Error> {
        Range::AboveZero.check("the largest torque", limit.to_f64(), "N m")?;
        params.validate()?;
        let Units { time, torque, .. } = Units::new(params, limit);
        let height = params.length1 + params.length2;
        Ok(Self {
            q: [[S::ZERO; 4]; 4],
            qf: [[S::ZERO; 4]; 4],
            angles: [S::ZERO; 2],
            torque: S::from_f64(TORQUE / (time * torque * torque)),
            torque_change: S::ZERO,
            power: S::ZERO,
            below: S::from_f64(BELOW / time),
            height,
            margin: height * S::from_f64(0.1),
            arrival: S::from_f64(ARRIVAL),
        })
    }
}

impl<S: Real> Cost<S> {
    /// Checks that all weights are finite and at least 0, and that the margin is above 0.
    pub(super) fn check(&self) -> Result<(), Error> {
        let [angle1, angle2] = self.angles;
        for &(name, weight, unit) in &[
            ("angles", angle1, "per s"),
            ("angles", angle2, "per s"),
            ("torque", self.torque, "per (N m)² s"),
            ("torque_change", self.torque_change, "per (N m)²"),
            ("power", self.power, "per J"),
            ("below", self.below, "per s"),
            ("arrival", self.arrival, "of ln(1 + e)"),
        ] {
            Range::AtLeastZero.check(name, weight.to_f64(), unit)?;
        }
        for (name, q) in [("q", &self.q), ("qf", &self.qf)] {
            check_weights(name, &mut q.map(|row| row.map(S::to_f64)), S::EPSILON.to_f64())?;
        }
        Range::Finite.check("height", self.height.to_f64(), "m")?;
        Range::AboveZero.check("margin", self.margin.to_f64(), "m")
    }
}

/// The weights for one step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights<S> {
    /// With twice Q and twice Qf: curvatures.
    pub(super) cost: Cost<S>,
    /// The target with the sines and cosines of its angles, and the torque that holds it, N m.
    target: State<S>,
    sin_cos: [SinCos<S>; 2],
    held: S,
    /// Whether `q` or `angles` is not 0. Most plans do without.
    pub(super) weights_state: bool,
    /// Velocities that no plan may reach, rad/s, and what exceeding them costs, s²/rad².
    pub(super) bounds: [S; 2],
    beyond: S,
    /// The power, W, within which its absolute value is smooth.
    smooth: S,
    /// The first damping: the weight of the torque. The least curvature by a torque. 1/(N m)².
    pub(super) damping: S,
    pub(super) least: S,
    /// The energy of the target, J, and what the square of its difference costs after a plan, 1/J².
    energy: S,
    pub(super) by_energy: S,
    /// Whether derivatives are those without dry friction of joint 2.
    pub(super) replans: bool,
}

impl<S: Real> Weights<S> {
    pub(super) fn new<A: Arithmetic<Scalar = S>>(
        regulator: &BoundedRegulator<A>,
        cost: &Cost<S>,
        units: Units,
    ) -> Self {
        let BoundedRegulator { machine, feedback, bounds, .. } = regulator;
        let dt = machine.params().dt;
        let mut cost = Cost {
            angles: cost.angles.map(|x| x * dt),
            torque: cost.torque * dt,
            power: cost.power * dt,
            below: cost.below * dt,
            ..*cost
        };
        scale(&mut cost.q, dt + dt);
        scale(&mut cost.qf, S::from_f64(2.0));
        let Units { time, torque, .. } = units;
        let curvature = dt.to_f64() / (time * torque * torque);
        let damping = S::from_f64(DAMPING * curvature);
        Self {
            cost,
            target: feedback.target,
            sin_cos: machine.sin_cos(),
            held: feedback.torque,
            weights_state: cost.q.as_flattened().iter().chain(&cost.angles).any(|x| *x != S::ZERO),
            bounds: *bounds,
            beyond: dt * S::from_f64(BEYOND * time),
            smooth: S::from_f64(SMOOTH * torque / time),
            damping: if cost.torque > damping { cost.torque } else { damping },
            least: S::from_f64(LEAST * curvature),
            energy: machine.energy(),
            by_energy: S::ZERO,
            replans: false,
        }
    }

    /// What a step costs, without the change of the torque.
    #[inline(always)]
    pub(super) fn step(
        &self,
        params: &Params<S>,
        y: [S; 4],
        sin_cos: [SinCos<S>; 2],
        torque: S,
    ) -> S {
        let [_, _, dtheta1, dtheta2] = y;
        let cost = &self.cost;
        let apart = torque - self.held;
        let [bound1, bound2] = self.bounds;
        let power = dtheta2 * torque;
        let [_, [_, height]] = positions(params, sin_cos);
        let depth = at_least_zero((cost.height - height) / cost.margin);
        let square = depth * depth;
        let beyond1 = at_least_zero(dtheta1.abs() - bound1);
        let beyond2 = at_least_zero(dtheta2.abs() - bound2);
        let sum = cost.torque * (apart * apart)
            + cost.power * (power * power / (power.abs() + self.smooth))
            + cost.below * (square / (S::ONE + square))
            + self.beyond * (beyond1 * beyond1 + beyond2 * beyond2);
        if !self.weights_state {
            return sum;
        }
        let ([angle1, angle2], two) = (cost.angles, S::from_f64(2.0));
        let (x, [(_, cos1), (_, cos2)]) = self.deviation(y, sin_cos);
        sum + S::HALF * dot(cost.q.map(|row| dot(row, x)), x)
            + angle1 * (two - two * cos1)
            + angle2 * (two - two * cos2)
    }

    /// The slopes of [`step`](Self::step) and its curvatures, where they are not negative: by the
    /// state, and by the torque. The curvature by the state is that of Q and this diagonal.
    #[inline(always)]
    pub(super) fn slopes(
        &self,
        params: &Params<S>,
        y: [S; 4],
        sin_cos: [SinCos<S>; 2],
        torque: S,
    ) -> ([[S; 2]; 4], [S; 2]) {
        let [_, _, dtheta1, dtheta2] = y;
        let cost = &self.cost;
        let [bound1, bound2] = self.bounds;

        let power = dtheta2 * torque;
        let inverse = S::ONE / (power.abs() + self.smooth);
        let by_power = cost.power * (power * inverse * (S::ONE + self.smooth * inverse));
        let weight = cost.power * inverse;

        let [[elbow, _], [tip, height]] = positions(params, sin_cos);
        let depth = at_least_zero((cost.height - height) / cost.margin);
        let part = S::ONE / (S::ONE + depth * depth);
        let by_height = -(cost.below * ((depth + depth) * (part * part)) / cost.margin);

        let beyond = self.beyond + self.beyond;
        let bounded = |velocity: S, bound: S| {
            let (over, under) = (at_least_zero(velocity - bound), at_least_zero(-velocity - bound));
            let curvature = if over + under > S::ZERO { beyond } else { S::ZERO };
            [beyond * (over - under), curvature]
        };
        let [slope1, curvature1] = bounded(dtheta1, bound1);
        let [slope2, curvature2] = bounded(dtheta2, bound2);
        let mut by_state = [
            [by_height * tip, S::ZERO],
            [by_height * (tip - elbow), S::ZERO],
            [slope1, curvature1],
            [slope2 + by_power * torque, curvature2 + weight * (torque * torque)],
        ];
        if self.weights_state {
            let [angle1, angle2] = cost.angles.map(|x| x + x);
            let (x, [(sin1, cos1), (sin2, cos2)]) = self.deviation(y, sin_cos);
            let turned = [
                [angle1 * sin1, angle1 * at_least_zero(cos1)],
                [angle2 * sin2, angle2 * at_least_zero(cos2)],
                [S::ZERO; 2],
                [S::ZERO; 2],
            ];
            for ((own, turned), row) in by_state.iter_mut().zip(turned).zip(cost.q) {
                *own = [own[0] + turned[0] + dot(row, x), own[1] + turned[1]];
            }
        }
        let torque_slope = (cost.torque + cost.torque) * (torque - self.held) + by_power * dtheta2;
        let torque_curvature = cost.torque + cost.torque + weight * (dtheta2 * dtheta2);
        (by_state, [torque_slope, torque_curvature])
    }

    /// The deviation from the target, and the sines and cosines of its angles.
    #[inline(always)]
    fn deviation(&self, y: [S; 4], sin_cos: [SinCos<S>; 2]) -> ([S; 4], [SinCos<S>; 2]) {
        let ([theta1, theta2, dtheta1, dtheta2], target) = (y, &self.target);
        let ([(s1, c1), (s2, c2)], [(sin1, cos1), (sin2, cos2)]) = (self.sin_cos, sin_cos);
        let x = [wrap(theta1 - target.theta1), wrap(theta2 - target.theta2), dtheta1, dtheta2];
        let turned = [
            (sin1 * c1 - cos1 * s1, cos1 * c1 + sin1 * s1),
            (sin2 * c2 - cos2 * s2, cos2 * c2 + sin2 * s2),
        ];
        (x, turned)
    }

    /// What the state after a plan costs.
    pub(super) fn arrival<A: Arithmetic<Scalar = S>>(
        &self,
        regulator: &BoundedRegulator<A>,
        end: [S; 4],
    ) -> S {
        let x = regulator.feedback.deviation(end.into());
        let excess = dot(apply(&regulator.cost_to_go, &x), x) / regulator.near;
        let cost = self.cost.arrival * S::from_f64(libm::log1p(excess.to_f64()))
            + S::HALF * dot(apply(&self.cost.qf, &x), x);
        let (more, _) = self.excess(regulator, end);
        cost + self.by_energy * (more * more)
    }

    /// The energy of a state above that of the target, J, with its slopes.
    #[inline(never)]
    fn excess<A: Arithmetic<Scalar = S>>(
        &self,
        regulator: &BoundedRegulator<A>,
        end: [S; 4],
    ) -> (S, [S; 4]) {
        let mut machine = regulator.machine.clone();
        if self.by_energy == S::ZERO || machine.set_state(end.into()).is_err() {
            return (S::ZERO, [S::ZERO; 4]);
        }
        let sin_cos = machine.sin_cos();
        let Constants { coupling, gravity1, gravity2, .. } = machine.model().constants;
        let [(sin1, _), (sin2, _)] = sin_cos;
        let [_, (sin_sum, _)] = directions(sin_cos);
        let [_, _, v1, v2] = end;
        let [momentum1, momentum2] = machine.mass_matrix().map(|[m1, m2]| m1 * v1 + m2 * v2);
        let fall = gravity2 * sin_sum;
        let by_theta2 = fall - coupling * sin2 * (v1 * (v1 + v2));
        let slopes = [gravity1 * sin1 + fall, by_theta2, momentum1, momentum2];
        (machine.energy() - self.energy, slopes)
    }

    /// The slopes of [`arrival`](Self::arrival), the upper triangle of its curvature, and zeros for
    /// the torque before. Where the logarithm is concave, the curvature is that without it.
    #[inline(never)]
    pub(super) fn arrival_slopes<A: Arithmetic<Scalar = S>>(
        &self,
        regulator: &BoundedRegulator<A>,
        end: [S; 4],
    ) -> [S; 20] {
        let x = regulator.feedback.deviation(end.into());
        let own = apply(&regulator.cost_to_go, &x);
        let weight = self.cost.arrival + self.cost.arrival;
        let weight = weight / (dot(own, x) + regulator.near);
        let mut curved = self.cost.qf;
        add(&mut curved, weight, &regulator.cost_to_go);
        let (more, slopes) = self.excess(regulator, end);
        let by_energy = self.by_energy + self.by_energy;
        add_outer(&mut curved, by_energy, &slopes, &slopes);
        let [s1, s2, s3, s4] = plus_scaled(
            plus_scaled(apply(&self.cost.qf, &x), weight, own),
            by_energy * more,
            slopes,
        );
        let [[p11, p12, p13, p14], [_, p22, p23, p24], [_, _, p33, p34], [.., p44]] = curved;
        let o = S::ZERO;
        [s1, s2, s3, s4, p11, p12, p13, p14, p22, p23, p24, p33, p34, p44, o, o, o, o, o, o]
    }
}

#[inline(always)]
fn at_least_zero<S: Real>(x: S) -> S {
    if x > S::ZERO { x } else { S::ZERO }
}
