//! Plans side by side, with SIMD.

use alloc::vec::Vec;
use core::cell::RefCell;

use rand_core::Rng;

use super::knots::{Knot, Plan};
use super::planner::{ITERATIONS, LENGTHS, Planner, len_of_try};
use super::tries::{self, Done, Try};
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::math::{Lanes, Numbers as _, Real};
use crate::physics::State;

/// Plans side by side.
const LANES: usize = 16;

type Side<S> = Lanes<S, LANES>;

/// A plan that owns its knots.
type Owned<S> = Plan<S, Vec<Knot<S>>>;

impl<A: Arithmetic> Planner<A> {
    /// Plans from a state, with at most so many steps, and 16 tries side by side after the first
    /// ten. It returns the plan of [`plan_into`](Self::plan_into), leaves the generator as that
    /// does, and has the same bits at each [level of SIMD](Self::set_simd_level).
    ///
    /// ```
    /// # use acrobot::batch::SimdLevel;
    /// # use acrobot::control::plan::{Planner, Problem};
    /// # use acrobot::{Fast, Params, State, numpy::Pcg64};
    /// let problem = Problem::swing_up(Params { dt: 0.02, ..Params::DEFAULT }, 5.0)?; // N m
    /// let mut planner = Planner::<Fast>::new(&problem)?;
    /// let plan = planner.plan(State::HANGING, 64, &mut Pcg64::new(1), 250)?; // at most 5 s
    /// planner.set_simd_level(SimdLevel::Baseline);
    /// assert_eq!(planner.plan(State::HANGING, 64, &mut Pcg64::new(1), 250)?, plan);
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of `plan_into`, and [`Error::OutOfMemory`] for too many steps.
    pub fn plan<R: Rng + Clone>(
        &mut self,
        start: State<A::Scalar>,
        tries: u32,
        rng: &mut R,
        steps: usize,
    ) -> Result<Owned<A::Scalar>, Error> {
        // The first tries are alone: if one of them succeeds, that costs less.
        let mut guess = memory(Knot::EMPTY, steps)?;
        match self.plan_into(start, tries.min(LENGTHS), rng, &mut guess) {
            Ok(Plan { knots, after }) => {
                let len = knots.len();
                guess.truncate(len);
                return Ok(Plan { knots: guess, after });
            }
            Err(Error::NoPlan { .. }) => {}
            Err(error) => return Err(error),
        }
        let mut knots = memory(empty(), steps)?;
        let mut guesser = self.clone();
        let mut tried = LENGTHS;
        // The first try that succeeds, and the generators after the guess of each lane.
        let found = RefCell::new((usize::MAX, None));
        let after = RefCell::new([const { None }; LANES]);
        let next = |knots: &mut [Knot<Side<A::Scalar>>], lane: usize| {
            while tried < tries && found.borrow().1.is_none() {
                let guess = guess.get_mut(..len_of_try(tried, steps))?;
                tried += 1;
                // Extreme parameters can make a guess overflow.
                if guesser.guess(start, rng, guess).is_ok() {
                    set_plan(knots, lane, guess);
                    *after.borrow_mut().get_mut(lane)? = Some(rng.clone());
                    return Some((guess.len(), start));
                }
            }
            None
        };
        let take = |Done { index, oldest, lane, knots, cost, end }: Done<'_, _, Side<_>>| {
            let (first, plan) = &mut *found.borrow_mut();
            if index < *first {
                let mut knots: Vec<_> = knots.iter().map(|knot| knot.lane(lane)).collect();
                if self.is_success(cost, end, &mut knots) {
                    let rng = after.borrow_mut().get_mut(lane).and_then(Option::take);
                    (*first, *plan) = (index, Some((knots, rng)));
                }
            }
            // A try that began before may succeed, too.
            oldest < *first
        };
        let (machine, lanes) = (self.machine(self.level), &mut [Try::new(); LANES]);
        tries::improve::<A, _, LANES>(machine, lanes, ITERATIONS, &mut knots, next, take);
        let (knots, after) = found.into_inner().1.ok_or(Error::NoPlan { tries })?;
        after.into_iter().for_each(|after| *rng = after);
        Ok(Plan { knots, after: *self.regulator().feedback() })
    }

    /// [Improves](Self::improve) plans side by side, each from its own state. Returns their costs,
    /// which are infinite where the numbers overflow.
    ///
    /// ```
    /// # use acrobot::control::plan::{Knot, Planner, Problem};
    /// # use acrobot::{Fast, Params, State};
    /// let problem = Problem::swing_up(Params { dt: 0.02, ..Params::DEFAULT }, 5.0)?; // N m
    /// let mut planner = Planner::<Fast>::new(&problem)?;
    /// let mut plans = [[Knot::EMPTY; 100]; 2];
    /// let starts = [State::HANGING, State { theta1: 1.0, ..State::HANGING }]; // rad
    /// let costs = planner.improve_each(&starts, 10, &mut plans)?;
    /// assert!(costs[1] < costs[0]);
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] for other than one state for each plan, [`Error::OutOfRange`] if a
    /// number of a state is not finite, and [`Error::OutOfMemory`].
    pub fn improve_each<P: AsMut<[Knot<A::Scalar>]>>(
        &mut self,
        starts: &[State<A::Scalar>],
        iterations: u32,
        plans: &mut [P],
    ) -> Result<Vec<A::Scalar>, Error> {
        let (len, expected) = (starts.len(), plans.len());
        if len != expected {
            return Err(Error::WrongLength { name: "starts", len, expected });
        }
        starts.iter().try_for_each(State::validate)?;
        let infinity = A::Scalar::from_f64(f64::INFINITY);
        let mut plans: Vec<_> = plans.iter_mut().map(AsMut::as_mut).collect();
        let longest = plans.iter().map(|plan| plan.len()).max().unwrap_or(0);
        let mut knots = memory(empty(), longest)?;
        let mut costs = memory(infinity, len)?;
        let plans = RefCell::new(&mut *plans);
        let mut starts = starts.iter().enumerate();
        let next = |knots: &mut [Knot<Side<A::Scalar>>], lane| {
            let (i, start) = starts.next()?;
            let plans = plans.borrow();
            let plan = plans.get(i)?;
            set_plan(knots, lane, plan);
            Some((plan.len(), *start))
        };
        let take = |Done { index, lane, knots, cost, .. }: Done<'_, _, Side<_>>| {
            if let (Some(plan), Some(place)) =
                (plans.borrow_mut().get_mut(index), costs.get_mut(index))
            {
                let places = plan.iter_mut().zip(knots);
                places.for_each(|(place, knot)| *place = knot.lane::<A::Scalar>(lane));
                *place = self.finish(cost, plan).unwrap_or(infinity);
            }
            true
        };
        let (machine, lanes) = (self.machine(self.level), &mut [Try::new(); LANES]);
        tries::improve::<A, _, LANES>(machine, lanes, iterations, &mut knots, next, take);
        Ok(costs)
    }
}

/// Memory for so many knots.
fn memory<T: Clone>(empty: T, len: usize) -> Result<Vec<T>, Error> {
    let mut memory = Vec::new();
    let reserved = memory.try_reserve_exact(len);
    reserved.map_err(|_| Error::OutOfMemory { of: "knots", len })?;
    memory.resize(len, empty);
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
