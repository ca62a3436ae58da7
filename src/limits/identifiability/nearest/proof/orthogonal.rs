//! Few long columns made orthonormal, so that nearly dependent ones keep their digits.

use super::vectors::{add_into, divide};
use crate::aligned::Aligned;
use crate::few::{Few, FewColumns};
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
type Reduced = (FewColumns, FewColumns);

/// Makes columns orthonormal (Gram and Schmidt, again where much cancels) and gives the triangle R of columns = QR, column by
/// column, what depends on earlier columns left out, and for each of `others` Qᵀother followed by what is left of its length.
///
/// Source: L. Giraud et al., Numerische Mathematik 101, 87 (2005), doi:10.1007/s00211-005-0615-4: twice is enough.
pub(super) fn reduce<C: DerefMut<Target = [f64]>>(columns: &mut [C], others: &[&[f64]]) -> Reduced {
    let size = columns.len();
    let mut triangle = FewColumns::zeros(size, size);
    for k in 0..size {
        let (done, rest) = columns.split_at_mut(k);
        let (column, above) = (&mut rest[0], &mut triangle[k]);
        let before = dot(column, column).sqrt();
        let left = take_out(done, column, before, above);
        if !before.is_finite() {
            // Beyond what numbers hold: nothing may be said of it.
            above[k] = f64::NAN;
        } else if left > DEPENDENT * before {
            above[k] = left;
            divide(column, left);
        } else {
            column.fill(0.0);
        }
    }
    let mut reduced = FewColumns::zeros(size + 1, others.len());
    for (i, other) in others.iter().enumerate() {
        let mut rest = Few::from(*other);
        let before = dot(other, other).sqrt();
        reduced[i][size] = take_out(columns, &mut rest, before, &mut reduced[i]);
    }
    (triangle, reduced)
}

/// What [`reduce`] finds, by products of the columns, which stay as they are; `None` where too many digits would cancel.
pub(super) fn reduced(columns: &[Aligned], others: &[&[f64]]) -> Option<Reduced> {
    let size = columns.len();
    // Cholesky's factor, column by column; of the others the same column without its end.
    let fit = |column: &[f64], triangle: &FewColumns, above: &mut [f64]| {
        for j in 0..above.len() {
            let rest = dot(&columns[j], column) - inner(&triangle[j][..j], &above[..j]);
            above[j] = rest / triangle[j][j];
        }
        let square = dot(column, column);
        (square - inner(above, above), square)
    };
    let mut triangle = FewColumns::zeros(size, size);
    for (k, column) in columns.iter().enumerate() {
        let mut above = Few::zeros(k);
        let (rest, square) = fit(column, &triangle, &mut above);
        if !(rest > CANCELLED * square && rest.is_finite()) {
            return None;
        }
        triangle[k][..k].copy_from_slice(&above);
        triangle[k][k] = rest.sqrt();
    }
    let mut reduced = FewColumns::zeros(size + 1, others.len());
    for (i, other) in others.iter().enumerate() {
        let (rest, square) = fit(other, &triangle, &mut reduced[i][..size]);
        // No less than it is.
        reduced[i][size] = (rest.max(0.0) + ROUNDING * square).sqrt();
    }
    Some((triangle, reduced))
}

/// Makes columns orthonormal by their triangle.
pub(super) fn orthonormalise(columns: &mut [Aligned], triangle: &FewColumns) {
    for (k, above) in triangle.iter().enumerate() {
        let (done, rest) = columns.split_at_mut(k);
        done.iter().zip(above).for_each(|(column, part)| add_into(-part, column, &mut rest[0]));
        divide(&mut rest[0], above[k]);
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
