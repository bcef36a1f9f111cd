//! The two passes of an iteration: forward, a simulation of the plan with a part of its change, and
//! backward, which finds the change. Of one plan, or of many side by side, a plan a lane.
//!
//! No lane reads another one, so a plan has the same bits alone and in any lane. The loops over
//! lanes are around code for one number: see ARCHITECTURE.md.

use super::cost::Weights;
use super::knots::Knot;
use crate::arithmetic::Arithmetic;
use crate::control::model::step_model::{derivatives, derivatives_alone, sin_cos_near};
use crate::control::regulator::BoundedRegulator;
use crate::math::matrix::dot;
use crate::math::sealed::Sealed as _;
use crate::math::{Kernel, Numbers, Real, SimdLevel, SinCos, lanes, pair, set_lanes};
use crate::physics::{Model, State, plus_scaled, saturate, step, wrap};

/// What the passes know of the machine, and the SIMD instructions that they use.
#[derive(Clone, Copy, Debug)]
pub(super) struct Machine<'a, A: Arithmetic> {
    pub(super) regulator: &'a BoundedRegulator<A>,
    pub(super) weights: &'a Weights<A::Scalar>,
    pub(super) level: SimdLevel,
}

/// How far each plan is simulated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion<V> {
    /// The state, and its sines and cosines.
    pub(super) y: [V; 4],
    pub(super) sin_cos: [SinCos<V>; 2],
    /// The torques of the step before, now and in the plan.
    pub(super) torque: V,
    pub(super) planned: V,
    pub(super) cost: V,
}

/// What a forward pass does with each plan.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orders<V> {
    /// The number of its knots.
    pub(super) len: V,
    /// The part of the change.
    pub(super) part: V,
    /// 1 if the new states and torques replace those of the plan, 0 otherwise.
    pub(super) keep: V,
}

/// Simulates plans from the state of a motion. The motion becomes the state after each plan, and
/// what the plan costs.
pub(super) struct Forward<'a, A: Arithmetic, V> {
    pub(super) machine: Machine<'a, A>,
    pub(super) knots: &'a mut [Knot<V>],
    pub(super) orders: &'a Orders<V>,
    pub(super) motion: &'a mut Motion<V>,
}

impl<A: Arithmetic, V: Numbers<A::Scalar>> Kernel for Forward<'_, A, V> {
    #[inline(always)]
    fn run<const AVX512: bool>(self) {
        let Machine { regulator, weights, .. } = self.machine;
        let model = regulator.machine.model();
        let (params, weights, limit) = (model.params, *weights, regulator.limit);
        let by_jump = weights.cost.torque_change;
        let lanes_model = model.zip(model, |x, _| V::splat(*x));
        let orders = *self.orders;
        let mut motion = *self.motion;
        let (mut ends, mut costs) = (motion.y, motion.cost);
        let mut index = A::Scalar::ZERO;
        for knot in self.knots {
            let mut kept = *knot;
            let mut torques = motion.torque;
            for i in 0..V::LEN {
                let old = kept.lane(i);
                let y = lanes(&motion.y, i);
                let [x1, x2, x3, x4]: [A::Scalar; 4] = old.state.into();
                let x = [wrap(y[0] - x1), wrap(y[1] - x2), y[2] - x3, y[3] - x4];
                let before = motion.torque.lane(i);
                let smooth = old.smooth * (before - motion.planned.lane(i));
                let change = orders.part.lane(i) * old.change;
                let torque = old.torque + change + (smooth - dot(old.gain, x));
                let torque = saturate(torque, limit);
                let [sines1, sines2] = &motion.sin_cos;
                let sin_cos = [pair(sines1, i), pair(sines2, i)];
                // The first torque may be any.
                let jump = if index > A::Scalar::ZERO { torque - before } else { A::Scalar::ZERO };
                let step = weights.step(&params, y, sin_cos, torque);
                let step = step + by_jump * (jump * jump);
                motion.cost.set_lane(i, motion.cost.lane(i) + step);
                motion.planned.set_lane(i, old.torque);
                torques.set_lane(i, torque);
                let keeps = orders.keep.lane(i) > A::Scalar::ZERO;
                let keep = |new, old| if keeps { new } else { old };
                let state =
                    State::from([keep(y[0], x1), keep(y[1], x2), keep(y[2], x3), keep(y[3], x4)]);
                kept.set_lane(i, Knot { state, torque: keep(torque, old.torque), ..old });
            }
            *knot = kept;
            motion.torque = torques;
            step::<A, V>(&lanes_model, &mut motion.y, &mut motion.sin_cos, torques);
            index = index + A::Scalar::ONE;
            for i in 0..V::LEN {
                let is_end = index == orders.len.lane(i);
                let pick = |new, old| if is_end { new } else { old };
                for (end, y) in ends.iter_mut().zip(&motion.y) {
                    end.set_lane(i, pick(y.lane(i), end.lane(i)));
                }
                costs.set_lane(i, pick(motion.cost.lane(i), costs.lane(i)));
            }
        }
        for i in 0..V::LEN {
            let arrival = weights.arrival(regulator, lanes(&ends, i));
            costs.set_lane(i, costs.lane(i) + arrival);
        }
        (self.motion.y, self.motion.cost) = (ends, costs);
    }
}

