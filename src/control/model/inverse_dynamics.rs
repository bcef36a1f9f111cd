//! Forces from accelerations.

use crate::arithmetic::Arithmetic;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::math::matrix::check_finite;
use crate::physics::{Dynamics, Pendulum, directions, friction};

/// The torques and forces of a motion.
///
/// ```
/// use acrobot::{Portable, control::model::Forces, physics::Pendulum};
///
/// let at_rest = Pendulum::<Portable>::hanging().inverse_dynamics([0.0, 0.0])?;
/// let Forces { torques, reaction: [_, both], elbow: [_, link2] } = at_rest;
/// assert_eq!(torques, [0.0, 0.0]); // N m
/// assert!((both - 19.6).abs() < 1e-12 && (link2 - 9.8).abs() < 1e-12); // N, weights
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Forces<S = f64> {
    /// The torques on θ1 and θ2 that the motion needs, N m. The second is that of the motor. The
    /// first joint has none, so an acrobot's first torque is 0.
    pub torques: [S; 2],
    /// The force of the fixed joint on link 1, \[x, y\] in N, x to the right and y up.
    pub reaction: [S; 2],
    /// The force of link 1 on link 2 in the elbow, \[x, y\] in N.
    pub elbow: [S; 2],
}

impl<A: Arithmetic> Pendulum<A> {
    /// The torques and forces that the accelerations \[θ̈1, θ̈2\], rad/s², need in the state.
    ///
    /// This is the inverse of [`derivative`](Self::derivative), by the recursive Newton-Euler
    /// method (J. Y. S. Luh, M. W. Walker and R. P. C. Paul, *On-Line Computational Scheme for
    /// Mechanical Manipulators*, 1980). For [`Dynamics::Nips`] the torques are those of its
    /// equations; the forces follow from the motion by Newton's law.
    ///
    /// ```
    /// use acrobot::physics::Pendulum;
    /// use acrobot::{Params, Portable, State};
    ///
    /// let level = State { theta2: 1.57, ..State::HANGING }; // link 2 is level
    /// let level = Pendulum::<Portable>::new(Params::DEFAULT, level)?;
    /// let [_, motor] = level.inverse_dynamics([0.0, 0.0])?.torques; // to stay there
    /// assert!((motor - 4.9).abs() < 1e-2); // N m
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for an acceleration that is not finite, and
    /// [`Error::NotFinite`] if a torque or a force overflows.
    pub fn inverse_dynamics(
        &self,
        [ddtheta1, ddtheta2]: [A::Scalar; 2],
    ) -> Result<Forces<A::Scalar>, Error> {
        Range::Finite.check("ddtheta1", ddtheta1.to_f64(), "rad/s²")?;
        Range::Finite.check("ddtheta2", ddtheta2.to_f64(), "rad/s²")?;
        let params = self.params();
        let state = self.state();
        let [direction1, direction2] = directions(self.sin_cos());
        let rates = [state.dtheta1, state.dtheta2];
        let (rate1, rate2) = (state.dtheta1, state.dtheta1 + state.dtheta2);
        let (turn1, turn2) = (ddtheta1, ddtheta1 + ddtheta2);
        let (l1, lc1) = (params.length1, params.center_of_mass1);
        let lc2 = params.center_of_mass2;

        // From the fixed joint to the tip: accelerations relative to free fall.
        let along = |(sin, cos), rate: A::Scalar, turn, distance| {
            let (outwards, across) = (-(rate * rate * distance), turn * distance);
            [outwards * sin + across * cos, across * sin - outwards * cos]
        };
        let add = |[x1, y1]: [A::Scalar; 2], [x2, y2]: [A::Scalar; 2]| [x1 + x2, y1 + y2];
        let up = [A::Scalar::ZERO, params.gravity];
        let center1 = add(up, along(direction1, rate1, turn1, lc1));
        let elbow = add(up, along(direction1, rate1, turn1, l1));
        let center2 = add(elbow, along(direction2, rate2, turn2, lc2));

        // And back: each joint bears what follows it. A force turns a link by its part across.
        let across = |(sin, cos), [x, y]: [A::Scalar; 2]| cos * x + sin * y;
        let force2 = center2.map(|x| params.mass2 * x);
        let force1 = add(force2, center1.map(|x| params.mass1 * x));
        let mut torque2 = params.inertia2 * turn2 + lc2 * across(direction2, force2);
        let mut torque1 = torque2
            + params.inertia1 * turn1
            + lc1 * across(direction1, force1)
            + (l1 - lc1) * across(direction1, force2);
        if A::HAS_FRICTION {
            let [(friction1, _), (friction2, _)] = friction::<A, A::Scalar>(self.model(), rates);
            torque1 = torque1 - params.rotor * (turn1 + turn2) + friction1;
            torque2 = torque2 - params.rotor * turn1 + friction2;
        }
        let (sin2, _) = self.sin_cos()[1];
        let centrifugal = params.mass2 * l1 * lc2 * (rate1 * rate1) * sin2;
        let forces = Forces {
            torques: match params.dynamics {
                Dynamics::Book => [torque1, torque2],
                Dynamics::Nips => [torque1, torque2 - centrifugal],
            },
            reaction: force1,
            elbow: force2,
        };
        check_finite("torques", &forces.torques)?;
        check_finite("reaction", &forces.reaction)?;
        check_finite("elbow", &forces.elbow)?;
        Ok(forces)
    }
}
