//! Swings up without a plan: pumps energy, and then holds.

use crate::arithmetic::Arithmetic;
use crate::control::regulator::{BoundedRegulator, is_near};
use crate::control::units::Units;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::physics::{Params, State, saturate};

/// The gain that pumps energy, in units of the machine.
const PUMP: f64 = 2.0;

/// Swings a machine up without a plan. It needs less memory and time than a planner, and succeeds
/// later: the acrobot swings chaotically until it is in a state from which the regulator holds.
///
/// ```
/// # use acrobot::control::plan::SwingUp;
/// # use acrobot::physics::Pendulum;
/// # use acrobot::{Params, Portable, State};
/// let params = Params { dt: 0.02, ..Params::DEFAULT };
/// let mut swing_up = SwingUp::<Portable>::new(params, 10.0)?; // N m
/// let mut machine = Pendulum::<Portable>::new(params, State { theta1: 0.1, ..State::HANGING })?;
/// for _ in 0..5000 {
///     machine.step(swing_up.torque(machine.state())?)?;
/// }
/// let [theta1, ..] = machine.state().deviation_from(State::UPRIGHT);
/// assert!(theta1.abs() < 1e-3); // rad
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SwingUp<A: Arithmetic> {
    regulator: BoundedRegulator<A>,
    /// The energy of standing upright, J.
    energy: A::Scalar,
    /// The gain that pumps energy, s/rad.
    pump: A::Scalar,
    /// Whether the regulator holds. Otherwise energy is pumped.
    pub is_holding: bool,
}

impl<A: Arithmetic> SwingUp<A> {
    /// Computes the regulator of a machine with these parameters, whose `dt` is the time between
    /// two decisions, and a largest torque, N m.
    ///
    /// # Errors
    ///
    /// The errors of [`BoundedRegulator::new`].
    pub fn new(params: Params<A::Scalar>, limit: A::Scalar) -> Result<Self, Error> {
        let regulator = BoundedRegulator::<A>::new(params, limit)?;
        let Units { time, torque, force } = Units::new(&params, limit);
        let energy = regulator.machine.energy();
        let pump = A::Scalar::from_f64(-PUMP * (torque * time / force));
        Ok(Self { regulator, energy, pump, is_holding: false })
    }

    /// The torque at a state, N m, at most the largest. It pumps energy until the regulator holds
    /// from the state, and then regulates.
    ///
    /// # Errors
    ///
    /// A number of the state is not finite, or the state is so extreme that the torque overflows.
    pub fn torque(&mut self, state: State<A::Scalar>) -> Result<A::Scalar, Error> {
        let regulator = &mut self.regulator;
        regulator.machine.set_state(state)?;
        let x = regulator.feedback.deviation(state);
        self.is_holding = is_near(x) && (self.is_holding || regulator.holds_from(state));
        let torque = match self.is_holding {
            true => regulator.feedback.torque_of(x),
            // It adds energy while it has the sign of θ̇2, and in the faster mode of swinging this
            // is opposite to that of θ̇1.
            false => self.pump * (self.energy - regulator.machine.energy()) * state.dtheta1,
        };
        let torque = saturate(torque, regulator.limit);
        Range::Finite.check("torque", torque.to_f64(), "N m")?;
        Ok(torque)
    }
}