/// Finds the change of each torque and its gains, from the last knot to the first.
pub(super) struct Backward<'a, A: Arithmetic, V> {
    pub(super) machine: Machine<'a, A>,
    pub(super) knots: &'a mut [Knot<V>],
    pub(super) len: V,
    /// The states after the plans.
    pub(super) ends: &'a [V; 4],
    pub(super) damping: V,
    /// The smallest divisor, which is not positive where the damping was too small.
    pub(super) least: &'a mut V,
}

/// What the rest of a plan costs, about a knot: the slopes by the state before the knot, the upper
/// triangle of the curvatures by rows, the curvatures by a state and the torque before the knot,
/// and the slope and the curvature by that torque.
type ToGo<V> = [V; 20];

impl<A: Arithmetic, V: Numbers<A::Scalar>> Kernel for Backward<'_, A, V> {
    #[inline(always)]
    fn run<const AVX512: bool>(self) {
        let Machine { regulator, weights, .. } = self.machine;
        let mut model = *regulator.machine.model();
        if weights.replans {
            model.params.coulomb2 = A::Scalar::ZERO;
        }
        let local = Local { model, limit: regulator.limit, weights: *weights };
        let by_jump = weights.cost.torque_change;
        let (len, dampings) = (self.len, self.damping);
        let zero = V::splat(A::Scalar::ZERO);
        let mut to_go = [zero; 20];
        let most = A::Scalar::from_f64(f64::INFINITY);
        let mut least = V::splat(most);
        let mut index = A::Scalar::from_f64(self.knots.len() as f64);
        let mut knots = self.knots;
        while let Some((knot, earlier)) = knots.split_last_mut() {
            let before = earlier.last().unwrap_or(knot).torque;
            // The first torque may jump.
            let jumps = if earlier.is_empty() { A::Scalar::ZERO } else { by_jump };
            for i in 0..V::LEN {
                if index == len.lane(i) {
                    let end = lanes(self.ends, i);
                    set_lanes(&mut to_go, i, weights.arrival_slopes(regulator, end));
                    least.set_lane(i, most);
                }
            }
            let mut changed = *knot;
            for i in 0..V::LEN {
                let rest = lanes(&to_go, i);
                let lowest = least.lane(i);
                let old = changed.lane(i);
                let jump = Jump { before: before.lane(i), weight: jumps };
                let damping = dampings.lane(i);
                let (new, now, divisor) = match V::LEN {
                    1 => look_back::<A, false>(&local, &old, &jump, &rest, damping),
                    _ => look_back::<A, true>(&local, &old, &jump, &rest, damping),
                };
                changed.set_lane(i, new);
                set_lanes(&mut to_go, i, now);
                least.set_lane(i, if divisor < lowest { divisor } else { lowest });
            }
            *knot = changed;
            index = index - A::Scalar::ONE;
            knots = earlier;
        }
        *self.least = least;
    }
}

/// A copy of what a backward pass reads, which LLVM keeps in registers.
struct Local<S> {
    model: Model<S>,
    limit: S,
    weights: Weights<S>,
}

/// The torque before a knot, and the weight of the jump from there.
struct Jump<S> {
    before: S,
    weight: S,
}

