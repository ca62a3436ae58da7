//! Few long columns made orthonormal, so that nearly dependent ones keep their digits.

use super::vectors::add_into;
use crate::aligned::Aligned;
use crate::sum::dot;
use std::ops::{Deref, DerefMut};

/// What is left of a column, as a share, below which it depends on those before.
const DEPENDENT: f64 = 1e-15;
/// Share of a column that must be left after one pass for it to be orthogonal to rounding without another one.
const ENOUGH: f64 = 0.5;

/// What must be left of the square of a length for products to keep nine digits of it.
const CANCELLED: f64 = 1e-6;
/// Rounding of such a square, as a share of what it is left of.
const ROUNDING: f64 = 1e-14;

/// Σ aᵢbᵢ of a few numbers.
pub(super) fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// to += factor · x, of a few numbers.
pub(super) fn add(to: &mut [f64], factor: f64, x: &[f64]) {
    to.iter_mut().zip(x).for_each(|(to, x)| *to += factor * x);
}

/// R⁻¹x in place, `entry` the rows and columns of R; 0 along what depends on earlier columns.
pub(super) fn back_substitute(entry: impl Fn(usize, usize) -> f64, x: &mut [f64]) {
    for k in (0..x.len()).rev() {
        let later: f64 = (k + 1..x.len()).map(|j| entry(k, j) * x[j]).sum();
        let pivot = entry(k, k);
        x[k] = if pivot > 0.0 { (x[k] - later) / pivot } else { 0.0 };
    }
}

/// R column by column, and of each other column what lies along the basis, followed by what is left of its length.
type Reduced = (Vec<Vec<f64>>, Vec<Vec<f64>>);

/// Makes columns orthonormal (Gram and Schmidt, again where much cancels) and gives the triangle R of columns = QR, column by
/// column, what depends on earlier columns left out, and for each of `others` Qᵀother followed by what is left of its length.
///
/// Source: L. Giraud et al., Numerische Mathematik 101, 87 (2005), doi:10.1007/s00211-005-0615-4: twice is enough.
pub(super) fn reduce<C: DerefMut<Target = [f64]>>(columns: &mut [C], others: &[&[f64]]) -> Reduced {
    let size = columns.len();
    let mut triangle = vec![vec![0.0; size]; size];
    for (k, above) in triangle.iter_mut().enumerate() {
        let (done, rest) = columns.split_at_mut(k);
        let column = &mut rest[0];
        let before = dot(column, column).sqrt();
        let left = take_out(done, column, before, above);
        if !before.is_finite() {
            // Beyond what numbers hold: nothing may be said of it.
            above[k] = f64::NAN;
        } else if left > DEPENDENT * before {
            above[k] = left;
            column.iter_mut().for_each(|x| *x /= left);
        } else {
            column.fill(0.0);
        }
    }
    let reduced = others.iter().map(|other| {
        let mut rest = other.to_vec();
        let mut along = vec![0.0; size + 1];
        let before = dot(other, other).sqrt();
        along[size] = take_out(columns, &mut rest, before, &mut along);
        along
    });
    let reduced = reduced.collect();
    (triangle, reduced)
}

/// What [`reduce`] finds, by products of the columns, which stay as they are; `None` where too many digits would cancel.
pub(super) fn reduced(columns: &[Aligned], others: &[&[f64]]) -> Option<Reduced> {
    let size = columns.len();
    // Cholesky's factor, column by column; of the others the same column without its end.
    let along = |column: &[f64], triangle: &[Vec<f64>], count: usize| -> Vec<f64> {
        let mut above = vec![0.0; size + 1];
        for j in 0..count {
            let rest = dot(&columns[j], column) - inner(&triangle[j][..j], &above[..j]);
            above[j] = rest / triangle[j][j];
        }
        above
    };
    let left = |column: &[f64], above: &[f64]| {
        let square = dot(column, column);
        let rest = square - inner(above, above);
        (rest, square)
    };
    let mut triangle: Vec<Vec<f64>> = Vec::with_capacity(size);
    for (k, column) in columns.iter().enumerate() {
        let mut above = along(column, &triangle, k);
        let (rest, square) = left(column, &above);
        if !(rest > CANCELLED * square && rest.is_finite()) {
            return None;
        }
        above[k] = rest.sqrt();
        above.truncate(size);
        triangle.push(above);
    }
    let others = others.iter().map(|other| {
        let mut above = along(other, &triangle, size);
        let (rest, square) = left(other, &above);
        // No less than it is.
        above[size] = (rest.max(0.0) + ROUNDING * square).sqrt();
        above
    });
    let others = others.collect();
    Some((triangle, others))
}

/// Makes columns orthonormal by their triangle.
pub(super) fn orthonormalise(columns: &mut [Aligned], triangle: &[Vec<f64>]) {
    for (k, above) in triangle.iter().enumerate() {
        let (done, rest) = columns.split_at_mut(k);
        done.iter().zip(above).for_each(|(column, part)| add_into(-part, column, &mut rest[0]));
        rest[0].iter_mut().for_each(|x| *x /= above[k]);
    }
}

/// Takes what lies along orthonormal columns out of another one of length `before`; what is left of its length.
fn take_out(
    columns: &[impl Deref<Target = [f64]>],
    other: &mut [f64],
    before: f64,
    along: &mut [f64],
) -> f64 {
    crate::stop::check();
    let mut left = before;
    if columns.is_empty() {
        return left;
    }
    for _ in 0..2 {
        for (along, column) in along.iter_mut().zip(columns) {
            let part = dot(column, other);
            *along += part;
            add_into(-part, column, other);
        }
        let had = left;
        left = dot(other, other).sqrt();
        if left > ENOUGH * had {
            break;
        }
    }
    left
}
