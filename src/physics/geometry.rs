//! The directions of the links and the positions of their ends.

use core::ops::{Add, Mul, Neg, Sub};

use super::params::Params;
use crate::math::SinCos;

/// Elbow and tip as \[x, y\], m.
#[inline(always)]
pub(crate) fn positions<V>(params: &Params<V>, sin_cos: [SinCos<V>; 2]) -> [[V; 2]; 2]
where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<Output = V> + Neg<Output = V>,
{
    let (l1, l2) = (params.length1, params.length2);
    let [(sin1, cos1), (sin_sum, cos_sum)] = directions(sin_cos);
    let elbow = [l1 * sin1, -l1 * cos1];
    let tip = [elbow[0] + l2 * sin_sum, elbow[1] - l2 * cos_sum];
    [elbow, tip]
}

/// Sines and cosines of θ1 and θ1 + θ2.
#[inline(always)]
pub(crate) fn directions<V>([(sin1, cos1), (sin2, cos2)]: [SinCos<V>; 2]) -> [SinCos<V>; 2]
where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<Output = V>,
{
    let sum = (sin1 * cos2 + cos1 * sin2, cos1 * cos2 - sin1 * sin2);
    [(sin1, cos1), sum]
}