/// The new change and gains of a knot, what the rest of the plan costs from this knot on, and the
/// divisor.
#[expect(clippy::indexing_slicing, reason = "the indices are 0 to 3")]
#[inline(always)]
fn look_back<A: Arithmetic, const IN_LANES: bool>(
    Local { model, limit, weights }: &Local<A::Scalar>,
    knot: &Knot<A::Scalar>,
    jump: &Jump<A::Scalar>,
    rest: &ToGo<A::Scalar>,
    damping: A::Scalar,
) -> (Knot<A::Scalar>, ToGo<A::Scalar>, A::Scalar) {
    let (zero, one) = (A::Scalar::ZERO, A::Scalar::ONE);
    let y: [A::Scalar; 4] = knot.state.into();
    let torque = knot.torque;
    let sin_cos = [sin_cos_near::<A, IN_LANES>(y[0]), sin_cos_near::<A, IN_LANES>(y[1])];
    let [a1, a2, a3, a4, b] = match IN_LANES {
        true => derivatives::<A, true>(model, y, sin_cos, torque),
        false => derivatives_alone::<A>(model, y, sin_cos, torque),
    };
    let (by_state, [by_own, by_own2]) = weights.slopes(&model.params, y, sin_cos, torque);
    let [s1, s2, s3, s4, p11, p12, p13, p14, p22, p23, p24, p33, p34, p44, rest @ ..] = *rest;
    let [both1, both2, both3, both4, torque_slope, torque_curvature] = rest;
    let (slope, both) = ([s1, s2, s3, s4], [both1, both2, both3, both4]);
    let rows =
        [[p11, p12, p13, p14], [p12, p22, p23, p24], [p13, p23, p33, p34], [p14, p24, p34, p44]];
    let apply = |x| [dot(rows[0], x), dot(rows[1], x), dot(rows[2], x), dot(rows[3], x)];

    // The curvature and the slope of what the jump costs.
    let pull = jump.weight + jump.weight;
    let by_jump = pull * (torque - jump.before);
    let p_b = plus_scaled(apply(b), one, both);
    let by_torque = dot(b, slope) + (torque_slope + (by_own + by_jump));
    let by_torque2 = dot(b, plus_scaled(p_b, one, both)) + (torque_curvature + (by_own2 + pull));
    let by_both = [dot(a1, p_b), dot(a2, p_b), dot(a3, p_b), dot(a4, p_b)];

    let divisor = by_torque2 + damping;
    let inverse = one / divisor;
    let wanted = torque - by_torque * inverse;
    let bounded = saturate(wanted, *limit);
    let change = bounded - torque;
    // A torque at its bound has no feedback.
    let free = if bounded == wanted { inverse } else { zero };
    let gain = by_both.map(|x| -(x * free));
    let smooth = pull * free;

    let by_gain = plus_scaled(by_both, by_torque2, gain);
    let [q1, q2, q3, q4] = [apply(a1), apply(a2), apply(a3), apply(a4)];
    // Elements i and j of K Qᵀ + Q Kᵀ + K Quu Kᵀ.
    let by = |i: usize, j: usize| gain[i] * by_gain[j] + by_both[i] * gain[j];
    let own = by_state.map(|[slope, _]| slope);
    let rest = by_torque2 * change + by_torque;
    let by_a = [dot(a1, slope), dot(a2, slope), dot(a3, slope), dot(a4, slope)];
    let slope = plus_scaled(plus_scaled(by_a, one, own), rest, gain);
    let [s1, s2, s3, s4] = plus_scaled(slope, change, by_both);
    let both = by_both.map(|x| x * smooth);
    let [both1, both2, both3, both4] = plus_scaled(both, by_torque2 * smooth - pull, gain);
    let mut to_go = [
        s1,
        s2,
        s3,
        s4,
        dot(a1, q1) + by(0, 0) + by_state[0][1],
        dot(a1, q2) + by(0, 1),
        dot(a1, q3) + by(0, 2),
        dot(a1, q4) + by(0, 3),
        dot(a2, q2) + by(1, 1) + by_state[1][1],
        dot(a2, q3) + by(1, 2),
        dot(a2, q4) + by(1, 3),
        dot(a3, q3) + by(2, 2) + by_state[2][1],
        dot(a3, q4) + by(2, 3),
        dot(a4, q4) + by(3, 3) + by_state[3][1],
        both1,
        both2,
        both3,
        both4,
        smooth * rest - (pull * change + by_jump),
        pull + smooth * (by_torque2 * smooth - (pull + pull)),
    ];
    if weights.weights_state {
        let [q1, q2, q3, q4] = &weights.cost.q;
        let upper = q1.iter().chain(&q2[1..]).chain(&q3[2..]).chain(&q4[3..]);
        to_go[4..].iter_mut().zip(upper).for_each(|(place, q)| *place = *place + *q);
    }
    (Knot { change, gain: by_both.map(|x| x * free), smooth, ..*knot }, to_go, divisor)
}
