//! Iterative linear-quadratic regulation with a bounded torque.
//!
//! Y. Tassa, N. Mansard and E. Todorov, *Control-Limited Differential Dynamic Programming* (2014).
//! Each iteration linearizes the steps about the plan and, from the last step to the first, finds
//! the change of each torque that lowers the [cost](Cost), with the feedback that corrects
//! deviations. It finds the best plan near the first guess, so the guess decides. The guesses pump
//! energy.

use rand_core::Rng;

use super::cost::Weights;
use super::knots::{Knot, Plan};
use super::passes::Machine;
use super::problem::Problem;
use super::tries::{self, Try};
use crate::arithmetic::Arithmetic;
use crate::control::regulator::{BoundedRegulator, back_up, is_below};
use crate::control::units::Units;
use crate::error::Error;
use crate::math::matrix::{check_finite, spread};
use crate::math::{Real, SimdLevel};
use crate::physics::State;

/// A plan may take so many iterations.
pub(super) const ITERATIONS: u32 = 150;
/// Tries have one to so many parts of the most steps, in turn.
pub(super) const LENGTHS: u32 = 10;

/// The number of steps of a try.
pub(super) fn len_of_try(tried: u32, steps: usize) -> usize {
    steps * (1 + tried % LENGTHS) as usize / LENGTHS as usize
}

/// Plans motions of one machine to one target: [an
/// example](crate::guide::control#swing-up-by-a-plan).
///
/// No velocity of a plan reaches the bounds of the parameters, except [for a simulation that clamps
/// there](Self::with_velocity_clamp).
///
/// ```
/// use acrobot::control::plan::{Knot, Planner, Problem};
/// use acrobot::{Fast, Params, State, numpy::Pcg64};
///
/// let problem = Problem::swing_up(Params { dt: 0.02, ..Params::DEFAULT }, 5.0)?; // N m
/// let mut memory = [Knot::EMPTY; 250]; // 5 s
/// let mut planner = Planner::<Fast>::new(&problem)?;
/// let plan = planner.plan_into(State::HANGING, 64, &mut Pcg64::new(1), &mut memory)?;
/// assert!(plan.torque(0, State::HANGING).abs() <= 5.0); // N m
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Planner<A: Arithmetic> {
    pub(super) regulator: BoundedRegulator<A>,
    weights: Weights<A::Scalar>,
    /// The energy of the target, J.
    pub(super) energy: A::Scalar,
    pub(super) units: Units,
    pub(super) level: SimdLevel,
}

impl<A: Arithmetic> Planner<A> {
    /// Computes the regulator of a problem's target.
    ///
    /// # Errors
    ///
    /// The errors of [`BoundedRegulator::about`], and a weight is out of range.
    #[inline(never)] // saves flash
    pub fn new(problem: &Problem<A::Scalar>) -> Result<Self, Error> {
        problem.cost.check()?;
        let Problem { params, limit, target, torque, .. } = *problem;
        let regulator = BoundedRegulator::<A>::about(params, limit, target, torque)?;
        let units = Units::new(&problem.params, limit);
        Ok(Self {
            weights: Weights::new(&regulator, &problem.cost, units),
            units,
            energy: regulator.machine.energy(),
            regulator,
            level: SimdLevel::widest(),
        })
    }

    /// The same planner for a simulation that clamps velocities at the bounds of its parameters, as
    /// Gymnasium's does. Plans may use that as a brake.
    ///
    /// ```
    /// # use acrobot::control::plan::{Planner, Problem};
    /// # use acrobot::{Fast, Params, State};
    /// let params = Params { dt: 0.02, max_velocity2: 0.5, ..Params::DEFAULT }; // rad/s
    /// let mut planner = Planner::<Fast>::new(&Problem::swing_up(params, 10.0)?)?; // N m
    /// let leaning = State { theta1: 3.1, ..State::UPRIGHT }; // rad
    /// assert!(!planner.regulator().holds_from(leaning)); // link 2 would turn faster
    /// planner = planner.with_velocity_clamp();
    /// assert!(planner.regulator().holds_from(leaning));
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    #[must_use]
    pub fn with_velocity_clamp(mut self) -> Self {
        self.regulator = self.regulator.with_velocity_clamp();
        self.weights.bounds = self.regulator.bounds;
        self
    }

    /// Prepares for plans that are made again while the machine moves, and may end on the way: with
    /// a weight of the energy that is then missing or too much, 1/J². The motor overcomes the dry
    /// friction of its joint, so derivatives are those without it. With it they are those of an
    /// elbow that sticks, and wrong as soon as it slips.
    pub(in crate::control) fn set_replanning(&mut self, energy: A::Scalar) {
        (self.weights.by_energy, self.weights.replans) = (energy, true);
    }

    /// The regulator of the target, which says from which states it holds.
    #[must_use]
    pub fn regulator(&self) -> &BoundedRegulator<A> {
        &self.regulator
    }

