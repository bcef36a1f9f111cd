//! The units of a machine: in them all machines of one shape move alike, whatever their size.

use crate::math::Real;
use crate::physics::Params;

/// A time and two torques. The constants of `control` are in these units, so that none has the
/// scale of a metre, a kilogram or a second. They are roots and products, so powers of 4 and 2 in
/// lengths and masses change no digit.
#[derive(Clone, Copy, Debug)]
pub(in crate::control) struct Units {
    /// T = √(I / F), s, where I is the inertia of the straight machine about the fixed joint.
    pub(in crate::control) time: f64,
    /// The largest torque of the motor, N m.
    pub(in crate::control) torque: f64,
    /// F, N m: the torque of gravity on the straight machine when it is level, plus the motor's. So
    /// a machine without gravity has units, too.
    pub(in crate::control) force: f64,
}

impl Units {
    pub(in crate::control) fn new<S: Real>(params: &Params<S>, limit: S) -> Self {
        let params: Params<f64> = params.cast();
        let [link1, tip, link2, coupling] = params.inertias();
        let [moment1, moment2] = params.moments();
        let torque = limit.to_f64();
        let force = ((moment1 + moment2) * params.gravity).abs() + torque;
        let time = Real::sqrt((link1 + tip + link2 + 2.0 * (coupling - params.rotor)) / force);
        Self { time, torque, force }
    }
}
