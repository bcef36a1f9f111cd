//! Plans a swing-up and how to follow it: iterative linear-quadratic regulation with a bounded
//! torque.
//!
//! Y. Tassa, N. Mansard and E. Todorov, *Control-Limited Differential Dynamic Programming* (2014).
//! A plan costs the square of its torques, the tip's distance from upright, and what the regulator
//! would pay at its end. Each iteration linearizes the steps about the plan and, from the last step
//! to the first, finds the change of each torque that lowers the cost, with the feedback that
//! corrects deviations. It finds the best plan near the first guess, so the guess decides. The
//! guesses pump energy.

use core::f64::consts::LN_10;

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::control::{ControlError, LinearModel, difference, linearize_step};
use acrobot::numpy::uniform;
use acrobot::physics::{Pendulum, State, saturate};
use acrobot::rand_core::Rng;
use acrobot::{Error, Params};

use crate::plan::{NoPlan, Step};
use crate::recovery::Recovery;
use crate::{dot, identity, plus};

/// What a torque of 1 N m costs in a step, what a step far from upright costs, and what the
/// logarithm of the regulator's cost at the end, beyond `NEAR`, costs.
const EFFORT: f64 = 1e-3;
const AWAY: f64 = 0.02;
const ARRIVAL: f64 = 20.0;
const NEAR: f64 = 20.0;

/// An iteration counts as stalled if it lowers the cost by less than this part, or not at all. So
/// many in succession end the search.
const LITTLE: f64 = 1e-3;
const STALLED: u32 = 12;
/// A change of the torques is tried at its full size, then at half of it, and so on.
const HALVINGS: u32 = 10;
/// A plan may take so many iterations.
const ITERATIONS: u32 = 150;

/// The first damping: it is added to the curvature of the cost by a torque.
const DAMPING: f64 = 1e-3;

/// The most steps of a simulation of the regulator.
const STEPS_AHEAD: u32 = 2000;

/// A guess holds a random torque for this time, s.
const HOLD: f64 = 0.25;
/// The largest gain with which a guess pumps energy, s/rad.
const PUMP: f64 = 3.0;

/// Plans swing-ups for one machine.
#[derive(Clone, Debug)]
pub struct Planner<A: Arithmetic> {
    model: Pendulum<A>,
    recovery: Recovery<A::Scalar>,
    /// The energy of standing upright, J.
    upright: A::Scalar,
}

