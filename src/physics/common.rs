//! What both forms of the equations share.
//!
//! M(θ2) θ̈ = f(θ, θ̇, torque), with the mass matrix M = \[\[d1, d2\], \[d2, m2 lc2² + I2\]\] and the names of
//! Sutton & Barto, *Reinforcement Learning: An Introduction* (1998), section 11.3: d1, d2, phi1 and phi2.

use core::ops::{Add, Mul, Neg, Sub};

use super::params::{Dynamics, Params};
use crate::math::SinCos;

/// The constants of a form of the equations, computed from parameters.
pub trait FromParams<S>: Sized {
    /// The constants of [`Params::DEFAULT`], computed by the compiler.
    const DEFAULT: Self;

    /// The constants of `params`. l1², lc1² and lc2² are arguments, because `Host` squares with the platform's `pow`.
    fn from_params(params: &Params<S, impl Copy>, squares: [S; 3]) -> Self;
}

/// The constants that both forms need.
#[derive(Clone, Copy, Debug)]
pub struct Common<V> {
    /// 1 for the equations of the 1996 paper, otherwise 0.
    pub nips: V,
    /// m2 l1 lc2, kg m²: how strongly the links accelerate each other.
    pub coupling: V,
    /// m2 lc2² + I2, kg m²: the inertia of link 2 about its joint.
    pub link2: V,
    /// (m1 lc1 + m2 l1) g, N m.
    pub gravity1: V,
    /// m2 lc2 g, N m.
    pub gravity2: V,
    /// dt/2, s.
    pub half_dt: V,
    /// dt/6, s.
    pub sixth_dt: V,
}

impl<V> Common<V> {
    /// Applies `f` to each pair of numbers.
    #[inline(always)]
    pub fn zip<W, X>(self, other: Common<W>, f: impl Fn(V, W) -> X) -> Common<X> {
        Common {
            nips: f(self.nips, other.nips),
            coupling: f(self.coupling, other.coupling),
            link2: f(self.link2, other.link2),
            gravity1: f(self.gravity1, other.gravity1),
            gravity2: f(self.gravity2, other.gravity2),
            half_dt: f(self.half_dt, other.half_dt),
            sixth_dt: f(self.sixth_dt, other.sixth_dt),
        }
    }
}

for_f32_and_f64! {
    impl Common<S> {
        pub(super) const fn new(params: &Params<S, impl Copy>, lc2_squared: S) -> Self {
            let Params {
                length1: l1,
                mass1: m1,
                mass2: m2,
                center_of_mass1: lc1,
                center_of_mass2: lc2,
                inertia2,
                gravity,
                dt,
                dynamics,
                ..
            } = *params;
            Self {
                nips: match dynamics {
                    Dynamics::Book => 0.0,
                    Dynamics::Nips => 1.0,
                },
                coupling: m2 * l1 * lc2,
                link2: m2 * lc2_squared + inertia2,
                gravity1: (m1 * lc1 + m2 * l1) * gravity,
                gravity2: m2 * lc2 * gravity,
                half_dt: dt * 0.5,
                sixth_dt: dt / 6.0,
            }
        }
    }
}

/// Elbow and tip as \[x, y\], m.
#[inline(always)]
pub(super) fn positions<V>(params: &Params<V, impl Copy>, sin_cos: [SinCos<V>; 2]) -> [[V; 2]; 2]
where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<Output = V> + Neg<Output = V>,
{
    let (l1, l2) = (params.length1, params.length2);
    let [(sin1, cos1), (sin_sum, cos_sum)] = directions(sin_cos);
    let elbow = [l1 * sin1, -l1 * cos1];
    let tip = [elbow[0] + l2 * sin_sum, elbow[1] - l2 * cos_sum];
    [elbow, tip]
}

/// Sines and cosines of θ1 and θ1 + θ2, the angles of both links from hanging down.
#[inline(always)]
pub(crate) fn directions<V>([(sin1, cos1), (sin2, cos2)]: [SinCos<V>; 2]) -> [SinCos<V>; 2]
where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<Output = V>,
{
    let sum = (sin1 * cos2 + cos1 * sin2, cos1 * cos2 - sin1 * sin2);
    [(sin1, cos1), sum]
}
