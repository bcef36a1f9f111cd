//! Swings the acrobot up and holds it upright, by a [plan](Planner) or by a
//! [controller](Controller) without one, which computes less and succeeds later.
//!
//! Then a linear-quadratic regulator holds it. Near the upright position the controller simulates
//! the regulator, and lets it take over in a state from which it succeeds.
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

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::physics::control::{ControlError, Lqr, difference};
use acrobot::physics::{Pendulum, State, bound};
use acrobot::{Error, Fast, Params};

pub use plan::{NoPlan, Step};
pub use planner::Planner;

/// D, J² s²/rad², and P, J²/rad², of the sum above, and V, J² s/rad²: the sum falls at the rate 2 V
/// θ̇2². A random search found them for a largest torque of 10 N m.
const D: f32 = 10.5;
const P: f32 = 3.0;
const V: f32 = 17.0;

/// With a largest torque below this, N m, only the energy is controlled, with this gain, s/rad.
const STRONG: f32 = 7.0;
const ENERGY_GAIN: f32 = 0.2;

/// The regulator works while θ1 and θ2 deviate by less than this from upright, rad.
const NEAR: [f64; 2] = [0.7, 1.4];
/// The simulation takes at most this many steps, each as long as two decisions. The regulator
/// succeeds if the remaining cost falls below this times the square of the largest torque.
const STEPS_AHEAD: u32 = 100;
const LITTLE: f64 = 25.0;

/// Decides on the torque of the motor.
#[derive(Debug)]
pub struct Controller {
    /// It has the state of the machine. Its steps are those of the simulation.
    model: Pendulum<Fast>,
    regulator: Lqr<f32>,
    /// E↑, J.
    upright: f32,
    /// The largest torque, N m.
    limit: f32,
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
        check_limit(limit)?;
        let machine = Pendulum::<Fast>::new(params, State::UPRIGHT)?;
        let ahead = Params { dt: 2.0 * params.dt, ..params };
        Ok(Self {
            regulator: regulator(&machine)?,
            upright: machine.energy(),
            model: Pendulum::new(ahead, State::UPRIGHT)?,
            limit,
            holding: false,
        })
    }

    /// The torque until the next decision, N m.
    ///
    /// # Errors
    ///
    /// A number of the state is not finite.
    pub fn decide(&mut self, state: State<f32>) -> Result<f32, Error> {
        let x = difference(state, State::UPRIGHT);
        self.model.set_state(state)?;
        self.holding = is_near(x)
            && (self.holding || catches(self.model.clone(), &self.regulator, self.limit)?);
        if self.holding {
            return Ok(bound(self.regulator.torque(x), self.limit));
        }
        Ok(bound(self.swing_up(x), self.limit))
    }

    fn swing_up(&self, [_, theta2, dtheta1, dtheta2]: [f32; 4]) -> f32 {
        let missing = self.upright - self.model.energy();
        if self.limit < STRONG {
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

/// Rejects a largest torque, N m, that is not finite and above 0.
fn check_limit<S: Real>(limit: S) -> Result<(), Error> {
    match limit > S::ZERO && limit.is_finite() {
        true => Ok(()),
        false => Err(Error::OutOfRange {
            name: "the largest torque",
            value: limit.to_f64(),
            unit: "N m",
            rule: "finite and above 0",
        }),
    }
}

/// The regulator of the upright position.
fn regulator<A: Arithmetic>(machine: &Pendulum<A>) -> Result<Lqr<A::Scalar>, ControlError> {
    machine.regulator(A::Scalar::ZERO, &identity(), A::Scalar::from_f64(1.0))
}

/// The weights of the deviations.
fn identity<S: Real>() -> [[S; 4]; 4] {
    let row = |i| [0, 1, 2, 3].map(|j| S::from_f64(f64::from(u8::from(i == j))));
    [0, 1, 2, 3].map(row)
}

/// Whether the regulator succeeds from the model's state.
fn catches<A: Arithmetic>(
    mut model: Pendulum<A>,
    regulator: &Lqr<A::Scalar>,
    limit: A::Scalar,
) -> Result<bool, Error> {
    for _ in 0..STEPS_AHEAD {
        let x = model.deviation(State::UPRIGHT);
        if !is_near(x) {
            return Ok(false);
        }
        let cost = dot(regulator.cost_to_go.map(|row| dot(row, x)), x);
        if cost < limit * limit * A::Scalar::from_f64(LITTLE) {
            return Ok(true);
        }
        model.step(bound(regulator.torque(x), limit))?;
    }
    Ok(false)
}

fn is_near<S: Real>(x: [S; 4]) -> bool {
    let [theta1, theta2, ..] = x.map(|x| x.to_f64().abs());
    theta1 < NEAR[0] && theta2 < NEAR[1]
}

fn dot<S: Real>([x1, x2, x3, x4]: [S; 4], [y1, y2, y3, y4]: [S; 4]) -> S {
    x1 * y1 + x2 * y2 + x3 * y3 + x4 * y4
}
