//! Taylor models: a function over a box as a polynomial of degree 2 and a bound of its error.

use std::array::from_fn;
use std::ops::{Add, Mul, Sub};

use acrobot::arithmetic::{Arithmetic, Reference};

/// The products of two of four variables.
pub const PAIRS: [(usize, usize); 10] =
    [(0, 0), (0, 1), (0, 2), (0, 3), (1, 1), (1, 2), (1, 3), (2, 2), (2, 3), (3, 3)];

/// A function over a box: constant + Σ linear\[i\] t\[i\] + Σ quadratic\[k\] t\[i\] t\[j\] ± error,
/// where (i, j) is `PAIRS[k]` and each t\[i\], from −1 to 1, is a position in the box.
#[derive(Clone, Copy, Debug)]
pub struct TaylorModel {
    constant: f64,
    linear: [f64; 4],
    quadratic: [f64; 10],
    error: f64,
    /// More than the sum of the magnitudes of these numbers, and of those that they are the sums
    /// of.
    size: f64,
}

/// More than the error by rounding, relative to the size of a result: no operation rounds a number
/// a hundred times, by 1.1e-16.
const ROUNDING: f64 = 1e-13;

impl TaylorModel {
    const ZERO: Self = Self {
        constant: 0.0,
        linear: [0.0; 4],
        quadratic: [0.0; 10],
        error: 0.0,
        // Covers underflow.
        size: 1.0,
    };

    /// The coordinates of a box, given the centre and the radius in each dimension.
    pub fn coordinates(centre: [f64; 4], radius: [f64; 4]) -> [Self; 4] {
        from_fn(|i| {
            let mut x = Self::from(centre[i]);
            x.linear[i] = radius[i];
            x.size += radius[i];
            x
        })
    }

    pub fn low(&self) -> f64 {
        -Self::sum([(-1.0, self)]).high()
    }

    pub fn high(&self) -> f64 {
        let sum = self.constant + self.error + ROUNDING * self.size;
        let terms = PAIRS.into_iter().zip(self.quadratic);
        terms.fold(sum, |sum, ((i, j), factor)| {
            let slope = self.linear[i].abs();
            sum + match i == j {
                false => factor.abs(),
                // The parabola slope · t + factor · t² is highest at the edge, or before it.
                true if factor >= -slope / 2.0 => slope + factor,
                true => -slope * slope / (4.0 * factor),
            }
        })
    }

    /// The range of the function at a position in the box.
    #[cfg(test)]
    pub fn range_at(&self, t: [f64; 4]) -> [f64; 2] {
        let linear = self.linear.iter().zip(t).map(|(factor, t)| factor * t);
        let quadratic = self.quadratic.iter().zip(PAIRS);
        let quadratic = quadratic.map(|(factor, (i, j))| factor * t[i] * t[j]);
        let value = self.constant + linear.chain(quadratic).sum::<f64>();
        [value - self.error, value + self.error]
    }

    /// Fails unless the function can have this value at a position in the box.
    #[cfg(test)]
    #[track_caller]
    pub fn assert_contains(&self, t: [f64; 4], value: f64, slack: f64) {
        for [low, high] in [self.range_at(t), [self.low(), self.high()]] {
            assert!(low - slack <= value && value <= high + slack, "{value}: {self:?}");
        }
    }

    /// The largest magnitudes of the linear and of the quadratic terms.
    #[inline(always)]
    fn magnitudes(&self) -> [f64; 2] {
        let [a, b, c, d] = self.linear.map(f64::abs);
        let q = self.quadratic.map(f64::abs);
        let first = (q[0] + q[1]) + (q[2] + q[3]) + (q[8] + q[9]);
        [(a + b) + (c + d), first + ((q[4] + q[5]) + (q[6] + q[7]))]
    }

    /// The largest difference from the constant.
    fn radius(&self) -> f64 {
        let [linear, quadratic] = self.magnitudes();
        linear + quadratic + self.error
    }

    /// Σ factor · term.
    #[inline(always)]
    pub fn sum<'a>(terms: impl IntoIterator<Item = (f64, &'a Self)>) -> Self {
        let mut sum = Self::ZERO;
        for (factor, term) in terms {
            sum.constant += factor * term.constant;
            for (sum, x) in sum.linear.iter_mut().zip(term.linear) {
                *sum += factor * x;
            }
            for (sum, x) in sum.quadratic.iter_mut().zip(term.quadratic) {
                *sum += factor * x;
            }
            sum.error += factor.abs() * term.error;
            sum.size += factor.abs() * term.size;
        }
        sum.error += ROUNDING * sum.size;
        sum
    }

    /// f(self) by Taylor's theorem, given f and its first two derivatives at the constant, and the
    /// largest magnitude of the third derivative.
    #[inline(always)]
    fn taylor(&self, [value, first, second]: [f64; 3], third: f64) -> Self {
        let [linear, quadratic] = self.magnitudes();
        let radius = linear + quadratic + self.error;
        let half = second / 2.0;
        let remainder = third * radius * radius * radius / 6.0;
        let square = radius * radius;
        let size = 1.0 + value.abs() + first.abs() * radius + half.abs() * square + remainder;
        let products = products(self.linear, self.linear);
        Self {
            constant: value,
            linear: self.linear.map(|x| first * x),
            quadratic: from_fn(|k| first * self.quadratic[k] + half * products[k]),
            error: first.abs() * self.error
                + half.abs() * (square - linear * linear)
                + remainder
                + ROUNDING * size,
            size,
        }
    }

    pub fn sin_cos(&self) -> [Self; 2] {
        // `Reference` rounds correctly.
        let (sin, cos) = Reference::sin_cos(self.constant);
        // The slopes of sine and cosine are at most 1.
        let near = |x: f64| (x.abs() + self.radius()).min(1.0);
        [self.taylor([sin, cos, -sin], near(cos)), self.taylor([cos, -sin, -cos], near(sin))]
    }

    /// The reciprocal of a function that is at least `least`, which is above 0.
    pub fn inverse(&self, least: f64) -> Self {
        let x = self.at_least(least);
        let (least, inverse) = (x.low().max(least), 1.0 / x.constant);
        let square = inverse * inverse;
        x.taylor([inverse, -square, 2.0 * square * inverse], 6.0 / (least * least * least * least))
    }

    /// The square root of a function that is at least `least`, which is above 0.
    pub fn sqrt(&self, least: f64) -> Self {
        let x = self.at_least(least);
        let (least, root) = (x.low().max(least), x.constant.sqrt());
        x.taylor(
            [root, 0.5 / root, -0.25 / (x.constant * root)],
            0.375 / (least * least * least.sqrt()),
        )
    }

    /// With a constant of at least `least`, so that Taylor's theorem needs derivatives only from
    /// there on.
    fn at_least(&self, least: f64) -> Self {
        let missing = (least - self.constant).max(0.0);
        let mut x = *self + Self::from(missing);
        x.error += missing;
        x.size += missing;
        x
    }

    pub fn square(&self) -> Self {
        let x = self.constant;
        self.taylor([x * x, 2.0 * x, 2.0], 0.0)
    }
}