    /// Plans from a state into memory of the caller, until a plan ends in a state from which the
    /// regulator holds. Tries have from a tenth of the knots to all of them. The plan is that of
    /// `plan`, which needs `alloc`, for the same generator.
    ///
    /// # Errors
    ///
    /// [`Error::NoPlan`] after so many tries, and [`Error::OutOfRange`] if a number of the state is
    /// not finite.
    #[expect(clippy::type_complexity)]
    pub fn plan_into<'m, R: Rng + ?Sized>(
        &mut self,
        start: State<A::Scalar>,
        tries: u32,
        rng: &mut R,
        memory: &'m mut [Knot<A::Scalar>],
    ) -> Result<Plan<A::Scalar, &'m mut [Knot<A::Scalar>]>, Error> {
        start.validate()?;
        let steps = memory.len();
        for tried in 0..tries {
            let len = len_of_try(tried, steps);
            let Some(plan) = memory.get_mut(..len) else { break };
            // Extreme parameters can make a guess overflow.
            if self.guess(start, rng, plan).is_ok() {
                let (cost, end) = self.improve_alone(start, ITERATIONS, plan);
                if self.is_success(cost, end, plan) {
                    let knots = memory.get_mut(..len).ok_or(Error::NoPlan { tries })?;
                    return Ok(Plan { knots, after: self.regulator.feedback });
                }
            }
        }
        Err(Error::NoPlan { tries })
    }

    /// Improves a plan by at most so many iterations. The plan then begins in the state `start`, so
    /// the rest of a plan can be planned again while the machine moves. Returns the cost of the
    /// plan: the lower, the better.
    ///
    /// ```
    /// # use acrobot::control::plan::{Knot, Planner, Problem};
    /// # use acrobot::{Fast, Params, State};
    /// let problem = Problem::swing_up(Params { dt: 0.02, ..Params::DEFAULT }, 5.0)?; // N m
    /// let mut planner = Planner::<Fast>::new(&problem)?;
    /// let mut plan = [Knot::open(0.0); 100]; // 2 s without a torque
    /// let before = planner.improve(State::HANGING, 0, &mut plan)?;
    /// // Measured meanwhile.
    /// let leaning = State { theta1: 0.1, ..State::HANGING };
    /// assert!(planner.improve(leaning, 10, &mut plan)? < before);
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// A number of the state or of the plan is not finite; then the plan stays as it was. Or they
    /// are so extreme that the cost or a derivative overflows; then the plan can be any, so improve
    /// a copy of one that a machine follows.
    pub fn improve(
        &mut self,
        start: State<A::Scalar>,
        iterations: u32,
        plan: &mut [Knot<A::Scalar>],
    ) -> Result<A::Scalar, Error> {
        start.validate()?;
        for knot in &*plan {
            knot.state.validate()?;
            check_finite("torque", &[knot.torque])?;
            check_finite("gain", &knot.gain)?;
        }
        let (cost, _) = self.improve_alone(start, iterations, plan);
        self.finish(cost, plan)
    }

    /// Checks the cost, and replaces the gains.
    pub(super) fn finish(
        &self,
        cost: A::Scalar,
        plan: &mut [Knot<A::Scalar>],
    ) -> Result<A::Scalar, Error> {
        match cost.is_finite() {
            true => self.track(plan).map(|()| cost),
            false => Err(Error::NotFinite { name: "cost", value: cost.to_f64() }),
        }
    }

    /// Returns the cost and the state after the plan.
    fn improve_alone(
        &self,
        start: State<A::Scalar>,
        iterations: u32,
        plan: &mut [Knot<A::Scalar>],
    ) -> (A::Scalar, State<A::Scalar>) {
        let (mut next, mut result) = (Some((plan.len(), start)), (A::Scalar::ZERO, start));
        tries::improve::<A, A::Scalar, 1>(
            self.machine(SimdLevel::Baseline),
            &mut [Try::new()],
            iterations,
            plan,
            |_, _| next.take(),
            |done| {
                result = (done.cost, done.end);
                false
            },
            || true,
        );
        result
    }

    pub(super) fn machine(&self, level: SimdLevel) -> Machine<'_, A> {
        Machine { regulator: &self.regulator, weights: &self.weights, level }
    }

    /// Whether a plan ends where the regulator holds, and no velocity reaches its bound. Replaces
    /// its gains.
    pub(super) fn is_success(
        &self,
        cost: A::Scalar,
        end: State<A::Scalar>,
        plan: &mut [Knot<A::Scalar>],
    ) -> bool {
        cost.is_finite()
            && self.regulator.holds_from(end)
            && plan.iter().all(|knot| is_below(knot.state, self.regulator.bounds))
            && self.track(plan).is_ok()
    }

    /// Replaces the gains by a regulator's along the plan, with the weights of the target's
    /// regulator. Torques at their bound get some, too.
    pub(super) fn track(&self, plan: &mut [Knot<A::Scalar>]) -> Result<(), Error> {
        let BoundedRegulator { machine, weights: (q, r), cost_to_go, .. } = &self.regulator;
        let (mut model, q, mut cost) = (machine.clone(), spread(*q), *cost_to_go);
        if self.weights.replans {
            model.remove_coulomb2();
        }
        for knot in plan.iter_mut().rev() {
            *knot = Knot { state: knot.state, ..Knot::open(knot.torque) };
            model.set_state(knot.state)?;
            // Of the equations, which the plan was found with: none is clamped.
            let model = model.linearize_free_step(knot.torque)?;
            knot.gain = back_up(&model, &q, *r, &mut cost)?;
        }
        Ok(())
    }

    /// Sets the SIMD instructions that plans side by side use: the widest by default.
    pub fn set_simd_level(&mut self, level: SimdLevel) {
        self.level = level;
    }
}
