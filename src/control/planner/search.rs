//! Plans side by side, with SIMD.

use alloc::vec;
use alloc::vec::Vec;

use rand_core::Rng;

use super::super::error::ControlError;
use super::super::plan::{Knot, NoPlan};
use super::super::tries::{self, Plans};
use super::{ITERATIONS, Planner};
use crate::arithmetic::Arithmetic;
use crate::error::Error;
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
    /// Those of `plan`.
    pub fn search<R: Rng + ?Sized>(
        &mut self,
        start: State<A::Scalar>,
        tries: u32,
        rng: &mut R,
        steps: usize,
    ) -> Result<Vec<Knot<A::Scalar>>, NoPlan> {
        start.validate()?;
        let mut guesser = self.clone();
        let mut guess = |plan: &mut [Knot<A::Scalar>]| guesser.guess(start, rng, plan).is_ok();
        let mut search = Search {
            planner: self,
            guess: &mut guess,
            left: tries,
            tries: 0,
            steps,
            plan: vec![Knot::EMPTY; steps],
            lens: [0; LANES],
            found: false,
        };
        let mut knots = vec![empty(); steps];
        let (machine, level) = (self.machine(), self.level);
        tries::improve::<A, Side<A::Scalar>>(
            machine,
            level,
            start,
            ITERATIONS,
            &mut knots,
            &mut search,
        );
        let Search { found, mut plan, .. } = search;
        match found {
            true => self.track(&mut plan).map(|()| plan).map_err(NoPlan::Invalid),
            false => Err(NoPlan::NotFound { tries }),
        }
    }

    /// [Improves](Self::improve) plans side by side. Returns their costs.
    ///
    /// # Errors
    ///
    /// A number of the state is not finite. In the list there are the errors of `improve`.
    pub fn improve_all(
        &mut self,
        start: State<A::Scalar>,
        iterations: u32,
        plans: &mut [Vec<Knot<A::Scalar>>],
    ) -> Result<Vec<Result<A::Scalar, ControlError>>, Error> {
        start.validate()?;
        let longest = plans.iter().map(Vec::len).max().unwrap_or(0);
        let mut costs = vec![A::Scalar::ZERO; plans.len()];
        let mut all = All { plans, costs: &mut costs, next: 0, lanes: [0; LANES] };
        let mut knots = vec![empty(); longest];
        tries::improve::<A, Side<A::Scalar>>(
            self.machine(),
            self.level,
            start,
            iterations,
            &mut knots,
            &mut all,
        );
        let finish = |(cost, plan): (_, &mut Vec<_>)| self.finish(cost, plan);
        Ok(costs.into_iter().zip(plans).map(finish).collect())
    }
}

fn empty<S: Real>() -> Knot<Side<S>> {
    let zero = Side::splat(S::ZERO);
    let state = State::from([zero; 4]);
    Knot { state, torque: zero, gain: [zero; 4], change: zero, smooth: zero }
}

/// Fills a plan; false if the numbers overflow.
type Guess<'a, S> = dyn FnMut(&mut [Knot<S>]) -> bool + 'a;

/// Tries until one succeeds.
struct Search<'a, A: Arithmetic> {
    planner: &'a Planner<A>,
    guess: &'a mut Guess<'a, A::Scalar>,
    left: u32,
    tries: usize,
    steps: usize,
    plan: Vec<Knot<A::Scalar>>,
    /// Of the plans in the lanes.
    lens: [usize; LANES],
    found: bool,
}

impl<A: Arithmetic> Plans<A::Scalar, Side<A::Scalar>> for Search<'_, A> {
    fn next(&mut self, knots: &mut [Knot<Side<A::Scalar>>], lane: usize) -> Option<usize> {
        while self.left > 0 {
            self.left -= 1;
            let len = self.steps * (1 + self.tries / OF_A_LENGTH % 10) / 10;
            self.tries += 1;
            self.plan.resize(len, Knot::EMPTY);
            // Extreme parameters can make a guess overflow.
            if (self.guess)(&mut self.plan) {
                for (place, knot) in knots.iter_mut().zip(&self.plan) {
                    place.set_lane(lane, *knot);
                }
                *self.lens.get_mut(lane)? = len;
                return Some(len);
            }
        }
        None
    }

    fn take(
        &mut self,
        knots: &[Knot<Side<A::Scalar>>],
        lane: usize,
        cost: A::Scalar,
        end: State<A::Scalar>,
    ) -> bool {
        if cost.is_finite() && self.planner.catches(end) {
            self.plan.clear();
            let len = self.lens.get(lane).copied().unwrap_or(0);
            self.plan.extend(knots.iter().take(len).map(|knot| knot.lane(lane)));
            self.found = self.planner.is_success(&self.plan, end);
        }
        !self.found
    }
}

/// All plans of a list.
struct All<'a, S> {
    plans: &'a mut [Vec<Knot<S>>],
    costs: &'a mut [S],
    next: usize,
    /// Which plans are in the lanes.
    lanes: [usize; LANES],
}

impl<S: Real> Plans<S, Side<S>> for All<'_, S> {
    fn next(&mut self, knots: &mut [Knot<Side<S>>], lane: usize) -> Option<usize> {
        let plan = self.plans.get(self.next)?;
        for (place, knot) in knots.iter_mut().zip(plan) {
            place.set_lane(lane, *knot);
        }
        *self.lanes.get_mut(lane)? = self.next;
        self.next += 1;
        Some(plan.len())
    }

    fn take(&mut self, knots: &[Knot<Side<S>>], lane: usize, cost: S, _: State<S>) -> bool {
        let index = self.lanes.get(lane).copied().unwrap_or(0);
        let places = self.plans.get_mut(index).into_iter().flatten();
        places.zip(knots).for_each(|(place, knot)| *place = knot.lane(lane));
        if let Some(place) = self.costs.get_mut(index) {
            *place = cost;
        }
        true
    }
}
