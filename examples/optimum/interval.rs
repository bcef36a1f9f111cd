//! Interval arithmetic: each result contains the exact result for all numbers of the operands. And its derivatives.

use std::array::from_fn;
use std::f64::consts::PI;
use std::ops::{Add, Mul, Sub};

use acrobot::arithmetic::{Arithmetic, Reference};

/// The numbers from `low` to `high`.
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    pub fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// One representable number.
    pub fn point(x: f64) -> Self {
        Self::new(x, x)
    }

    /// Rounded results, enlarged to contain the exact ones.
    fn around(low: f64, high: f64) -> Self {
        assert!(high - low < f64::INFINITY, "finite numbers");
        Self::new(low.next_down(), high.next_up())
    }

    pub fn middle(self) -> f64 {
        (self.low + self.high) / 2.0
    }

    /// The nonzero reciprocal.
    fn inverse(self) -> Self {
        assert!(
            self.low > 0.0,
            "no interval of this program that divides has 0"
        );
        Self::around(1.0 / self.high, 1.0 / self.low)
    }

    fn sqrt(self) -> Self {
        Self::around(self.low.sqrt(), self.high.sqrt())
    }

    fn sin_cos(self) -> [Self; 2] {
        // `Reference` rounds correctly.
        let [(sin1, cos1), (sin2, cos2)] = [self.low, self.high].map(Reference::sin_cos);
        let ends = [(sin1, sin2, 0.5), (cos1, cos2, 0.0)];
        ends.map(|(a, b, crest): (f64, f64, f64)| {
            let turns = |x: f64| x / (2.0 * PI);
            // Whether a crest, at any whole number of turns, may be inside.
            let has = |crest: f64| {
                const ERROR: f64 = 1e-12;
                let low = (turns(self.low) - crest - ERROR).ceil();
                low <= turns(self.high) - crest + ERROR
            };
            let high = if has(crest / 2.0) {
                1.0
            } else {
                a.max(b).next_up()
            };
            let low = if has(crest / 2.0 + 0.5) {
                -1.0
            } else {
                a.min(b).next_down()
            };
            Self::new(low, high)
        })
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::around(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::around(self.low - other.high, self.high - other.low)
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let [a, b] = [self.low * other.low, self.low * other.high];
        let [c, d] = [self.high * other.low, self.high * other.high];
        Self::around(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }
}

/// A function over a box: its values, and those of its `N` partial derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Jet<const N: usize> {
    pub value: Interval,
    pub slopes: [Interval; N],
}

impl<const N: usize> Jet<N> {
    pub fn constant(x: f64) -> Self {
        Self {
            value: Interval::point(x),
            slopes: [Interval::point(0.0); N],
        }
    }

    /// The numbers that the functions depend on. The derivatives are those with respect to the first `N`.
    pub fn variables(ranges: [Interval; 4]) -> [Self; 4] {
        from_fn(|i| {
            let slopes = from_fn(|j| Interval::point(if i == j { 1.0 } else { 0.0 }));
            Self {
                value: ranges[i],
                slopes,
            }
        })
    }

    /// f(self), given the values of f and of its derivative.
    fn chain(self, value: Interval, derivative: Interval) -> Self {
        Self {
            value,
            slopes: self.slopes.map(|slope| slope * derivative),
        }
    }

    fn product(self, other: Self) -> Self {
        let slopes = from_fn(|i| self.slopes[i] * other.value + self.value * other.slopes[i]);
        Self {
            value: self.value * other.value,
            slopes,
        }
    }

    pub fn sin_cos(self) -> [Self; 2] {
        let [sin, cos] = self.value.sin_cos();
        [
            self.chain(sin, cos),
            self.chain(cos, Interval::point(0.0) - sin),
        ]
    }

    pub fn inverse(self) -> Self {
        let inverse = self.value.inverse();
        self.chain(inverse, Interval::point(0.0) - inverse * inverse)
    }

    /// The square root, of a function that is at least `least`, which is above 0.
    pub fn sqrt(self, least: f64) -> Self {
        let value = Interval::new(self.value.low.max(least), self.value.high.max(least)).sqrt();
        self.chain(value, Interval::point(0.5) * value.inverse())
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let slopes = from_fn(|i| self.slopes[i] + other.slopes[i]);
        Self {
            value: self.value + other.value,
            slopes,
        }
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        let slopes = from_fn(|i| self.slopes[i] - other.slopes[i]);
        Self {
            value: self.value - other.value,
            slopes,
        }
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.product(other)
    }
}

impl<const N: usize> Mul<Jet<N>> for f64 {
    type Output = Jet<N>;
    fn mul(self, jet: Jet<N>) -> Jet<N> {
        let x = Interval::point(self);
        Jet {
            value: x * jet.value,
            slopes: jet.slopes.map(|slope| x * slope),
        }
    }
}
