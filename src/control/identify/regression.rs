//! The numbers of a machine from recordings, by linear least squares.
//!
//! The torques are linear in ten numbers, but need accelerations. Multiplied by a window that is 0
//! at both ends, and integrated by parts over it, they need only angles and velocities; these
//! follow from a quadratic fit of some angles in succession.

use core::array::from_fn;

use super::recording::{Correction, Sample};
use crate::error::{Error, Range};
use crate::math::Real;
use crate::math::matrix::check_finite;
use crate::physics::{Params, WIDTH};

/// The numbers on which a motion depends.
const N: usize = 10;
/// Those from here on are friction.
pub(super) const FRICTION: usize = 6;
/// Their units.
pub(super) const UNITS: [&str; N] =
    ["kg m²", "kg m²", "kg m²", "kg m", "kg m", "kg m²", "N m s/rad", "N m s/rad", "N m", "N m"];
/// Eigenvalues below this part of the largest diagonal element count as 0: the rank lacks them.
const SINGULAR: f64 = 1e-10;

/// A regression of recorded motions: its normal equations, of constant size, so firmware can keep
/// them while it shakes the machine. A recording at rest determines no number:
///
/// ```
/// use acrobot::control::identify::{Regression, Sample};
///
/// let mut regression = Regression::EMPTY;
/// // 1 s at 500 Hz; velocities from 5 angles, windows of 0.2 s.
/// regression.add(&[Sample::default(); 500], 0.002, 9.81, 2, 100)?;
/// assert_eq!(regression.fit().rank_deficiency, 10);
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Regression {
    /// \[R y\]ᵀ \[R y\] of the equations R x = y.
    products: [[f64; N + 1]; N + 1],
    equations: f64,
}

impl Regression {
    /// No recording.
    pub const EMPTY: Self = Self { products: [[0.0; N + 1]; N + 1], equations: 0.0 };

    /// Adds a recording with a sample in each `dt`, s, of a machine under `gravity`, m/s². A
    /// velocity is that of a parabola through 2 `half` + 1 angles, and a window has so many
    /// samples; the next one begins in its middle. A recording that is too short adds nothing.
    ///
    /// # Errors
    ///
    /// A number is not finite or overflows, `dt` is not above 0, or `half` or `window` is 0.
    pub fn add(
        &mut self,
        samples: &[Sample],
        dt: f64,
        gravity: f64,
        half: usize,
        window: usize,
    ) -> Result<(), Error> {
        self.add_corrected(samples, dt, gravity, half, window, &Correction::NONE)
    }

    /// As [`add`](Self::add), of a recording that needs a correction.
    pub(super) fn add_corrected(
        &mut self,
        samples: &[Sample],
        dt: f64,
        gravity: f64,
        half: usize,
        window: usize,
        correction: &Correction,
    ) -> Result<(), Error> {
        Range::AboveZero.check("dt", dt, "s")?;
        Range::Finite.check("gravity", gravity, "m/s²")?;
        Range::AboveZero.check("half", half as f64, "samples")?;
        Range::AboveZero.check("window", window as f64, "samples")?;
        for sample in samples {
            check_finite("angles", &sample.angles)?;
            check_finite("torques", &sample.torques)?;
        }
        let mut sum = self.clone();
        let parabola = half.saturating_mul(2).saturating_add(1);
        // Before each parabola, or after it, are torques that act in its middle.
        let Correction { early, longest, .. } = *correction;
        let length = early.saturating_add(longest).saturating_add(parabola);
        let windows = samples.windows(length.saturating_add(window));
        for samples in windows.step_by((window / 2).max(1)) {
            let mut rows = [[0.0; N + 1]; 2];
            for (i, around) in samples.windows(length).enumerate() {
                let z = i as f64 / window as f64;
                let p = z * (1.0 - z);
                // 16 p² and its slope.
                let (weight, slope) = (16.0 * p * p, 32.0 * p * (1.0 - 2.0 * z) / window as f64);
                let parabola = around.get(longest..longest + parabola).unwrap_or(around);
                // The mean from half a sample before to half a one later: torques are held.
                let torques = correction.torques(around, longest + half, 0.5);
                let terms = terms(correction.motion(parabola, dt), torques, gravity);
                for (row, (momentum, force)) in rows.iter_mut().zip(terms) {
                    for ((x, momentum), force) in row.iter_mut().zip(momentum).zip(force) {
                        *x += weight * dt * force - slope * momentum;
                    }
                }
            }
            for row in rows {
                for (products, x) in sum.products.iter_mut().zip(row) {
                    products.iter_mut().zip(row).for_each(|(product, y)| *product += x * y);
                }
                sum.equations += 1.0;
            }
        }
        check_finite("products", sum.products.as_flattened())?;
        *self = sum;
        Ok(())
    }

