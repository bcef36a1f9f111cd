//! Plans side by side, with SIMD.

use alloc::vec;
use alloc::vec::Vec;

use rand_core::Rng;

use super::super::error::ControlError;
use super::super::plan::{Knot, NoPlan};
use super::super::tries::{self, Try};
use super::{ITERATIONS, Planner};
use crate::arithmetic::Arithmetic;
use crate::math::{Lanes, Numbers as _, Real};
use crate::physics::State;

/// Plans side by side.
const LANES: usize = 16;
/// So many tries in succession have the same length: lanes with shorter plans wait.
const OF_A_LENGTH: usize = 4;

type Side<S> = Lanes<S, LANES>;

impl<A: Arithmetic> Planner<A> {
    /// As [`plan`](Self::plan), of at most so many steps, with 16 tries side by side. Returns the
    /// first plan that is done and holds. It has the same bits at each [level of
    /// SIMD](Self::set_simd_level).
    ///
    /// # Errors
    ///
    /// Those of `plan`, and [`ControlError::OutOfMemory`] for too many steps.
    pub fn search<R: Rng + ?Sized>(
        &mut self,
        start: State<A::Scalar>,
        tries: u32,
        rng: &mut R,
        steps: usize,
    ) -> Result<Vec<Knot<A::Scalar>>, NoPlan> {
        start.validate()?;
        let mut knots = memory(empty(), steps)?;
        let mut guess = memory(Knot::EMPTY, steps)?;
        let mut guesser = self.clone();
        let (mut tried, mut found) = (0, None);
        let next = |knots: &mut [Knot<Side<A::Scalar>>], lane| {
            while tried < tries as usize {
                let len = steps * (1 + tried / OF_A_LENGTH % 10) / 10;
                tried += 1;
                let guess = guess.get_mut(..len)?;
                // Extreme parameters can make a guess overflow.
                if guesser.guess(start, rng, guess).is_ok() {
                    set_plan(knots, lane, guess);
                    return Some(len);
                }
            }
            None
        };
        let take = |_, lane, knots: &[Knot<Side<A::Scalar>>], cost: A::Scalar, end| {
            if cost.is_finite() {
                let mut plan: Vec<_> = knots.iter().map(|knot| knot.lane(lane)).collect();
                let holds = self.is_success(&plan, end) && self.track(&mut plan).is_ok();
                found = holds.then_some(plan);
            }
            found.is_none()
        };
        let (machine, lanes) = (self.machine(self.level), &mut [Try::new(); LANES]);
        tries::improve::<A, _, LANES>(machine, lanes, start, ITERATIONS, &mut knots, next, take);
        found.ok_or(NoPlan::NotFound { tries })
    }

    /// [Improves](Self::improve) plans side by side. Returns their costs.
    ///
    /// # Errors
    ///
    /// A number of the state is not finite, or [`ControlError::OutOfMemory`]. In the list there are
    /// the errors of `improve`.
    pub fn improve_all(
        &mut self,
        start: State<A::Scalar>,
        iterations: u32,
        plans: &mut [Vec<Knot<A::Scalar>>],
    ) -> Result<Vec<Result<A::Scalar, ControlError>>, ControlError> {
        start.validate()?;
        let longest = plans.iter().map(Vec::len).max().unwrap_or(0);
        let mut knots = memory(empty(), longest)?;
        let mut costs = vec![A::Scalar::ZERO; plans.len()];
        let (given, mut begun) = (plans.to_vec(), 0);
        let next = |knots: &mut [Knot<Side<A::Scalar>>], lane| {
            let plan = given.get(begun)?;
            begun += 1;
            set_plan(knots, lane, plan);
            Some(plan.len())
        };
        let take = |index: usize, lane, knots: &[Knot<Side<A::Scalar>>], cost, _| {
            let places = plans.get_mut(index).into_iter().flatten();
            places.zip(knots).for_each(|(place, knot)| *place = knot.lane::<A::Scalar>(lane));
            if let Some(place) = costs.get_mut(index) {
                *place = cost;
            }
            true
        };
        let (machine, lanes) = (self.machine(self.level), &mut [Try::new(); LANES]);
        tries::improve::<A, _, LANES>(machine, lanes, start, iterations, &mut knots, next, take);
        let finish = |(cost, plan): (_, &mut Vec<_>)| self.finish(cost, plan);
        Ok(costs.into_iter().zip(plans).map(finish).collect())
    }
}

/// Memory for so many knots.
fn memory<T: Clone>(empty: T, knots: usize) -> Result<Vec<T>, ControlError> {
    let mut memory = Vec::new();
    let reserved = memory.try_reserve_exact(knots);
    reserved.map_err(|_| ControlError::OutOfMemory { knots })?;
    memory.resize(knots, empty);
    Ok(memory)
}

fn empty<S: Real>() -> Knot<Side<S>> {
    let zero = Side::splat(S::ZERO);
    let state = State::from([zero; 4]);
    Knot { state, torque: zero, gain: [zero; 4], change: zero, smooth: zero }
}

/// Writes a plan into a lane.
fn set_plan<S: Real>(knots: &mut [Knot<Side<S>>], lane: usize, plan: &[Knot<S>]) {
    knots.iter_mut().zip(plan).for_each(|(place, knot)| place.set_lane(lane, *knot));
}
