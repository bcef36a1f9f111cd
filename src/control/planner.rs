//! Plans a swing-up and how to follow it: iterative linear-quadratic regulation with a bounded
//! torque.
//!
//! Y. Tassa, N. Mansard and E. Todorov, *Control-Limited Differential Dynamic Programming* (2014).
//! Each iteration linearizes the steps about the plan and, from the last step to the first, finds
//! the change of each torque that lowers the [cost](Cost), with the feedback that corrects
//! deviations. It finds the best plan near the first guess, so the guess decides. The guesses pump
//! energy.

#[cfg(feature = "alloc")]
mod search;

use core::mem::replace;

use super::cost::{Cost, Weights};
use super::deviation::difference;
use super::error::ControlError;
use super::linearize::LinearModel;
use super::linearize_step::linearize_step;
use super::matrix::{check_finite, dot, spread, transpose};
use super::passes::Machine;
use super::plan::{Knot, NoPlan};
use super::recovery::{Recovery, is_below, is_near};
use super::tries::{self, Try};
use super::units::Units;
use crate::arithmetic::Arithmetic;
use crate::error::{Error, Range};
use crate::math::sealed::Sealed as _;
use crate::math::{Real, SimdLevel};
use crate::numpy::uniform;
use crate::physics::{Params, Pendulum, State, plus_scaled, saturate};
use rand_core::Rng;

/// A plan may take so many iterations.
const ITERATIONS: u32 = 150;

/// A guess holds a random torque for this time, in units of the machine.
const HOLD: f64 = 0.6;
/// The largest gain with which a guess pumps energy, and that without a plan, in the same units.
const PUMP: f64 = 60.0;
const STEADY_PUMP: f64 = 2.0;

/// Plans swing-ups for one machine: [an example](crate::guide::control#swing-up-by-a-plan).
///
/// No velocity of a plan reaches the bounds of the parameters, except [for a simulation that clamps
/// there](Self::for_simulation).
#[derive(Clone, Debug)]
pub struct Planner<A: Arithmetic> {
    model: Pendulum<A>,
    recovery: Recovery<A::Scalar>,
    weights: Weights<A::Scalar>,
    /// The energy of standing upright, J.
    upright: A::Scalar,
    /// How long a guess holds a torque, s.
    hold: f64,
    /// The gain that pumps energy, s/rad: a unit of the machine.
    pump: f64,
    is_holding: bool,
    level: SimdLevel,
}

impl<A: Arithmetic> Planner<A> {
    /// Computes the regulator of a machine with these parameters, whose `dt` is the time between
    /// two decisions, and a largest torque, N m.
    ///
    /// # Errors
    ///
    /// A parameter is out of range, the torque is not finite and above 0, there is no regulator, or
    /// `dt` is so short that the scalar loses small velocities upright.
    pub fn new(params: Params<A::Scalar>, limit: A::Scalar) -> Result<Self, ControlError> {
        Self::with_cost(params, limit, Cost::new(&params, limit)?)
    }

    /// As [`new`](Self::new), with the weights of what a plan costs.
    ///
    /// # Errors
    ///
    /// Those of `new`, and a weight is out of range.
    #[inline(never)] // saves flash
    pub fn with_cost(
        mut params: Params<A::Scalar>,
        limit: A::Scalar,
        cost: Cost<A::Scalar>,
    ) -> Result<Self, ControlError> {
        params.validate()?;
        let infinity = A::Scalar::from_f64(f64::INFINITY);
        let bounds = [&mut params.max_velocity1, &mut params.max_velocity2];
        let bounds = bounds.map(|bound| replace(bound, infinity));
        let recovery = Recovery::new::<A>(params, limit)?;
        cost.check()?;
        let units = Units::new(&params, limit);
        let model = Pendulum::new(params, State::UPRIGHT)?;
        Ok(Self {
            recovery,
            weights: Weights::new(cost, params.dt, bounds, units),
            hold: HOLD * units.time,
            pump: units.torque * units.time / units.force,
            upright: model.energy(),
            model,
            is_holding: false,
            level: SimdLevel::widest(),
        })
    }

