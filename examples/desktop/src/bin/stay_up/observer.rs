//! Estimates the state and the parameters while the acrobot moves: an extended Kalman filter.
//!
//! The model can err in four parameters. Each error moves the acrobot in its own way, so a second
//! of motion tells them apart.

use std::array::from_fn;

use acrobot::arithmetic::Damped;
use acrobot::control::difference;
use acrobot::physics::Pendulum;
use acrobot::{Error, Params, Portable, State};

/// The state, and the factors of the masses, of the first length and of the second centre of mass.
type Estimate = [f64; 8];

/// The standard deviation of the factors before the motion.
const DOUBT: f64 = 0.02;
/// The variance that each number gains in a step, because the planner's `f32` rounds.
const DRIFT: f64 = 1e-10;

pub struct Observer {
    model: Pendulum<Damped<Portable>>,
    nominal: Params,
    estimate: Estimate,
    covariance: [Estimate; 8],
}

impl Observer {
    /// The state is unknown until it is measured.
    pub fn new(nominal: Params) -> Result<Self, Error> {
        let variance = |i| if i < 4 { 10.0 } else { DOUBT * DOUBT };
        Ok(Self {
            model: Pendulum::new(nominal, State::HANGING)?,
            nominal,
            estimate: [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0],
            covariance: from_fn(|i| from_fn(|j| if i == j { variance(i) } else { 0.0 })),
        })
    }

    pub fn state(&self) -> State<f32> {
        self.parts(self.estimate).0.cast()
    }

    pub fn params(&self) -> Params<f32> {
        self.parts(self.estimate).1.cast()
    }

    fn parts(&self, [x1, x2, x3, x4, factors @ ..]: Estimate) -> (State, Params) {
        let [mass1, mass2, length1, center_of_mass2] = factors.map(|factor| factor.clamp(0.5, 2.0));
        let params = Params {
            mass1: self.nominal.mass1 * mass1,
            mass2: self.nominal.mass2 * mass2,
            length1: self.nominal.length1 * length1,
            center_of_mass2: self.nominal.center_of_mass2 * center_of_mass2,
            ..self.nominal
        };
        (State::from([x1, x2, x3, x4]), params)
    }

    /// Corrects the estimate by a measured state with these standard deviations, rad and rad/s.
    pub fn measure(&mut self, state: State, deviations: [f64; 4]) {
        for (i, deviation) in deviations.into_iter().enumerate() {
            let error = difference(state, self.parts(self.estimate).0)[i];
            let row = self.covariance[i];
            let gain = row.map(|x| x / (row[i] + deviation * deviation + DRIFT));
            self.estimate = from_fn(|j| self.estimate[j] + gain[j] * error);
            self.covariance = from_fn(|j| from_fn(|k| self.covariance[j][k] - gain[j] * row[k]));
        }
    }

    /// Takes a step with a torque, N m.
    pub fn step(&mut self, torque: f32) -> Result<(), Error> {
        /// The difference for derivatives.
        const H: f64 = 1e-4;
        let next = self.stepped(self.estimate, torque)?;
        let mut columns = [[0.0; 8]; 8];
        for (i, column) in columns.iter_mut().enumerate() {
            let mut other = self.estimate;
            other[i] += H;
            let slopes = difference(self.stepped(other, torque)?, next).map(|d| d / H);
            *column = from_fn(|j| f64::from(u8::from(i == j))); // the factors stay
            column[..4].copy_from_slice(&slopes);
        }
        let half: [Estimate; 8] =
            from_fn(|i| from_fn(|j| (0..8).map(|k| columns[k][i] * self.covariance[k][j]).sum()));
        self.covariance = from_fn(|i| {
            from_fn(|j| {
                let (i, j) = (i.min(j), i.max(j)); // symmetric, also after rounding
                let sum: f64 = (0..8).map(|k| half[i][k] * columns[k][j]).sum();
                if i == j { sum + DRIFT } else { sum }
            })
        });
        self.estimate[..4].copy_from_slice(&<[f64; 4]>::from(next));
        Ok(())
    }

    fn stepped(&mut self, from: Estimate, torque: f32) -> Result<State, Error> {
        let (state, params) = self.parts(from);
        self.model.set_params(params)?;
        self.model.set_state(state)?;
        self.model.step(torque.into())?;
        Ok(self.model.state())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_seconds_of_motion_tell_the_errors() -> Result<(), Error> {
        let nominal = Params::SWINGUP;
        let factors = [1.03, 0.98, 1.02, 0.97];
        let mut observer = Observer::new(nominal)?;
        let [f1, f2, f3, f4] = factors;
        let (_, params) = observer.parts([0.0, 0.0, 0.0, 0.0, f1, f2, f3, f4]);
        let mut machine = Pendulum::<Damped<Portable>>::new(params, State::HANGING)?;
        for i in 0..200 {
            let noise = if i % 3 == 0 { 1e-4 } else { -5e-5 };
            let [x1, x2, x3, x4] = machine.state().into();
            let measured = [x1 + noise, x2 - noise, x3 + 10.0 * noise, x4 - 10.0 * noise];
            observer.measure(State::from(measured), [1e-4, 1e-4, 1e-3, 1e-3]);
            let torque = if i % 70 < 35 { 2.0 } else { -2.0 };
            machine.step(torque.into())?;
            observer.step(torque)?;
        }
        let errors: [f64; 4] = from_fn(|i| observer.estimate[4 + i] - factors[i]);
        assert!(errors.iter().all(|error| error.abs() < 1e-3), "{errors:?}");
        let x = difference(observer.state().cast(), machine.state());
        assert!(x.iter().all(|x| x.abs() < 1e-3), "{x:?}");
        Ok(())
    }
}