    /// The numbers that fit the recordings best, without a friction below 0.
    #[must_use]
    pub fn fit(&self) -> Fit {
        let mut is_free = [true; N];
        loop {
            let (found, before) = (self.fit_free(is_free), is_free);
            for (is_free, value) in is_free.iter_mut().zip(found.values).skip(FRICTION) {
                *is_free &= value >= 0.0;
            }
            if is_free == before {
                return found;
            }
        }
    }

    /// The part of the torques' squares that no numbers explain, also without a bound: 1 − R².
    pub(super) fn unexplained(&self) -> f64 {
        let torques = self.products[N];
        let found = self.fit_free([true; N]).values;
        let explained: f64 = found.iter().zip(torques).map(|(x, y)| x * y).sum();
        1.0 - explained / torques[N]
    }

    /// As [`fit`](Self::fit), with 0 for each number that is not free.
    #[inline(never)] // inlined, its flags are lanes whose other bits valgrind takes for undefined
    #[expect(clippy::indexing_slicing, reason = "i and j are below N")]
    pub(super) fn fit_free(&self, is_free: [bool; N]) -> Fit {
        let products = &self.products;
        // Scaled, so that all numbers have the same weight. Row and column of one that is not free
        // are those of the identity.
        let scales: [f64; N] = from_fn(|i| match products[i][i] {
            square if square > 0.0 => 1.0 / Real::sqrt(square),
            _ => 1.0,
        });
        let sums = from_fn(|i| if is_free[i] { products[i][N] * scales[i] } else { 0.0 });
        let mut scaled = [[0.0; N]; N];
        let rows = scaled.iter_mut().zip(products).zip(scales).zip(is_free);
        for (i, (((row, products), scale), is_row_free)) in rows.enumerate() {
            *row = from_fn(|j| match is_row_free && is_free[j] {
                true => products[j] * scale * scales[j],
                false => f64::from(u8::from(i == j)),
            });
        }
        let vectors = diagonalize(&mut scaled);
        let (mut values, mut inverse, mut rank_deficiency) = ([0.0; N], [0.0; N], 0);
        let (mut weakest, mut least) = ([0.0; N], f64::INFINITY);
        for (i, vector) in vectors.iter().enumerate() {
            let eigenvalue = scaled[i][i];
            if eigenvalue < least {
                (weakest, least) = (*vector, eigenvalue);
            }
            if eigenvalue > SINGULAR {
                let along = sum_of_products(vector, &sums) / eigenvalue;
                for (j, x) in vector.iter().enumerate() {
                    values[j] += x * along;
                    inverse[j] += x * x / eigenvalue;
                }
            } else {
                rank_deficiency += 1;
                for (inverse, x) in inverse.iter_mut().zip(vector) {
                    *inverse = if x.abs() > 1e-3 { f64::INFINITY } else { *inverse };
                }
            }
        }
        let spare = self.equations - N as f64;
        let square = products[N][N] - sum_of_products(&values, &sums);
        let variance = if spare > 0.0 { square.max(0.0) / spare } else { f64::INFINITY };
        let values = from_fn(|i| values[i] * scales[i]);
        let std_errors = from_fn(|i| match inverse[i] {
            f64::INFINITY => f64::INFINITY,
            inverse => Real::sqrt(inverse * variance) * scales[i],
        });
        Fit { values, std_errors, rank_deficiency, weakest }
    }
}

