//! Identifies the parameters of a machine from recorded angles and torques: linear least squares.
//!
//! The torques are linear in ten numbers, but need accelerations. Multiplied by a window that is 0
//! at both ends, and integrated by parts over it, they need only angles and velocities; these
//! follow from a quadratic fit of some angles in succession.

use super::error::ControlError;
use super::matrix::check_finite;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::physics::{Joints, Params};

/// The numbers that a motion tells.
const N: usize = 10;
/// Combinations whose evidence is below this part of the largest are not determined.
const UNDETERMINED: f64 = 1e-10;
/// The velocity below which dry friction is smooth, rad/s, as in a step that is short.
const WIDTH: f64 = 0.02;

/// A sample of a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// θ1 and θ2, rad, without jumps by whole turns.
    pub angles: [f64; 2],
    /// The torques on θ1 and θ2 from this sample to the next, N m. An acrobot's first is 0.
    pub torques: [f64; 2],
}

/// What recordings tell about a machine: the normal equations of least squares, of constant size,
/// so firmware can keep them while it shakes the machine.
///
/// ```
/// use acrobot::control::{Evidence, Sample};
///
/// let mut evidence = Evidence::NONE;
/// // A machine that hangs tells nothing.
/// evidence.add(&[Sample::default(); 500], 0.002, 9.81, 3, 100)?;
/// assert_eq!(evidence.solve().undetermined, 10);
/// # Ok::<(), acrobot::control::ControlError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Evidence {
    /// Rᵀ R, Rᵀ y and yᵀ y of the equations R x = y.
    products: [[f64; N]; N],
    sums: [f64; N],
    square: f64,
    equations: f64,
}

impl Evidence {
    /// No recording.
    pub const NONE: Self =
        Self { products: [[0.0; N]; N], sums: [0.0; N], square: 0.0, equations: 0.0 };

    /// Adds a recording with a sample in each `dt`, s, of a machine under `gravity`, m/s². A
    /// velocity is that of a parabola through 2 `half` + 1 angles, and a window has so many
    /// samples; the next one begins in its middle. A recording that is too short adds nothing.
    ///
    /// # Errors
    ///
    /// A number is not finite, `dt` is not above 0, or `half` or `window` is 0.
    pub fn add(
        &mut self,
        samples: &[Sample],
        dt: f64,
        gravity: f64,
        half: usize,
        window: usize,
    ) -> Result<(), ControlError> {
        Range::AboveZero.check("dt", dt, "s")?;
        Range::Finite.check("gravity", gravity, "m/s²")?;
        Range::AboveZero.check("half", half as f64, "samples")?;
        Range::AboveZero.check("window", window as f64, "samples")?;
        for sample in samples {
            check_finite("angles", &sample.angles)?;
            check_finite("torques", &sample.torques)?;
        }
        for samples in samples.windows(window + 2 * half + 1).step_by(window.div_ceil(2)) {
            let mut rows = [[0.0; N + 1]; 2];
            for (i, (around, sample)) in
                samples.windows(2 * half + 1).zip(samples.iter().skip(half)).enumerate()
            {
                let z = i as f64 / window as f64;
                let p = z * (1.0 - z);
                // 16 p² and its slope.
                let (weight, slope) = (16.0 * p * p, 32.0 * p * (1.0 - 2.0 * z) / window as f64);
                let motion = motion(around, dt);
                for (row, terms) in rows.iter_mut().zip(terms(motion, gravity)) {
                    let (momentum, force) = terms;
                    for (x, (momentum, force)) in
                        row.iter_mut().zip(momentum.into_iter().zip(force))
                    {
                        *x += weight * dt * force - slope * momentum;
                    }
                }
                for (row, torque) in rows.iter_mut().zip(sample.torques) {
                    let [.., y] = row;
                    *y += weight * dt * torque;
                }
            }
            rows.iter().for_each(|row| self.add_equation(row));
        }
        Ok(())
    }

    /// Adds the equation of ten factors and a result.
    fn add_equation(&mut self, row: &[f64; N + 1]) {
        let [factors @ .., y] = row;
        for ((products, sum), x) in self.products.iter_mut().zip(&mut self.sums).zip(factors) {
            for (product, other) in products.iter_mut().zip(factors) {
                *product += x * other;
            }
            *sum += x * y;
        }
        self.square += y * y;
        self.equations += 1.0;
    }

    /// The machine that fits the recordings best, without a friction below 0.
    #[must_use]
    pub fn solve(&self) -> Identified {
        let mut is_free = [true; N];
        loop {
            let found = self.solve_free(&is_free);
            let frictions = found.values.iter().zip(&mut is_free).skip(6);
            let mut negative = frictions.filter(|(value, _)| **value < 0.0).peekable();
            if negative.peek().is_none() {
                return found;
            }
            negative.for_each(|(_, is_free)| *is_free = false);
        }
    }

