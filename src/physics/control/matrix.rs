//! Algebra of 4×4 matrices, without indices that could be out of bounds.

use core::mem::swap;

use super::super::rk4::Along;
use crate::arithmetic::Real;
use crate::error::Error;

/// Rows.
pub type Matrix<S = f64> = [[S; 4]; 4];

pub fn identity<S: Real>() -> Matrix<S> {
    let (one, zero) = (S::ONE, S::ZERO);
    [
        [one, zero, zero, zero],
        [zero, one, zero, zero],
        [zero, zero, one, zero],
        [zero, zero, zero, one],
    ]
}

pub fn dot<S: Real>([x1, x2, x3, x4]: [S; 4], [y1, y2, y3, y4]: [S; 4]) -> S {
    x1 * y1 + x2 * y2 + x3 * y3 + x4 * y4
}

pub fn transpose<S: Copy>([p, q, r, s]: &Matrix<S>) -> Matrix<S> {
    [
        [p[0], q[0], r[0], s[0]],
        [p[1], q[1], r[1], s[1]],
        [p[2], q[2], r[2], s[2]],
        [p[3], q[3], r[3], s[3]],
    ]
}

/// Rejects elements that are not finite.
pub fn check_finite<S: Real>(name: &'static str, elements: &[S]) -> Result<(), Error> {
    match elements.iter().find(|x| !x.is_finite()) {
        Some(x) => Err(Error::NotFinite {
            name,
            value: x.to_f64(),
        }),
        None => Ok(()),
    }
}

/// x yᵀ.
pub fn outer(x: [f64; 4], y: [f64; 4]) -> Matrix {
    x.map(|x| y.map(|y| x * y))
}

/// m x.
pub fn apply(m: &Matrix, x: [f64; 4]) -> [f64; 4] {
    m.map(|row| dot(row, x))
}

/// x y.
#[inline(never)] // saves flash: `lqr` calls it in many places
pub fn product(x: &Matrix, y: &Matrix) -> Matrix {
    let columns = transpose(y);
    x.map(|row| columns.map(|column| dot(row, column)))
}

/// xᵀ m x for a symmetric m.
pub fn congruence(m: &Matrix, x: &Matrix) -> Matrix {
    symmetric(&product(&transpose(x), &product(m, x)))
}

/// x + h y.
#[inline(never)] // saves flash
pub fn sum(mut x: Matrix, h: f64, y: &Matrix) -> Matrix {
    for (x, y) in x.iter_mut().zip(y) {
        *x = x.along(h, *y);
    }
    x
}

/// (m + mᵀ) / 2.
pub fn symmetric(m: &Matrix) -> Matrix {
    sum(*m, 1.0, &transpose(m)).map(|row| row.map(|x| 0.5 * x))
}

/// The largest absolute value of an element; NaN does not count.
pub fn largest(elements: &[f64]) -> f64 {
    elements.iter().fold(0.0, |most, x| x.abs().max(most))
}

pub fn is_finite(m: &Matrix) -> bool {
    m.as_flattened().iter().all(|x| x.is_finite())
}

/// X with `w` X = `y`, by Gauss-Jordan elimination with partial pivoting. It is not finite if `w` is singular.
#[inline(never)] // saves flash
pub fn solve(w: &Matrix, y: &Matrix) -> Option<Matrix> {
    let [w1, w2, w3, w4] = *w;
    let [y1, y2, y3, y4] = *y;
    let mut rows = [(w1, y1), (w2, y2), (w3, y3), (w4, y4)];
    for column in 0..4 {
        let (above, rest) = rows.split_at_mut_checked(column)?;
        let (pivot, below) = rest.split_first_mut()?;
        for row in &mut *below {
            if row.0.get(column)?.abs() > pivot.0.get(column)?.abs() {
                swap(row, pivot);
            }
        }
        let inverse = 1.0 / *pivot.0.get(column)?;
        *pivot = (pivot.0.map(|x| x * inverse), pivot.1.map(|x| x * inverse));
        for row in above.iter_mut().chain(below) {
            let factor = -*row.0.get(column)?;
            *row = (row.0.along(factor, pivot.0), row.1.along(factor, pivot.1));
        }
    }
    Some(rows.map(|(_, x)| x))
}