impl<A: Arithmetic> Planner<A> {
    /// Computes the regulator of a machine with these parameters, whose `dt` is the time between
    /// two decisions, and a largest torque, N m.
    ///
    /// # Errors
    ///
    /// A parameter is out of range, the torque is not finite and above 0, or the gains overflow.
    pub fn new(params: Params<A::Scalar>, limit: A::Scalar) -> Result<Self, ControlError> {
        let recovery = Recovery::new::<A>(params, limit)?;
        let model = Pendulum::new(params, State::UPRIGHT)?;
        Ok(Self { recovery, upright: model.energy(), model })
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
        memory: &'m mut [Step<A::Scalar>],
    ) -> Result<&'m mut [Step<A::Scalar>], NoPlan> {
        start.validate()?;
        for parts in (1..=10).cycle().take(tries as usize) {
            let len = memory.len() * parts / 10;
            let Some(plan) = memory.get_mut(..len) else {
                break;
            };
            // Extreme parameters can make a guess overflow.
            let guessed = self.guess(start, rng, plan);
            if guessed.is_ok()
                && self.improve(start, ITERATIONS, plan).is_ok()
                && self.catches(self.model.state())
            {
                return memory.get_mut(..len).ok_or(NoPlan::NotFound { tries });
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
        plan: &mut [Step<A::Scalar>],
    ) -> Result<(), Error> {
        let strength = uniform(rng, 0.0, 1.0);
        let gain: A::Scalar = number(PUMP * strength * strength * strength);
        let noise = uniform(rng, 0.1, 0.75) * self.recovery.limit.to_f64();
        let (mut push, mut held) = (A::Scalar::ZERO, HOLD);
        self.model.set_state(start)?;
        for step in plan {
            if held >= HOLD {
                push = number(uniform(rng, -noise, noise));
                held = 0.0;
            }
            held += self.model.params().dt.to_f64();
            let missing = self.upright - self.model.energy();
            let state = self.model.state();
            let torque = saturate(push + gain * missing * state.dtheta2, self.recovery.limit);
            self.model.step(torque)?;
            *step = Step { state, torque, ..Step::EMPTY };
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
        plan: &mut [Step<A::Scalar>],
    ) -> Result<A::Scalar, ControlError> {
        let mut cost = finite(self.roll_out(start, plan, A::Scalar::ZERO, true)?)?;
        let (mut damping, mut stalled) = (DAMPING, 0);
        for _ in 0..iterations {
            let changed = self.look_back(plan, number(damping));
            let lower = changed.and_then(|()| self.search(start, plan, cost));
            let is_little = lower.is_none_or(|lower| cost - lower < cost * number(LITTLE));
            stalled = if is_little { stalled + 1 } else { 0 };
            if stalled > STALLED {
                break;
            }
            (cost, damping) = match lower {
                Some(lower) => (lower, damping / 2.0),
                None => (cost, damping * 8.0),
            };
        }
        self.track(plan)?;
        finite(self.roll_out(start, plan, A::Scalar::ZERO, false)?)
    }

    /// Replaces the gains by those of a regulator along the plan, with the weights of the one
    /// upright. Torques at their bound get some, too.
    fn track(&mut self, plan: &mut [Step<A::Scalar>]) -> Result<(), ControlError> {
        let one = A::Scalar::from_f64(1.0);
        let mut cost = self.recovery.regulator.cost_to_go;
        for step in plan.iter_mut().rev() {
            self.model.set_state(step.state)?;
            let LinearModel { a, b } = linearize_step(&self.model, step.torque)?;
            let cost_b = cost.map(|row| dot(row, b));
            let divisor = dot(b, cost_b) + one;
            let mut columns = transpose(a);
            step.gain = columns.map(|column| -(dot(column, cost_b) / divisor));
            // Those of A + B K.
            for (column, k) in columns.iter_mut().zip(step.gain) {
                *column = plus(*column, k, b);
            }
            let curved = columns.map(|column| cost.map(|row| dot(row, column)));
            cost = columns.map(|column| curved.map(|curved| dot(column, curved)));
            for ((row, weights), k) in cost.iter_mut().zip(identity()).zip(step.gain) {
                *row = plus(plus(*row, one, weights), k, step.gain);
            }
        }
        Ok(())
    }

    /// The torque at a decision, N m: that of the plan's step, and after the plan that of the
    /// regulator. `saturate` limits it, as in [`Step::follow`].
    #[must_use]
    pub fn follow(
        &self,
        plan: &[Step<A::Scalar>],
        step: usize,
        state: State<A::Scalar>,
    ) -> A::Scalar {
        match plan.get(step) {
            Some(step) => step.follow(state),
            None => self.recovery.regulator.torque(difference(state, State::UPRIGHT)),
        }
    }

    /// Whether the regulator succeeds from a state.
    #[must_use]
    pub fn catches(&self, state: State<A::Scalar>) -> bool {
        let mut model = self.model.clone();
        model.set_state(state).is_ok() && self.recovery.succeeds(model, STEPS_AHEAD)
    }

    /// Changes the plan by the largest part of the change that lowers the cost, which it returns.
    fn search(
        &mut self,
        start: State<A::Scalar>,
        plan: &mut [Step<A::Scalar>],
        cost: A::Scalar,
    ) -> Option<A::Scalar> {
        let most = cost - cost * number(1e-6);
        let mut part = number(1.0);
        for _ in 0..HALVINGS {
            match self.roll_out(start, plan, part, false) {
                Ok(lower) if lower < most => return self.roll_out(start, plan, part, true).ok(),
                _ => part = part * number(0.5),
            }
        }
        None
    }

    /// Simulates the plan with a part of the change and with the feedback. Returns the cost.
    fn roll_out(
        &mut self,
        start: State<A::Scalar>,
        plan: &mut [Step<A::Scalar>],
        part: A::Scalar,
        keep: bool,
    ) -> Result<A::Scalar, Error> {
        self.model.set_state(start)?;
        let mut cost = A::Scalar::ZERO;
        for step in plan {
            let state = self.model.state();
            let feedback = dot(step.gain, difference(state, step.state));
            let torque = saturate(step.torque + part * step.change + feedback, self.recovery.limit);
            cost = cost + self.away().0 + torque * torque * number(EFFORT);
            self.model.step(torque)?;
            if keep {
                (step.state, step.torque) = (state, torque);
            }
        }
        let x = difference(self.model.state(), State::UPRIGHT);
        let to_go = self.recovery.cost(x).to_f64();
        Ok(cost + number(ARRIVAL * libm::log1p(to_go / NEAR)))
    }

    /// Finds the change of each torque and its gain, from the last step to the first. None if the
    /// damping is too small for a minimum.
    fn look_back(&mut self, plan: &mut [Step<A::Scalar>], damping: A::Scalar) -> Option<()> {
        let last = plan.last()?;
        self.model.set_state(last.state).ok()?;
        self.model.step(last.torque).ok()?;
        // The slope and the curvature of the cost from here on. Where the logarithm is concave, the
        // curvature is that without it.
        let x = difference(self.model.state(), State::UPRIGHT);
        let p_x = self.recovery.regulator.cost_to_go.map(|row| dot(row, x));
        let weight = A::Scalar::from_f64(2.0 * ARRIVAL) / (dot(p_x, x) + number(NEAR));
        let mut slope = p_x.map(|x| x * weight);
        let mut curvature = self.recovery.regulator.cost_to_go.map(|row| row.map(|x| x * weight));
        for step in plan.iter_mut().rev() {
            self.model.set_state(step.state).ok()?;
            let LinearModel { a, b } = linearize_step(&self.model, step.torque).ok()?;
            let columns = transpose(a);
            let curved_b = curvature.map(|row| dot(row, b));
            // The derivatives of the cost by the torque, by the state, and by both.
            let by_torque = dot(b, slope) + step.torque * number(2.0 * EFFORT);
            let by_torque2 = dot(b, curved_b) + number(2.0 * EFFORT);
            let by_state = columns.map(|column| dot(column, slope));
            let by_both = columns.map(|column| dot(column, curved_b));
            let divisor = by_torque2 + damping;
            if divisor < number(1e-12) {
                return None;
            }
            let wanted = step.torque - by_torque / divisor;
            let torque = saturate(wanted, self.recovery.limit);
            step.change = torque - step.torque;
            // A torque at its bound has no feedback.
            step.gain = match torque == wanted {
                true => by_both.map(|x| -(x / divisor)),
                false => [A::Scalar::ZERO; 4],
            };

            // Aᵀ P A is symmetric, but its rounding is not, and would grow.
            let curved = columns.map(|column| curvature.map(|row| dot(row, column)));
            curvature = columns.map(|column| curved.map(|curved| dot(column, curved)));
            let (change, gain) = (step.change, step.gain);
            let by_gain = plus(by_both, by_torque2, gain);
            for ((row, k), both) in curvature.iter_mut().zip(gain).zip(by_both) {
                *row = plus(plus(*row, k, by_gain), both, gain);
            }
            let (half, transposed) = (number(0.5), transpose(curvature));
            for (row, column) in curvature.iter_mut().zip(transposed) {
                *row = plus(row.map(|x| x * half), half, column);
            }
            let rest = by_torque2 * change + by_torque;
            slope = plus(plus(by_state, rest, gain), change, by_both);
            slope = plus(slope, number(1.0), self.away().1);
        }
        Some(())
    }

    /// What a step from the model's state costs because the tip is not upright, and the slope of
    /// this: nearly 1 − 0.1^(d²) at d m from the edge of a circle of 0.2 m about the upright tip,
    /// if the links have 1 m each. That is dm_control's reward, with (1 + x / 16)¹⁶ for e^x.
    fn away(&self) -> (A::Scalar, [A::Scalar; 4]) {
        let one = A::Scalar::from_f64(1.0);
        let [[elbow_x, elbow_y], [x, y]] = self.model.positions();
        let params = self.model.params();
        let height = params.length1 + params.length2;
        let below = height - y;
        let distance = (x * x + below * below).sqrt();
        let beyond = (distance - height * number(0.1)) / height;
        if beyond < A::Scalar::ZERO {
            return (A::Scalar::ZERO, [A::Scalar::ZERO; 4]);
        }
        let base = one + beyond * beyond * number(4.0 * LN_10 / 16.0);
        let near = (0..4).fold(one / base, |power, _| power * power);
        let slope = near / base * beyond * number(AWAY * 8.0 * LN_10) / (distance * height);
        let by_theta1 = -(slope * height * x);
        let by_theta2 = slope * (x * (elbow_y - y) - below * (x - elbow_x));
        let zero = A::Scalar::ZERO;
        ((one - near) * number(AWAY), [by_theta1, by_theta2, zero, zero])
    }
}

fn finite<S: Real>(cost: S) -> Result<S, ControlError> {
    match cost.is_finite() {
        true => Ok(cost),
        false => Err(ControlError::NotFinite { name: "cost", value: cost.to_f64() }),
    }
}

fn number<S: Real>(x: f64) -> S {
    S::from_f64(x)
}

fn transpose<S: Real>([p, q, r, s]: [[S; 4]; 4]) -> [[S; 4]; 4] {
    [
        [p[0], q[0], r[0], s[0]],
        [p[1], q[1], r[1], s[1]],
        [p[2], q[2], r[2], s[2]],
        [p[3], q[3], r[3], s[3]],
    ]
}
