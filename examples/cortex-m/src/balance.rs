//! A controller that swings the acrobot up and holds it upright.
//!
//! A linear-quadratic regulator holds it. A simulation of the regulator decides when it takes over: it starts near the
//! upright position, and only from states that it brings to rest with the torque of the motor.
//!
//! Swinging up with a torque of 7 N m or more follows X. Xin and M. Kaneda, *Analysis of the Energy-Based Swing-Up
//! Control of the Acrobot* (2007): the torque lets (E − E↑)² + D θ̇2² + P θ2² fall. So the energy E tends to that of
//! standing upright, E↑, while link 2 comes into line with link 1. Then the acrobot passes the upright position slowly.
//!
//! A weaker motor cannot keep link 2 in line. With it the torque only brings the energy to E↑: it opposes θ̇1, because
//! in the slower mode of swinging θ̇2 has the opposite sign, and a torque along θ̇2 adds energy. The acrobot then swings
//! chaotically, until it passes a state from which the regulator can hold it.

use acrobot::physics::control::{Lqr, difference, discretize, lqr};
use acrobot::physics::{Pendulum, State};
use acrobot::{Error, Fast, Params};

/// D, in J s²/rad² times J, and P, in J²/rad², of the sum above; and the rate V at which it falls, J² s/rad².
/// Found by a random search with a limit of 10 N m.
const D: f32 = 10.5;
const P: f32 = 3.0;
const V: f32 = 17.0;

/// With a largest torque below this, N m, only the energy is controlled, with this gain, N m per J and rad/s.
const WEAK: f32 = 7.0;
const PUMPING: f32 = 0.2;

/// The regulator works while |θ1| and |θ2| deviate by less than this from upright, rad.
const NEAR: [f32; 2] = [0.7, 1.4];
/// The simulation of the regulator ends after this many steps, each as long as two ticks; or before, with success, where
/// the cost that remains is less than this times the square of the largest torque.
const STEPS_AHEAD: u32 = 100;
const LITTLE: f32 = 25.0;

pub struct Controller {
    model: Pendulum<Fast>,
    regulator: Lqr<f32>,
    /// E↑, J.
    upright: f32,
    /// The largest torque, N m.
    limit: f32,
    holding: bool,
}

impl Controller {
    /// Computes the gains for a machine with these parameters, whose `dt` is the time between two decisions.
    pub fn new(params: Params<f32>, limit: f32) -> Result<Self, Error> {
        let machine = Pendulum::<Fast>::new(params, State::UPRIGHT)?;
        let weights = [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ];
        let coarse = Params {
            dt: 2.0 * params.dt,
            ..params
        };
        Ok(Self {
            regulator: lqr(&discretize(&machine, 0.0)?, &weights, 1.0)?,
            upright: machine.energy(),
            model: Pendulum::new(coarse, State::UPRIGHT)?,
            limit,
            holding: false,
        })
    }

    /// The torque until the next decision, N m.
    pub fn decide(&mut self, state: State<f32>) -> Result<f32, Error> {
        let x = difference::<Fast>(state, State::UPRIGHT);
        self.model.set_state(state)?;
        self.holding = is_near(x) && (self.holding || self.catches()?);
        if self.holding {
            return Ok(self.regulate(x));
        }
        let torque = if self.limit < WEAK {
            PUMPING * (self.model.energy() - self.upright) * state.dtheta1
        } else {
            self.align(x)
        };
        Ok(torque.clamp(-self.limit, self.limit))
    }

    fn regulate(&self, x: [f32; 4]) -> f32 {
        self.regulator.torque(x).clamp(-self.limit, self.limit)
    }

    /// Whether the regulator brings the acrobot from the model's state to one where little cost remains.
    fn catches(&self) -> Result<bool, Error> {
        let mut model = self.model.clone();
        for _ in 0..STEPS_AHEAD {
            let x = difference::<Fast>(model.state(), State::UPRIGHT);
            if !is_near(x) {
                return Ok(false);
            }
            let cost = dot(self.regulator.cost_to_go.map(|row| dot(row, x)), x);
            if cost < LITTLE * self.limit * self.limit {
                return Ok(true);
            }
            model.step(self.regulate(x))?;
        }
        Ok(false)
    }

    /// Xin and Kaneda's torque, N m, where it is not bounded.
    fn align(&self, [_, theta2, _, dtheta2]: [f32; 4]) -> f32 {
        let [_, _, _, free] = self.model.derivative(0.0); // θ̈2 without torque
        let [[m11, m12], [_, m22]] = self.model.mass_matrix();
        let by_torque = m11 / (m11 * m22 - m12 * m12); // of θ̈2
        let missing = self.upright - self.model.energy();
        let force = V * dtheta2 + P * theta2 + D * free;
        // Above 0 for D above 40, and then the sum falls for sure. A smaller D swings up faster.
        -force / (D * by_torque - missing).max(1.0)
    }
}

fn is_near([theta1, theta2, ..]: [f32; 4]) -> bool {
    theta1.abs() < NEAR[0] && theta2.abs() < NEAR[1]
}

fn dot(x: [f32; 4], y: [f32; 4]) -> f32 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