    /// As [`solve`](Self::solve), with 0 for each number that is not free.
    fn solve_free(&self, is_free: &[bool; N]) -> Identified {
        // Scaled, so that all numbers have the same weight. Row and column of one that is not free
        // are those of the identity.
        let mut scales = [0.0; N];
        for (i, (scale, row)) in scales.iter_mut().zip(&self.products).enumerate() {
            let x = row.get(i).copied().unwrap_or(0.0);
            *scale = if x > 0.0 { 1.0 / Real::sqrt(x) } else { 0.0 };
        }
        let mut scaled = self.products;
        let mut sums = self.sums;
        for (i, row) in scaled.iter_mut().enumerate() {
            let (own, free) = (at(&scales, i), at(is_free, i));
            for (j, x) in row.iter_mut().enumerate() {
                let both = free && at(is_free, j);
                *x = if both { *x * own * at(&scales, j) } else { f64::from(u8::from(i == j)) };
            }
        }
        for (i, sum) in sums.iter_mut().enumerate() {
            *sum = if at(is_free, i) { *sum * at(&scales, i) } else { 0.0 };
        }
        let vectors = diagonalize(&mut scaled);
        let (mut values, mut inverse, mut undetermined) = ([0.0; N], [0.0; N], N);
        let mut weakest = ([0.0; N], f64::INFINITY);
        for (i, vector) in vectors.iter().enumerate() {
            let evidence = scaled.get(i).map_or(0.0, |row| at(row, i));
            if evidence < weakest.1 {
                weakest = (*vector, evidence);
            }
            if evidence > UNDETERMINED {
                undetermined -= 1;
                let along: f64 = vector.iter().zip(&sums).map(|(x, y)| x * y).sum();
                for ((value, inverse), x) in values.iter_mut().zip(&mut inverse).zip(vector) {
                    *value += x * along / evidence;
                    *inverse += x * x / evidence;
                }
            }
        }
        let fits: f64 = values.iter().zip(&sums).map(|(x, y)| x * y).sum();
        let spare = self.equations - N as f64;
        let variance =
            if spare > 0.0 { (self.square - fits).max(0.0) / spare } else { f64::INFINITY };
        let mut errors = inverse.map(|x| Real::sqrt(x * variance));
        for ((value, error), scale) in values.iter_mut().zip(&mut errors).zip(scales) {
            *value *= scale;
            *error *= scale;
        }
        Identified { values, errors, undetermined, weakest: weakest.0 }
    }
}

/// An element of an array, whose indices are below its length.
fn at<T: Copy + Default, const K: usize>(array: &[T; K], i: usize) -> T {
    array.get(i).copied().unwrap_or_default()
}

/// Angles and velocities, rad and rad/s, in the middle of some samples.
fn motion(samples: &[Sample], dt: f64) -> [[f64; 2]; 2] {
    let half = samples.len() as f64 / 2.0 - 0.5;
    let (mut sums, mut slopes, mut curves) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    let (mut squares, mut fourths) = (0.0, 0.0);
    for (i, sample) in samples.iter().enumerate() {
        let t = i as f64 - half;
        squares += t * t;
        fourths += t * t * t * t;
        for (j, x) in sample.angles.into_iter().enumerate() {
            if let (Some(sum), Some(slope), Some(curve)) =
                (sums.get_mut(j), slopes.get_mut(j), curves.get_mut(j))
            {
                *sum += x;
                *slope += t * x;
                *curve += t * t * x;
            }
        }
    }
    let count = samples.len() as f64;
    let determinant = count * fourths - squares * squares;
    let [sum1, sum2] = sums;
    let [curve1, curve2] = curves;
    let middle = |sum, curve| (fourths * sum - squares * curve) / determinant;
    [[middle(sum1, curve1), middle(sum2, curve2)], slopes.map(|slope| slope / squares / dt)]
}

/// For both equations of motion d/dt p + f = τ, the factors of the ten numbers in p and in f.
fn terms([[theta1, theta2], [v1, v2]]: [[f64; 2]; 2], gravity: f64) -> [([f64; N], [f64; N]); 2] {
    let (sin1, sin_sum) = (libm::sin(theta1), libm::sin(theta1 + theta2));
    let (sin2, cos2) = (libm::sin(theta2), libm::cos(theta2));
    let dry = |v: f64| {
        let x = (v / WIDTH).clamp(-1.0, 1.0);
        x * (1.5 - 0.5 * x * x)
    };
    let (g1, g2, o) = (gravity * sin1, gravity * sin_sum, 0.0);
    let coupled = -sin2 * v1 * (v1 + v2);
    [
        (
            [v1, v2, o, o, o, cos2 * (2.0 * v1 + v2), o, o, o, o],
            [o, o, o, g1, g2, o, v1, o, dry(v1), o],
        ),
        ([o, v1, v2, o, o, cos2 * v1, o, o, o, o], [o, o, o, o, g2, -coupled, o, v2, o, dry(v2)]),
    ]
}

