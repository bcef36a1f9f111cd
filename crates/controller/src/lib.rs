//! Swings the acrobot up and holds it upright, by a [plan](Planner) or by a
//! [controller](Controller) without one, which computes less and succeeds later.
//!
//! Then a linear-quadratic regulator holds it. It takes over in a state from which it succeeds when
//! it is simulated.
//!
//! With a torque of 7 N m or more, the swing-up is that of X. Xin and M. Kaneda, *Analysis of the
//! Energy-Based Swing-Up Control of the Acrobot* (2007). Their torque reduces (E − E↑)² + D θ̇2² +
//! P θ2². So the energy E tends to E↑, that of standing upright, while link 2 comes into line with
//! link 1, and the acrobot passes the upright position slowly.
//!
//! A weaker motor cannot bring link 2 into line. Then the torque only brings the energy to E↑. It
//! adds energy while it has the sign of θ̇2, and in the faster mode of swinging this is opposite to
//! that of θ̇1. The acrobot swings chaotically until it is in a state from which the regulator
//! succeeds.

#![no_std]

mod plan;
mod planner;
mod recovery;

use acrobot::arithmetic::Real;
use acrobot::control::{ControlError, difference};
use acrobot::physics::{Pendulum, State, saturate};
use acrobot::{Error, Fast, Params};

pub use plan::{NoPlan, Step};
pub use planner::Planner;

use recovery::{Recovery, is_near};

/// D, J² s²/rad², and P, J²/rad², of the sum above, and V, J² s/rad²: the sum falls at the rate 2 V
/// θ̇2². A random search found them for a largest torque of 10 N m.
const D: f32 = 10.5;
const P: f32 = 3.0;
const V: f32 = 17.0;

/// With a largest torque below this, N m, only the energy is controlled, with this gain, s/rad.
const STRONG: f32 = 7.0;
const ENERGY_GAIN: f32 = 0.2;

/// The most steps of a simulation before a decision.
const STEPS_AHEAD: u32 = 200;

/// Decides on the torque of the motor.
#[derive(Clone, Debug)]
pub struct Controller {
    /// It has the state of the machine.
    model: Pendulum<Fast>,
    recovery: Recovery<f32>,
    /// E↑, J.
    upright: f32,
    holding: bool,
}

impl Controller {
    /// Computes the gains for a machine with these parameters, whose `dt` is the time between two
    /// decisions, and for a largest torque, N m.
    ///
    /// # Errors
    ///
    /// A parameter is out of range, the torque is not finite and above 0, or the gains overflow.
    pub fn new(params: Params<f32>, limit: f32) -> Result<Self, ControlError> {
        let recovery = Recovery::new::<Fast>(params, limit)?;
        let model = Pendulum::new(params, State::UPRIGHT)?;
        Ok(Self { recovery, upright: model.energy(), model, holding: false })
    }

    /// The torque until the next decision, N m.
    ///
    /// # Errors
    ///
    /// A number of the state is not finite, or the state is so extreme that the torque overflows.
    pub fn decide(&mut self, state: State<f32>) -> Result<f32, Error> {
        let x = difference(state, State::UPRIGHT);
        self.model.set_state(state)?;
        self.holding =
            is_near(x) && (self.holding || self.recovery.succeeds(self.model.clone(), STEPS_AHEAD));
        let torque = match self.holding {
            true => self.recovery.torque(x),
            false => saturate(self.swing_up(x), self.recovery.limit),
        };
        match torque.is_nan() {
            true => Err(Error::OutOfRange {
                name: "torque",
                value: torque.into(),
                unit: "N m",
                rule: "a finite number of",
            }),
            false => Ok(torque),
        }
    }

    fn swing_up(&self, [_, theta2, dtheta1, dtheta2]: [f32; 4]) -> f32 {
        let missing = self.upright - self.model.energy();
        if self.recovery.limit < STRONG {
            return -ENERGY_GAIN * missing * dtheta1;
        }
        let [_, _, _, free] = self.model.derivative(0.0); // θ̈2 without torque
        let [[m11, m12], [_, m22]] = self.model.mass_matrix();
        let by_torque = m11 / (m11 * m22 - m12 * m12); // of θ̈2
        // Positive with D above 40, and then the sum falls for sure. A smaller D swings up faster.
        let divisor = (D * by_torque - missing).max(1.0);
        -(V * dtheta2 + P * theta2 + D * free) / divisor
    }
}

/// The weights of the deviations.
fn identity<S: Real>() -> [[S; 4]; 4] {
    let row = |i| [0, 1, 2, 3].map(|j| S::from_f64(f64::from(u8::from(i == j))));
    [0, 1, 2, 3].map(row)
}

fn dot<S: Real>([x1, x2, x3, x4]: [S; 4], [y1, y2, y3, y4]: [S; 4]) -> S {
    x1 * y1 + x2 * y2 + x3 * y3 + x4 * y4
}

/// x + h y.
fn plus<S: Real>([x1, x2, x3, x4]: [S; 4], h: S, [y1, y2, y3, y4]: [S; 4]) -> [S; 4] {
    [x1 + h * y1, x2 + h * y2, x3 + h * y3, x4 + h * y4]
}
