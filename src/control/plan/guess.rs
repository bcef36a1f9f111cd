//! First guesses of plans: random torques, and more or less torque that pumps energy.

use rand_core::Rng;

use super::knots::Knot;
use super::planner::Planner;
use crate::arithmetic::Arithmetic;
use crate::control::regulator::step;
use crate::control::units::Units;
use crate::error::Error;
use crate::math::Real;
use crate::numpy::uniform;
use crate::physics::{State, saturate};

/// A guess holds a random torque for this time, in units of the machine.
const HOLD: f64 = 0.6;
/// The largest gain with which a guess pumps energy, in the same units.
const PUMP: f64 = 60.0;

impl<A: Arithmetic> Planner<A> {
    /// Fills a plan with a first guess: random torques, and more or less torque that pumps energy.
    ///
    /// ```
    /// # use acrobot::numpy::Pcg64;
    /// # use acrobot::control::plan::{Knot, Planner, Problem};
    /// # use acrobot::{Fast, Params, State};
    /// let problem = Problem::swing_up(Params { dt: 0.02, ..Params::DEFAULT }, 5.0)?; // N m
    /// let mut planner = Planner::<Fast>::new(&problem)?;
    /// let mut plan = [Knot::EMPTY; 100];
    /// planner.guess(State::HANGING, &mut Pcg64::new(1), &mut plan)?;
    /// assert!(plan.iter().all(|knot| knot.torque.abs() <= 5.0)); // N m
    /// planner.improve(State::HANGING, 150, &mut plan)?;
    /// # Ok::<(), acrobot::Error>(())
    /// ```
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
        let Units { time, torque, force } = self.units;
        let (most, hold) = (PUMP * (torque * time / force), HOLD * time);
        let gain: A::Scalar = number(most * strength * strength * strength);
        let noise = uniform(rng, 0.1, 0.75) * self.regulator.limit.to_f64();
        let (mut push, mut held) = (A::Scalar::ZERO, hold);
        let machine = &mut self.regulator.machine;
        machine.set_state(start)?;
        for knot in plan {
            if held >= hold {
                push = number(uniform(rng, -noise, noise));
                held = 0.0;
            }
            held += machine.params().dt.to_f64();
            let missing = self.energy - machine.energy();
            let state = machine.state();
            let torque = saturate(push + gain * missing * state.dtheta2, self.regulator.limit);
            step(machine, torque)?;
            *knot = Knot { state, ..Knot::open(torque) };
        }
        Ok(())
    }
}