/// The quadratic terms of a product of two linear functions.
#[inline(always)]
fn products(a: [f64; 4], b: [f64; 4]) -> [f64; 10] {
    PAIRS.map(|(i, j)| match i == j {
        true => a[i] * b[i],
        false => a[i] * b[j] + a[j] * b[i],
    })
}

impl From<f64> for TaylorModel {
    fn from(constant: f64) -> Self {
        Self { constant, size: 1.0 + constant.abs(), ..Self::ZERO }
    }
}

impl Add for TaylorModel {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::sum([(1.0, &self), (1.0, &other)])
    }
}

impl Sub for TaylorModel {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::sum([(1.0, &self), (-1.0, &other)])
    }
}

impl Mul for TaylorModel {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let ([linear_a, quadratic_a], [linear_b, quadratic_b]) =
            (self.magnitudes(), other.magnitudes());
        let [size_a, size_b] = [self, other].map(|x| x.constant.abs() + x.radius());
        let size = 1.0 + size_a * size_b;
        let products = products(self.linear, other.linear);
        let scaled = |x: f64, y: f64| self.constant * y + other.constant * x;
        Self {
            constant: self.constant * other.constant,
            linear: from_fn(|i| scaled(self.linear[i], other.linear[i])),
            quadratic: from_fn(|k| scaled(self.quadratic[k], other.quadratic[k]) + products[k]),
            error: linear_a * quadratic_b
                + quadratic_a * (linear_b + quadratic_b)
                + self.error * size_b
                + other.error * size_a
                + ROUNDING * size,
            size,
        }
    }
}

impl Mul<TaylorModel> for f64 {
    type Output = TaylorModel;
    #[inline(always)]
    fn mul(self, x: TaylorModel) -> TaylorModel {
        TaylorModel::sum([(self, &x)])
    }
}

#[cfg(test)]
mod tests {
    use acrobot::numpy::{Pcg64, uniform};

    use super::*;

    /// A model of random terms, large or small, one of the functions that it contains, and the
    /// value of that function at `t`.
    fn draw(rng: &mut Pcg64, t: [f64; 4]) -> (TaylorModel, f64) {
        let mut draw = |size: f64| size * uniform(rng, -1.0, 1.0);
        let [linear_size, quadratic_size, error_size] =
            [(); 3].map(|()| f64::exp2(draw(20.0) - 18.0));
        let mut model = TaylorModel::from(draw(2.0));
        model.linear = [(); 4].map(|()| draw(linear_size));
        model.quadratic = [(); 10].map(|()| draw(quadratic_size));
        model.error = draw(error_size).abs();
        model.size += model.radius();
        let [low, high] = model.range_at(t);
        // The edges are the extreme functions.
        let value = (low + high) / 2.0 + (high - low) / 2.0 * draw(1.5).clamp(-1.0, 1.0);
        (model, value)
    }

    /// Each operation, also roots and reciprocals where a part of the box is below the least
    /// number.
    #[test]
    fn models_contain_the_results_of_each_number() {
        const LEAST: f64 = 0.3;
        let mut rng = Pcg64::new(3);
        for _ in 0..200_000 {
            let t = [(); 4].map(|()| uniform(&mut rng, -4.0, 4.0).clamp(-1.0, 1.0));
            let [(x, a), (y, b)] = [(); 2].map(|()| draw(&mut rng, t));
            let contains =
                |model: TaylorModel, exact| model.assert_contains(t, exact, 1e-12 * model.size);
            contains(x, a);
            contains(x + y, a + b);
            contains(x - y, a - b);
            contains(x * y, a * b);
            contains(x.square(), a * a);
            let (sin, cos) = Reference::sin_cos(a);
            let [sine, cosine] = x.sin_cos();
            contains(sine, sin);
            contains(cosine, cos);
            if a >= LEAST {
                contains(x.sqrt(LEAST), a.sqrt());
                contains(x.inverse(LEAST), 1.0 / a);
            }
        }
    }
}