    /// The same planner for a simulation that clamps velocities at the bounds of its parameters, as
    /// Gymnasium's does. Plans may use that as a brake.
    #[must_use]
    pub fn for_simulation(mut self) -> Self {
        let infinity = A::Scalar::from_f64(f64::INFINITY);
        let [bound1, bound2] = replace(&mut self.weights.bounds, [infinity; 2]);
        let mut params = *self.model.params();
        // The second time there are no bounds to take over.
        let least = |x, y| if x < y { x } else { y };
        params.max_velocity1 = least(params.max_velocity1, bound1);
        params.max_velocity2 = least(params.max_velocity2, bound2);
        self.model = Pendulum::new_unchecked(params, State::UPRIGHT);
        self
    }

    /// Plans from a state into memory of the caller, until a plan ends in a state from which the
    /// regulator holds. Returns this plan, which is the first part of the memory: the tries take
    /// one to ten tenths of it in turn.
    ///
    /// # Errors
    ///
    /// [`NoPlan::NotFound`] after so many tries, and [`NoPlan::Invalid`] if a number of the state
    /// is not finite.
    pub fn plan<'m, R: Rng + ?Sized>(
        &mut self,
        start: State<A::Scalar>,
        tries: u32,
        rng: &mut R,
        memory: &'m mut [Knot<A::Scalar>],
    ) -> Result<&'m mut [Knot<A::Scalar>], NoPlan> {
        start.validate()?;
        for parts in (1..=10).cycle().take(tries as usize) {
            let len = memory.len() * parts / 10;
            let Some(plan) = memory.get_mut(..len) else {
                break;
            };
            // Extreme parameters can make a guess overflow.
            if self.guess(start, rng, plan).is_ok() {
                let (cost, end) = self.improve_alone(start, ITERATIONS, plan);
                if cost.is_finite() && self.is_success(plan, end) && self.track(plan).is_ok() {
                    return memory.get_mut(..len).ok_or(NoPlan::NotFound { tries });
                }
            }
        }
        Err(NoPlan::NotFound { tries })
    }

    /// Fills a plan with a first guess: random torques, and more or less torque that pumps energy.
    ///
    /// # Errors
    ///
    /// A number of the state is not finite, or extreme parameters make a torque overflow.
    pub fn guess<R: Rng + ?Sized>(
        &mut self,
        start: State<A::Scalar>,
        rng: &mut R,
        plan: &mut [Knot<A::Scalar>],
    ) -> Result<(), Error> {
        let number = A::Scalar::from_f64;
        let strength = uniform(rng, 0.0, 1.0);
        let most = PUMP * self.pump;
        let gain: A::Scalar = number(most * strength * strength * strength);
        let noise = uniform(rng, 0.1, 0.75) * self.recovery.limit.to_f64();
        let (mut push, mut held) = (A::Scalar::ZERO, self.hold);
        self.model.set_state(start)?;
        for knot in plan {
            if held >= self.hold {
                push = number(uniform(rng, -noise, noise));
                held = 0.0;
            }
            held += self.model.params().dt.to_f64();
            let missing = self.upright - self.model.energy();
            let state = self.model.state();
            let torque = saturate(push + gain * missing * state.dtheta2, self.recovery.limit);
            self.model.step(torque)?;
            *knot = Knot { state, ..Knot::open(torque) };
        }
        Ok(())
    }

    /// Improves a plan by at most so many iterations. The plan then begins in the state `start`, so
    /// the rest of a plan can be planned again while the machine moves. Returns the cost of the
    /// plan: the lower, the better.
    ///
    /// # Errors
    ///
    /// A number of the state or of the plan is not finite, or they are so extreme that the cost or
    /// a derivative overflows.
    pub fn improve(
        &mut self,
        start: State<A::Scalar>,
        iterations: u32,
        plan: &mut [Knot<A::Scalar>],
    ) -> Result<A::Scalar, ControlError> {
        start.validate()?;
        let (cost, _) = self.improve_alone(start, iterations, plan);
        self.finish(cost, plan)
    }

    /// Checks the cost, and replaces the gains.
    fn finish(
        &self,
        cost: A::Scalar,
        plan: &mut [Knot<A::Scalar>],
    ) -> Result<A::Scalar, ControlError> {
        match cost.is_finite() {
            true => self.track(plan).map(|()| cost),
            false => Err(ControlError::NotFinite { name: "cost", value: cost.to_f64() }),
        }
    }

    /// Returns the cost and the state after the plan.
    fn improve_alone(
        &self,
        start: State<A::Scalar>,
        iterations: u32,
        plan: &mut [Knot<A::Scalar>],
    ) -> (A::Scalar, State<A::Scalar>) {
        let (mut len, mut result) = (Some(plan.len()), (A::Scalar::ZERO, start));
        tries::improve::<A, A::Scalar, 1>(
            self.machine(SimdLevel::Baseline),
            &mut [Try::new()],
            start,
            iterations,
            plan,
            |_, _| len.take(),
            |_, _, _, cost, end| {
                result = (cost, end);
                false
            },
        );
        result
    }

    fn machine(&self, level: SimdLevel) -> Machine<'_, A> {
        let Self { model, recovery, weights, .. } = self;
        Machine { model: model.model(), recovery, weights, level }
    }

    /// Whether a plan ends where the regulator succeeds, and no velocity reaches its bound.
    fn is_success(&self, plan: &[Knot<A::Scalar>], end: State<A::Scalar>) -> bool {
        self.catches(end) && plan.iter().all(|knot| is_below(knot.state, self.weights.bounds))
    }

    /// Replaces the gains by those of a regulator along the plan, with the weights of the one
    /// upright. Torques at their bound get some, too.
    fn track(&self, plan: &mut [Knot<A::Scalar>]) -> Result<(), ControlError> {
        let one = A::Scalar::ONE;
        let (weights, torque_weight) = self.recovery.weights;
        let (mut cost, mut model) = (self.recovery.cost_to_go, self.model.clone());
        for knot in plan.iter_mut().rev() {
            *knot = Knot { state: knot.state, ..Knot::open(knot.torque) };
            model.set_state(knot.state)?;
            let LinearModel { a, b } = linearize_step(&model, knot.torque)?;
            let cost_b = cost.map(|row| dot(row, b));
            let divisor = dot(b, cost_b) + torque_weight;
            let mut columns = transpose(&a);
            knot.gain = columns.map(|column| -(dot(column, cost_b) / divisor));
            // Those of A + B K.
            for (column, k) in columns.iter_mut().zip(knot.gain) {
                *column = plus_scaled(*column, k, b);
            }
            let curved = columns.map(|column| cost.map(|row| dot(row, column)));
            cost = columns.map(|column| curved.map(|curved| dot(column, curved)));
            for ((row, own), k) in cost.iter_mut().zip(spread(weights)).zip(knot.gain) {
                *row = plus_scaled(plus_scaled(*row, one, own), torque_weight * k, knot.gain);
            }
            check_finite("gain", &knot.gain)?;
        }
        Ok(())
    }

    /// The torque at a decision, N m: that of the plan's knot, and after the plan that of the
    /// regulator. `saturate` limits it, as in [`Knot::follow`].
    #[must_use]
    pub fn follow(
        &self,
        plan: &[Knot<A::Scalar>],
        step: usize,
        state: State<A::Scalar>,
    ) -> A::Scalar {
        match plan.get(step) {
            Some(knot) => knot.follow(state),
            None => self.recovery.torque(difference(state, State::UPRIGHT)),
        }
    }

    /// The torque without a plan, N m, at most the largest: that of the regulator from a state on
    /// in which it succeeds, before that a torque that pumps energy. It computes less than a plan,
    /// and succeeds later: the acrobot swings chaotically until it is in such a state.
    ///
    /// # Errors
    ///
    /// A number of the state is not finite, or the state is so extreme that the torque overflows.
    pub fn decide(&mut self, state: State<A::Scalar>) -> Result<A::Scalar, Error> {
        self.model.set_state(state)?;
        let x = difference(state, State::UPRIGHT);
        self.is_holding = is_near(x) && (self.is_holding || self.catches(state));
        let torque = match self.is_holding {
            true => self.recovery.torque(x),
            // It adds energy while it has the sign of θ̇2, and in the faster mode of swinging this
            // is opposite to that of θ̇1.
            false => {
                let gain = A::Scalar::from_f64(-STEADY_PUMP * self.pump);
                gain * (self.upright - self.model.energy()) * state.dtheta1
            }
        };
        let torque = saturate(torque, self.recovery.limit);
        Range::Finite.check("torque", torque.to_f64(), "N m")?;
        Ok(torque)
    }

    /// Whether the regulator succeeds from a state.
    #[must_use]
    pub fn catches(&self, state: State<A::Scalar>) -> bool {
        self.recovery.succeeds::<A>(self.model.params(), state, self.weights.bounds)
    }

    /// Sets the SIMD instructions that plans side by side use: the widest by default.
    pub fn set_simd_level(&mut self, level: SimdLevel) {
        self.level = level;
    }
}
