//! Improves plans side by side, a plan a lane. A lane whose plan is done takes the next.
//!
//! The lanes of a pass are in different phases: some search for the part of their change that
//! lowers the cost, some keep the part that they found, and some wait for a backward pass. Each
//! pass computes all lanes, so a backward pass is worth its time once most lanes wait. A backward
//! pass of a lane that does not wait finds the same change again.

use super::knots::Knot;
use super::passes::{Backward, Forward, Machine, Motion, Orders, lanes, set_lanes};
use crate::arithmetic::Arithmetic;
use crate::math::sealed::Sealed as _;
use crate::math::{Numbers, Real};
use crate::physics::{State, sin_cos};

/// An iteration counts as stalled if it lowers the cost by less than this part, or not at all. So
/// many in succession end the search.
const LITTLE: f64 = 1e-3;
const STALLED: u32 = 8;
/// A change of the torques is tried at its full size, then at a quarter of it, and so on.
const QUARTERS: u32 = 5;
/// The damping grows where less than this part of a change lowers the cost.
const SMALL: f64 = 0.2;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    Idle,
    Waits,
    Searches,
    Keeps,
}

/// The plan in a lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Try<S> {
    phase: Phase,
    /// How many plans began before it.
    index: usize,
    cost: S,
    damping: S,
    /// The part of the change that is tried.
    part: S,
    quarters: u32,
    iterations: u32,
    stalled: u32,
}

/// A plan that is done.
#[cfg_attr(not(feature = "alloc"), expect(dead_code, reason = "plans side by side read all"))]
pub(super) struct Done<'a, S, V> {
    /// How many plans began before it, and the least of this number of those that are not done.
    pub(super) index: usize,
    pub(super) oldest: usize,
    /// Its lane, and the knots of all lanes.
    pub(super) lane: usize,
    pub(super) knots: &'a [Knot<V>],
    /// Not finite if the numbers overflow.
    pub(super) cost: S,
    /// The state after the plan.
    pub(super) end: State<S>,
}

