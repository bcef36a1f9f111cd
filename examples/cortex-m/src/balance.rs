//! A controller that swings the acrobot up and holds it upright.
//!
//! Swinging up follows X. Xin and M. Kaneda, *Analysis of the Energy-Based Swing-Up Control of the Acrobot* (2007): the
//! torque lets (E − E↑)² + D θ̇2² + P θ2² fall. So the energy tends to that of standing upright, E↑, while link 2 comes
//! into line with link 1, and the acrobot swings through the upright position slowly.
//!
//! Holding is a linear-quadratic regulator. It begins where the cost that remains is small, so the torque suffices.

use acrobot::physics::control::{Lqr, difference, discretize, lqr};
use acrobot::physics::{Pendulum, State};
use acrobot::{Error, Fast, Params};

/// D, in J s²/rad² times J, and P, in J²/rad², of the sum above; and the rate V at which it falls, J² s/rad².
/// Found by a random search with a limit of 10 N m.
const D: f32 = 10.5;
const P: f32 = 3.0;
const V: f32 = 17.0;

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
        let model = Pendulum::new(params, State::UPRIGHT)?;
        let weights = [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ];
        Ok(Self {
            regulator: lqr(&discretize(&model, 0.0)?, &weights, 1.0)?,
            upright: model.energy(),
            model,
            limit,
            holding: false,
        })
    }

    /// The torque until the next decision, N m.
    pub fn decide(&mut self, state: State<f32>) -> Result<f32, Error> {
        let x = difference::<Fast>(state, State::UPRIGHT);
        let costs = self.regulator.cost_to_go.map(|row| dot(row, x));
        // With R = 1 the cost is in (N m)²: 25 times the square of the limit. Once it holds, it gives up late.
        let most = self.limit * self.limit * if self.holding { 100.0 } else { 25.0 };
        self.holding = dot(costs, x) < most;
        let torque = if self.holding {
            self.regulator.torque(x)
        } else {
            self.swing_up(state, x[1])?
        };
        Ok(torque.clamp(-self.limit, self.limit))
    }

    fn swing_up(&mut self, state: State<f32>, theta2: f32) -> Result<f32, Error> {
        self.model.set_state(state)?;
        let [_, _, _, free] = self.model.derivative(0.0); // θ̈2 without torque
        let [[m11, m12], [_, m22]] = self.model.mass_matrix();
        let by_torque = m11 / (m11 * m22 - m12 * m12); // of θ̈2
        let missing = self.upright - self.model.energy();
        let force = V * state.dtheta2 + P * theta2 + D * free;
        // Above 0 for D above 40, and then the sum falls for sure. A smaller D swings up faster.
        Ok(-force / (D * by_torque - missing).max(1.0))
    }
}

fn dot(x: [f32; 4], y: [f32; 4]) -> f32 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
