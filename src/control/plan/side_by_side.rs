//! Plans side by side, with SIMD.

use alloc::vec::Vec;
use core::cell::{Cell, RefCell};

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

/// The search for a plan from a state.
struct Search<S, R> {
    start: State<S>,
    rng: R,
    tried: u32,
    found: Option<Found<S, R>>,
}

/// The first try of a search that succeeds.
struct Found<S, R> {
    /// How many tries of all searches began before it.
    index: usize,
    knots: Vec<Knot<S>>,
    /// The generator after its guess.
    rng: R,
}

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
        let search = Search { start, rng: rng.clone(), tried: LENGTHS, found: None };
        let [search] = self.search([search], tries, &mut guess, |_| true)?;
        *rng = search.rng;
        let found = search.found.ok_or(Error::NoPlan { tries })?;
        *rng = found.rng;
        Ok(Plan { knots: found.knots, after: *self.regulator().feedback() })
    }

    /// Plans from many states, 16 tries side by side. A plan is that of [`plan`](Self::plan) from
    /// its state with a clone of the generator, and `None` where that finds none. Before each pass
    /// over the knots `go_on` gets the number of states that have a plan, and says whether to
    /// continue: without that, states can be left without a plan.
    ///
    /// ```
    /// # use acrobot::control::plan::{Planner, Problem};
    /// # use acrobot::{Fast, Params, State, numpy::Pcg64};
    /// let problem = Problem::swing_up(Params { dt: 0.02, ..Params::DEFAULT }, 5.0)?; // N m
    /// let mut planner = Planner::<Fast>::new(&problem)?;
    /// let starts = [State::HANGING, State { theta1: 1.0, ..State::HANGING }]; // rad
    /// let plans = planner.plan_each(&starts, 64, &Pcg64::new(1), 250, |_| true)?;
    /// let second = planner.plan(starts[1], 64, &mut Pcg64::new(1), 250)?; // at most 5 s
    /// assert_eq!(plans[1], Some(second));
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] if a number of a state is not finite, and [`Error::OutOfMemory`].
    pub fn plan_each<R: Rng + Clone>(
        &mut self,
        starts: &[State<A::Scalar>],
        tries: u32,
        rng: &R,
        steps: usize,
        go_on: impl FnMut(usize) -> bool,
    ) -> Result<Vec<Option<Owned<A::Scalar>>>, Error> {
        starts.iter().try_for_each(State::validate)?;
        let search = |&start| Search { start, rng: rng.clone(), tried: 0, found: None };
        let searches: Vec<_> = starts.iter().map(search).collect();
        let searches = self.search(searches, tries, &mut memory(Knot::EMPTY, steps)?, go_on)?;
        let after = *self.regulator().feedback();
        let plan = |Found { knots, .. }| Plan { knots, after };
        Ok(searches.into_iter().map(|search| search.found.map(plan)).collect())
    }

    /// Searches side by side, with at most so many tries each. `guess` is memory for the longest.
    fn search<R: Rng + Clone, L: AsMut<[Search<A::Scalar, R>]>>(
        &mut self,
        mut all: L,
        tries: u32,
        guess: &mut [Knot<A::Scalar>],
        mut go_on: impl FnMut(usize) -> bool,
    ) -> Result<L, Error> {
        let steps = guess.len();
        let mut knots = memory(empty(), steps)?;
        let mut guesser = self.clone();
        let searches = RefCell::new(all.as_mut());
        // The search of each lane, and its generator after the guess.
        let begun = RefCell::new([const { None }; LANES]);
        let count = Cell::new(0);
        let next = |knots: &mut [Knot<Side<A::Scalar>>], lane: usize| {
            let mut searches = searches.borrow_mut();
            loop {
                let open = searches.iter_mut().enumerate();
                let open = open.filter(|(_, each)| each.found.is_none() && each.tried < tries);
                let (i, search) = open.min_by_key(|(_, each)| each.tried)?;
                let guess = guess.get_mut(..len_of_try(search.tried, steps))?;
                search.tried += 1;
                // Extreme parameters can make a guess overflow.
                if guesser.guess(search.start, &mut search.rng, guess).is_ok() {
                    set_plan(knots, lane, guess);
                    *begun.borrow_mut().get_mut(lane)? = Some((i, search.rng.clone()));
                    return Some((guess.len(), search.start));
                }
            }
        };
        let take = |Done { index, oldest, lane, knots, cost, end }: Done<'_, _, Side<_>>| {
            let mut searches = searches.borrow_mut();
            let begun = begun.borrow_mut().get_mut(lane).and_then(Option::take);
            if let Some((i, rng)) = begun
                && let Some(Search { found, .. }) = searches.get_mut(i)
                && found.as_ref().is_none_or(|found| index < found.index)
            {
                let mut knots: Vec<_> = knots.iter().map(|knot| knot.lane(lane)).collect();
                if self.is_success(cost, end, &mut knots) {
                    count.set(count.get() + usize::from(found.is_none()));
                    *found = Some(Found { index, knots, rng });
                }
            }
            // A try that began before may succeed, too.
            let is_before = |found: &Found<_, _>| oldest < found.index;
            searches.iter().any(|search| search.found.as_ref().is_none_or(is_before))
        };
        let (machine, lanes) = (self.machine(self.level), &mut [Try::new(); LANES]);
        let go_on = || go_on(count.get());
        tries::improve::<A, _, LANES>(machine, lanes, ITERATIONS, &mut knots, next, take, go_on);
        Ok(all)
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
        let go_on = || true;
        tries::improve::<A, _, LANES>(machine, lanes, iterations, &mut knots, next, take, go_on);
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