/// Improves plans, each by at most so many iterations, in lanes that begin with [`Try::new`].
/// `next` writes the next plan into a lane, and returns its length and the state in which it
/// begins, or `None` without another one. `take` returns whether to go on, and so does `go_on`,
/// before each pass.
#[inline(never)]
pub(super) fn improve<A: Arithmetic, V: Numbers<A::Scalar>, const LANES: usize>(
    machine: Machine<'_, A>,
    tries: &mut [Try<A::Scalar>; LANES],
    iterations: u32,
    knots: &mut [Knot<V>],
    mut next: impl FnMut(&mut [Knot<V>], usize) -> Option<(usize, State<A::Scalar>)>,
    mut take: impl FnMut(Done<'_, A::Scalar, V>) -> bool,
    mut go_on: impl FnMut() -> bool,
) {
    let number = A::Scalar::from_f64;
    let [zero, one] = [A::Scalar::ZERO, A::Scalar::ONE];
    let [zeros, ones] = [V::splat(zero), V::splat(one)];
    let mut first = Motion {
        y: [zeros; 4],
        sin_cos: [(zeros, ones); 2],
        torque: zeros,
        planned: zeros,
        cost: zeros,
    };
    let mut orders = Orders { len: zeros, part: zeros, keep: zeros };
    let (mut ends, mut begun) = (first.y, 0);
    loop {
        let mut active = 0;
        for (i, plan) in tries.iter_mut().enumerate() {
            if plan.phase == Phase::Idle
                && let Some((len, start)) = next(knots, i)
            {
                orders.len.set_lane(i, number(len as f64));
                set_lanes(&mut first.y, i, start.into());
                let sines = sin_cos::<A>([start.theta1, start.theta2]);
                for (place, (sin, cos)) in first.sin_cos.iter_mut().zip(sines) {
                    place.0.set_lane(i, sin);
                    place.1.set_lane(i, cos);
                }
                let damping = machine.weights.damping;
                *plan = Try { phase: Phase::Keeps, index: begun, damping, ..Try::new() };
                begun += 1;
            }
            active += usize::from(plan.phase != Phase::Idle);
            orders.part.set_lane(i, plan.part);
            let keeps = if plan.phase == Phase::Keeps { one } else { zero };
            orders.keep.set_lane(i, keeps);
        }
        if active == 0 || !go_on() {
            return;
        }
        let longest = tries.iter().enumerate();
        let longest = longest.filter(|(_, plan)| plan.phase != Phase::Idle);
        let longest = longest.map(|(i, _)| orders.len.lane(i).to_f64() as usize).max();
        let Some((knots, _)) = knots.split_at_mut_checked(longest.unwrap_or(0)) else { return };

        let mut motion = first;
        machine.level.run(Forward { machine, knots, orders: &orders, motion: &mut motion });
        let mut waiting = 0;
        for i in 0..LANES {
            let Some(plan) = tries.get_mut(i) else { break };
            let cost = motion.cost.lane(i);
            match plan.phase {
                Phase::Searches if cost < plan.cost - plan.cost * number(1e-6) => {
                    plan.phase = Phase::Keeps;
                }
                Phase::Searches => {
                    plan.part = plan.part * number(0.25);
                    plan.quarters += 1;
                    if plan.quarters == QUARTERS {
                        plan.fail();
                    }
                }
                Phase::Keeps => {
                    set_lanes(&mut ends, i, lanes(&motion.y, i));
                    let before = plan.cost;
                    plan.cost = cost;
                    plan.phase = Phase::Waits;
                    if plan.part > zero {
                        let is_little = before - cost < before * number(LITTLE);
                        plan.stalled = if is_little { plan.stalled + 1 } else { 0 };
                        plan.iterations += 1;
                        let is_small = plan.part < number(SMALL);
                        plan.damping = plan.damping * number(if is_small { 3.0 } else { 0.5 });
                    }
                }
                Phase::Waits | Phase::Idle => {}
            }
            let is_over = plan.iterations >= iterations || plan.stalled > STALLED;
            if plan.phase == Phase::Waits && (is_over || !plan.cost.is_finite()) {
                plan.phase = Phase::Idle;
                let Try { index, cost, .. } = *plan;
                let len = orders.len.lane(i).to_f64() as usize;
                let knots = knots.get(..len).unwrap_or(knots);
                let others = tries.iter().filter(|plan| plan.phase != Phase::Idle);
                let oldest = others.map(|plan| plan.index).min().unwrap_or(usize::MAX);
                let end = lanes(&ends, i).into();
                if !take(Done { index, oldest, lane: i, knots, cost, end }) {
                    return;
                }
            } else {
                waiting += usize::from(plan.phase == Phase::Waits);
            }
        }
        if 4 * waiting < 3 * active {
            continue;
        }
        let mut damping = V::splat(one);
        for (i, plan) in tries.iter().enumerate() {
            damping.set_lane(i, plan.damping);
        }
        let mut least = damping;
        let backward =
            Backward { machine, knots, len: orders.len, ends: &ends, damping, least: &mut least };
        machine.level.run(backward);
        for (i, plan) in tries.iter_mut().enumerate() {
            if plan.phase == Phase::Waits {
                match least.lane(i) >= machine.weights.least {
                    true => (plan.phase, plan.part, plan.quarters) = (Phase::Searches, one, 0),
                    false => plan.fail(),
                }
            }
        }
    }
}

impl<S: Real> Try<S> {
    pub(super) fn new() -> Self {
        Self {
            phase: Phase::Idle,
            index: 0,
            cost: S::ZERO,
            damping: S::ZERO,
            part: S::ZERO,
            quarters: 0,
            iterations: 0,
            stalled: 0,
        }
    }

    /// No part of the change lowers the cost.
    fn fail(&mut self) {
        self.phase = Phase::Waits;
        self.damping = self.damping * S::from_f64(8.0);
        self.iterations += 1;
        self.stalled += 1;
    }
}
