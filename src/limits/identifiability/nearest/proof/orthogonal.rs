//! Few long columns made orthonormal, so that nearly dependent ones keep their digits.

use super::vectors::add_into;
use crate::sum::dot;

/// What is left of a column, as a share, below which it depends on those before.
const DEPENDENT: f64 = 1e-15;
/// Share of a column that must be left after one pass for it to be orthogonal to rounding without another one.
const ENOUGH: f64 = 0.5;

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

/// Makes columns orthonormal (Gram and Schmidt, again where much cancels) and gives the triangle R of columns = QR, column by
/// column, what depends on earlier columns left out, and for each of `others` Qᵀother followed by what is left of its length.
///
/// Source: L. Giraud et al., Numerische Mathematik 101, 87 (2005), doi:10.1007/s00211-005-0615-4: twice is enough.
pub(super) fn reduce(columns: &mut [Vec<f64>], others: &[&[f64]]) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
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

/// Takes what lies along orthonormal columns out of another one of length `before`; what is left of its length.
fn take_out(columns: &[Vec<f64>], other: &mut [f64], before: f64, along: &mut [f64]) -> f64 {
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
