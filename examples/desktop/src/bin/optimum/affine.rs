//! Affine arithmetic: a function over a box as a linear function and a bound of its error.

use std::array::from_fn;
use std::ops::{Add, Mul, Sub};

use acrobot::arithmetic::{Arithmetic, Reference};

/// A function over a box: centre + Σ slopes\[i\] t\[i\] ± error, where each t\[i\], from −1 to 1, is a position in the box.
#[derive(Clone, Copy, Debug)]
pub struct Affine {
    centre: f64,
    slopes: [f64; 4],
    error: f64,
}

/// The error of more than 80 roundings to `f64`, relative to the largest number that is rounded. No operation has more.
const ROUNDING: f64 = 1e-14;

impl Affine {
    /// The coordinates of a box, given the centre and the radius in each dimension.
    pub fn coordinates(centre: [f64; 4], radius: [f64; 4]) -> [Self; 4] {
        from_fn(|i| {
            let mut x = Self::from(centre[i]);
            x.slopes[i] = radius[i];
            x
        })
    }

    pub fn low(&self) -> f64 {
        self.centre - self.rounded(0.0).radius()
    }

    pub fn high(&self) -> f64 {
        self.centre + self.rounded(0.0).radius()
    }

    /// The range of the function at a position in the box.
    #[cfg(test)]
    pub fn range_at(&self, position: [f64; 4]) -> [f64; 2] {
        let terms = self.slopes.iter().zip(position);
        let linear = terms.fold(self.centre, |sum, (slope, t)| sum + slope * t);
        [linear - self.error, linear + self.error]
    }

    /// The largest difference from the centre.
    fn radius(&self) -> f64 {
        self.slopes.iter().fold(self.error, |sum, x| sum + x.abs())
    }

    fn magnitude(&self) -> f64 {
        self.centre.abs() + self.radius()
    }

    /// The result of an operation, with an error that also covers rounding. `magnitude` is the magnitude of intermediate
    /// results, and 1 covers underflow.
    fn rounded(mut self, magnitude: f64) -> Self {
        self.error += ROUNDING * (1.0 + magnitude + self.magnitude());
        assert!(self.error < f64::INFINITY, "numbers must be finite");
        self
    }

    /// f(self) by Taylor's theorem, given f and its derivative at the centre, and the range of the second derivative.
    fn taylor(self, value: f64, derivative: f64, second: [f64; 2]) -> Self {
        let radius = self.radius();
        // The remainder is from `low` to `high`, and has often only one sign.
        let half = radius * radius / 2.0;
        let [low, high] = [second[0].min(0.0) * half, second[1].max(0.0) * half];
        let linear = Self {
            centre: value + (low + high) / 2.0,
            slopes: self.slopes.map(|slope| slope * derivative),
            error: self.error * derivative.abs() + (high - low) / 2.0,
        };
        linear.rounded(value.abs() + self.magnitude() * derivative.abs())
    }

    pub fn sin_cos(self) -> [Self; 2] {
        // `Reference` rounds correctly.
        let (sin, cos) = Reference::sin_cos(self.centre);
        let radius = self.radius();
        // The second derivatives are −sin and −cos, whose slopes are at most 1.
        let near = |x: f64| [(x - radius).max(-1.0), (x + radius).min(1.0)];
        [
            self.taylor(sin, cos, near(-sin)),
            self.taylor(cos, -sin, near(-cos)),
        ]
    }

    /// The reciprocal of a function that is at least `least`, which is above 0.
    pub fn inverse(self, least: f64) -> Self {
        let x = self.at_least(least);
        let (least, inverse) = (x.low().max(least), 1.0 / x.centre);
        let second = 2.0 / (least * least * least);
        x.taylor(inverse, -inverse * inverse, [0.0, second])
    }

    /// The square root of a function that is at least `least`, which is above 0.
    pub fn sqrt(self, least: f64) -> Self {
        let x = self.at_least(least);
        let (least, root) = (x.low().max(least), x.centre.sqrt());
        let second = -0.25 / (least * least.sqrt());
        x.taylor(root, 0.5 / root, [second, 0.0])
    }

    /// With a centre of at least `least`, so that Taylor's theorem needs derivatives only from there on.
    fn at_least(mut self, least: f64) -> Self {
        let missing = (least - self.centre).max(0.0);
        self.centre += missing;
        self.error += missing;
        self.rounded(missing)
    }

    pub fn square(self) -> Self {
        self.taylor(self.centre * self.centre, 2.0 * self.centre, [2.0, 2.0])
    }
}

/// A constant.
impl From<f64> for Affine {
    fn from(x: f64) -> Self {
        Self {
            centre: x,
            slopes: [0.0; 4],
            error: 0.0,
        }
    }
}

impl Add for Affine {
    type Output = Self;
    fn add(mut self, other: Self) -> Self {
        self.centre += other.centre;
        for (x, y) in self.slopes.iter_mut().zip(other.slopes) {
            *x += y;
        }
        self.error += other.error;
        self.rounded(0.0)
    }
}

impl Sub for Affine {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -1.0 * other
    }
}

impl Mul for Affine {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let mut product = self.centre * other;
        for (x, y) in product.slopes.iter_mut().zip(self.slopes) {
            *x += y * other.centre;
        }
        product.error += self.error * other.centre.abs() + self.radius() * other.radius();
        product.rounded(self.magnitude() * other.magnitude())
    }
}

impl Mul<Affine> for f64 {
    type Output = Affine;
    fn mul(self, x: Affine) -> Affine {
        let product = Affine {
            centre: self * x.centre,
            slopes: x.slopes.map(|slope| self * slope),
            error: self.abs() * x.error,
        };
        product.rounded(0.0)
    }
}

#[cfg(test)]
mod tests {
    use acrobot::numpy::{Pcg64, uniform};

    use super::*;

    /// Also where a part of the box is below the least number.
    #[test]
    fn roots_and_reciprocals_contain_those_of_each_number() {
        const LEAST: f64 = 0.3;
        let mut rng = Pcg64::new(3);
        for _ in 0..100_000 {
            let (centre, radius) = (uniform(&mut rng, -1.0, 2.0), uniform(&mut rng, 0.0, 2.0));
            let t = uniform(&mut rng, -1.0, 1.0);
            let number = centre + radius * t;
            let [x, ..] = Affine::coordinates([centre; 4], [radius, 0.0, 0.0, 0.0]);
            if number >= LEAST {
                for (form, exact) in [
                    (x.sqrt(LEAST), number.sqrt()),
                    (x.inverse(LEAST), 1.0 / number),
                ] {
                    let [low, high] = form.range_at([t, 0.0, 0.0, 0.0]);
                    assert!(low <= exact && exact <= high, "{exact}: {form:?}");
                }
            }
        }
    }
}