fn sum_of_products(x: &[f64; N], y: &[f64; N]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// For both equations of motion d/dt p + f = τ, the factors of the ten numbers in p and in f, and
/// τ beside f.
fn terms(
    [[theta1, theta2], [v1, v2]]: [[f64; 2]; 2],
    [torque1, torque2]: [f64; 2],
    gravity: f64,
) -> [([f64; N + 1], [f64; N + 1]); 2] {
    let (g1, g2) = (gravity * libm::sin(theta1), gravity * libm::sin(theta1 + theta2));
    let (sin2, cos2) = (libm::sin(theta2), libm::cos(theta2));
    let coulomb = |v: f64| {
        // As in a step that is short.
        let x = (v / WIDTH).clamp(-1.0, 1.0);
        x * (1.5 - 0.5 * x * x)
    };
    let coupled = sin2 * v1 * (v1 + v2);
    let o = 0.0;
    [
        (
            [v1, v2, o, o, o, cos2 * (2.0 * v1 + v2), o, o, o, o, o],
            [o, o, o, g1, g2, o, v1, o, coulomb(v1), o, torque1],
        ),
        (
            [o, v1, v2, o, o, cos2 * v1, o, o, o, o, o],
            [o, o, o, o, g2, coupled, o, v2, o, coulomb(v2), torque2],
        ),
    ]
}

/// Jacobi's method: a symmetric matrix becomes diagonal. Returns its eigenvectors, by rows.
#[expect(clippy::indexing_slicing, reason = "i, j and k are below N")]
fn diagonalize(m: &mut [[f64; N]; N]) -> [[f64; N]; N] {
    let mut vectors = from_fn(|i| from_fn(|j| f64::from(u8::from(i == j))));
    for _ in 0..30 {
        for i in 0..N {
            for j in i + 1..N {
                if m[i][j] == 0.0 {
                    continue;
                }
                let ratio = (m[j][j] - m[i][i]) / (2.0 * m[i][j]);
                let size = ratio.abs() + Real::sqrt(ratio * ratio + 1.0);
                let tangent = if ratio < 0.0 { -1.0 / size } else { 1.0 / size };
                let cos = 1.0 / Real::sqrt(tangent * tangent + 1.0);
                let sin = tangent * cos;
                let turn = |x: f64, y: f64| (cos * x - sin * y, sin * x + cos * y);
                for row in &mut *m {
                    (row[i], row[j]) = turn(row[i], row[j]);
                }
                for rows in [&mut *m, &mut vectors] {
                    let (one, two) = (rows[i], rows[j]);
                    rows[i] = from_fn(|k| turn(one[k], two[k]).0);
                    rows[j] = from_fn(|k| turn(one[k], two[k]).1);
                }
            }
        }
    }
    vectors
}

/// The fit of a [`Regression`], in numbers on which a motion depends.
///
/// ```
/// # use acrobot::{Params, control::identify::Fit};
/// let values = [3.5, 1.25, 1.25, 1.5, 0.5, 0.5, 0.0, 0.0, 0.0, 0.0];
/// assert_eq!((Fit::NAMES[3], values[3]), ("moment1", 1.5)); // m1 lc1 + m2 l1, kg m
/// let fit = Fit { values, std_errors: [0.01; 10], rank_deficiency: 0, weakest: [0.0; 10] };
/// let params = fit.params(Params { mass1: 3.0, ..Params::DEFAULT })?;
/// assert_eq!(params.mass1, 1.0); // kg, as fitted
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Fit {
    /// The numbers of [`NAMES`](Self::NAMES), in their units.
    pub values: [f64; N],
    /// Their standard errors, in the same units; infinite for a number that the recordings do not
    /// determine.
    pub std_errors: [f64; N],
    /// How many combinations of them the recordings do not determine: 10 minus the rank.
    pub rank_deficiency: usize,
    /// The combination with the least eigenvalue: the part of each number.
    pub weakest: [f64; N],
}

impl Fit {
    /// The elements of the mass matrix where θ2 is ±π/2, \[1, 1\], \[1, 2\] and \[2, 2\], kg m²;
    /// the moments m1 lc1 + m2 l1 and m2 lc2, kg m; the coupling m2 l1 lc2, kg m²; viscous
    /// friction, N m s/rad; Coulomb friction, N m.
    pub const NAMES: [&str; N] = [
        "mass11", "mass12", "mass22", "moment1", "moment2", "coupling", "damping1", "damping2",
        "coulomb1", "coulomb2",
    ];

    /// The parameters: those of `given` with the length of link 1, masses, inertias, rotor and
    /// friction that move as the machine does. The centres of mass are those of `given`, except
    /// where no inertia fits them.
    ///
    /// # Errors
    ///
    /// No machine has these numbers, or the recordings do not determine one that is not a friction.
    pub fn params(&self, given: Params) -> Result<Params, Error> {
        let numbers = Self::NAMES.into_iter().zip(self.values).zip(self.std_errors).zip(UNITS);
        for (((name, value), error), unit) in numbers.take(FRICTION) {
            if error == f64::INFINITY {
                let rule = "determined by recordings in which both links move long enough, in";
                return Err(Error::OutOfRange { name, value, unit, rule });
            }
        }
        let [mass11, mass12, mass22, moment1, moment2, coupling, b1, b2, c1, c2] = self.values;
        let length1 = coupling / moment2;
        let mass2 = moment2 / given.center_of_mass2;
        let params = Params {
            length1,
            mass1: (moment1 - mass2 * length1) / given.center_of_mass1,
            mass2,
            damping1: b1,
            damping2: b2,
            coulomb1: c1,
            coulomb2: c2,
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
