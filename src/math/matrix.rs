//! Algebra of 4×4 matrices, without indices that could be out of bounds.

use core::mem::swap;
use core::ops::{Add, Mul};

use super::real::Real;
use crate::error::Error;

/// Rows.
pub type Matrix<S = f64> = [[S; 4]; 4];

pub fn identity<S: Real>() -> Matrix<S> {
    let [x, o] = [S::ONE, S::ZERO];
    [[x, o, o, o], [o, x, o, o], [o, o, x, o], [o, o, o, x]]
}

pub fn diagonal<S: Copy>(m: &Matrix<S>) -> [S; 4] {
    [m[0][0], m[1][1], m[2][2], m[3][3]]
}

pub fn dot<S>([x1, x2, x3, x4]: [S; 4], [y1, y2, y3, y4]: [S; 4]) -> S
where
    S: Add<Output = S> + Mul<Output = S>,
{
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
        Some(x) => Err(Error::NotFinite { name, value: x.to_f64() }),
        None => Ok(()),
    }
}

// What is not inlined saves flash where each operation is a call.

/// x · y.
#[inline(never)]
pub fn inner<S>(x: &[S; 4], y: &[S; 4]) -> S
where
    S: Copy + Add<Output = S> + Mul<Output = S>,
{
    dot(*x, *y)
}

/// x += h y.
#[inline(never)]
pub fn add_scaled<S>(x: &mut [S; 4], h: S, y: &[S; 4])
where
    S: Copy + Add<Output = S> + Mul<Output = S>,
{
    for (x, y) in x.iter_mut().zip(y) {
        *x = *x + h * *y;
    }
}

/// m x.
#[inline(never)]
pub fn apply<S>(m: &Matrix<S>, x: &[S; 4]) -> [S; 4]
where
    S: Copy + Add<Output = S> + Mul<Output = S>,
{
    let mut result = *x;
    for (result, row) in result.iter_mut().zip(m) {
        *result = inner(row, x);
    }
    result
}

/// m += h x yᵀ.
#[inline(never)]
pub fn add_outer<S: Real>(m: &mut Matrix<S>, h: S, x: &[S; 4], y: &[S; 4]) {
    for (row, x) in m.iter_mut().zip(x) {
        add_scaled(row, h * *x, y);
    }
}

/// m += h x.
#[inline(never)]
pub fn add<S: Real>(m: &mut Matrix<S>, h: S, x: &Matrix<S>) {
    for (row, x) in m.iter_mut().zip(x) {
        add_scaled(row, h, x);
    }
}

/// m *= h.
#[inline(never)]
pub fn scale<S: Real>(m: &mut Matrix<S>, h: S) {
    for x in m.as_flattened_mut() {
        *x = *x * h;
    }
}

/// The matrix with this diagonal and zeros.
#[inline(never)]
pub fn spread<S: Real>(diagonal: [S; 4]) -> Matrix<S> {
    let mut result = [[S::ZERO; 4]; 4];
    let places = result.as_flattened_mut().iter_mut().step_by(5);
    places.zip(diagonal).for_each(|(place, x)| *place = x);
    result
}

/// m becomes (m + mᵀ) / 2.
#[inline(never)]
pub fn symmetrize<S: Real>(m: &mut Matrix<S>) {
    let transposed = transpose(m);
    add(m, S::ONE, &transposed);
    scale(m, S::HALF);
}

// From here on all is `f64`.

/// x y.
#[inline(never)]
pub fn product(x: &Matrix, y: &Matrix) -> Matrix {
    let columns = transpose(y);
    let mut result = [[0.0; 4]; 4];
    for (result, row) in result.iter_mut().zip(x) {
        *result = apply(&columns, row);
    }
    result
}

/// xᵀ m x for a symmetric m.
#[inline(never)]
pub fn congruence(m: &Matrix, x: &Matrix) -> Matrix {
    // (m x)ᵀ x, whose transpose is the same.
    let mut result = product(&transpose(&product(m, x)), x);
    symmetrize(&mut result);
    result
}

/// The largest absolute value of an element; NaN does not count.
#[inline(never)]
pub fn largest(elements: &[f64]) -> f64 {
    elements.iter().fold(0.0, |most, x| x.abs().max(most))
}

/// w⁻¹ x and w⁻¹ y, which are not finite if w is singular.
#[inline(never)]
pub fn divide(w: &Matrix, x: &Matrix, y: &Matrix) -> Option<[Matrix; 2]> {
    let mut rows = [[w[0], x[0], y[0]], [w[1], x[1], y[1]], [w[2], x[2], y[2]], [w[3], x[3], y[3]]];
    eliminate(&mut rows)?;
    Some([rows.map(|[_, x, _]| x), rows.map(|[_, _, y]| y)])
}

/// Gauss-Jordan elimination with partial pivoting of rows of w, x and y.
#[inline(never)]
fn eliminate(rows: &mut [[[f64; 4]; 3]; 4]) -> Option<()> {
    for column in 0..4 {
        let (above, rest) = rows.split_at_mut_checked(column)?;
        let (pivot, below) = rest.split_first_mut()?;
        for row in &mut *below {
            if row[0].get(column)?.abs() > pivot[0].get(column)?.abs() {
                swap(row, pivot);
            }
        }
        let inverse = 1.0 / *pivot[0].get(column)?;
        for x in pivot.as_flattened_mut() {
            *x *= inverse;
        }
        for row in above.iter_mut().chain(below) {
            let factor = -*row[0].get(column)?;
            for (x, pivot) in row.iter_mut().zip(&*pivot) {
                add_scaled(x, factor, pivot);
            }
        }
    }
    Some(())
}