/// Jacobi's method: a symmetric matrix becomes diagonal. Returns its eigenvectors, by rows.
fn diagonalize(m: &mut [[f64; N]; N]) -> [[f64; N]; N] {
    let mut vectors = [[0.0; N]; N];
    for (i, row) in vectors.iter_mut().enumerate() {
        if let Some(x) = row.get_mut(i) {
            *x = 1.0;
        }
    }
    for _ in 0..30 {
        for i in 0..N {
            for j in i + 1..N {
                let row = m.get(i).copied().unwrap_or_default();
                let (ii, ij) = (at(&row, i), at(&row, j));
                let jj = m.get(j).map_or(0.0, |row| at(row, j));
                if ij == 0.0 {
                    continue;
                }
                let ratio = (jj - ii) / (2.0 * ij);
                let sign = if ratio < 0.0 { -1.0 } else { 1.0 };
                let tangent = sign / (ratio.abs() + Real::sqrt(ratio * ratio + 1.0));
                let cos = 1.0 / Real::sqrt(tangent * tangent + 1.0);
                let sin = tangent * cos;
                rotate_rows(m, i, j, cos, sin);
                for row in m.iter_mut() {
                    let (x, y) = (at(row, i), at(row, j));
                    if let Some(place) = row.get_mut(i) {
                        *place = cos * x - sin * y;
                    }
                    if let Some(place) = row.get_mut(j) {
                        *place = sin * x + cos * y;
                    }
                }
                rotate_rows(&mut vectors, i, j, cos, sin);
            }
        }
    }
    vectors
}

fn rotate_rows(m: &mut [[f64; N]; N], i: usize, j: usize, cos: f64, sin: f64) {
    let (before, after) = m.split_at_mut(j.min(N));
    if let (Some(one), Some(two)) = (before.get_mut(i), after.first_mut()) {
        for (x, y) in one.iter_mut().zip(two) {
            (*x, *y) = (cos * *x - sin * *y, sin * *x + cos * *y);
        }
    }
}

/// The machine that fits some recordings best, in numbers that a motion tells.
#[derive(Clone, Copy, Debug)]
pub struct Identified {
    /// The numbers of [`NAMES`](Self::NAMES), in their units.
    pub values: [f64; N],
    /// Their standard errors, in the same units.
    pub errors: [f64; N],
    /// How many combinations of them the recordings do not determine.
    pub undetermined: usize,
    /// The combination that they determine worst: the part of each number.
    pub weakest: [f64; N],
}

impl Identified {
    /// The elements of the mass matrix where θ2 is ±π/2, \[1, 1\], \[1, 2\] and \[2, 2\], kg m²;
    /// the moments m1 lc1 + m2 l1 and m2 lc2, kg m; the coupling m2 l1 lc2, kg m²; viscous
    /// friction, N m s/rad; Coulomb friction, N m.
    pub const NAMES: [&str; N] = [
        "mass11",
        "mass12",
        "mass22",
        "moment1",
        "moment2",
        "coupling",
        "friction1",
        "friction2",
        "coulomb1",
        "coulomb2",
    ];

    /// The parameters: those of `given` with the length of link 1, masses, inertias, rotor and
    /// friction that move as the machine does. The centres of mass are those of `given`, except
    /// where no inertia fits them.
    ///
    /// # Errors
    ///
    /// No machine has these numbers.
    pub fn params(&self, given: Params) -> Result<Params, Error> {
        let [mass11, mass12, mass22, moment1, moment2, coupling, b1, b2, c1, c2] = self.values;
        let length1 = coupling / moment2;
        let mass2 = moment2 / given.center_of_mass2;
        let params = Params {
            length1,
            mass1: (moment1 - mass2 * length1) / given.center_of_mass1,
            mass2,
            friction: Joints { joint1: b1, joint2: b2 },
            coulomb: Joints { joint1: c1, joint2: c2 },
            rotor: mass22 - mass12,
            ..given
        };
        let upper = mass11 - 2.0 * mass12 + mass22;
        let joint1 = upper - mass2 * length1 * length1;
        let params = params.with_inertias_about_joints([joint1, mass22]);
        params.validate()?;
        Ok(params)
    }
}
