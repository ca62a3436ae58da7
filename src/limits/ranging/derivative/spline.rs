//! Derivatives at the knots of the interpolating cubic spline.
//!
//! With slopes m and unit spacing, continuity of the second derivative asks m[x−1] + 4 m[x] + m[x+1] = 3(N[x+1] −
//! N[x−1]); that of the third at the second knot, with the first of these, m[0] + 2 m[1] = (5(N[1] − N[0]) + (N[2]
//! − N[1]))/2, and its mirror image at the other end. The pivots of the elimination lie between 2 and 4, but for
//! the first (1) and the last (2 − √3 + …, at least 3/7), so no exchange of rows is needed.

use crate::simd::dispatched;

/// The elimination of the system for rows of a certain length: reciprocal pivots.
#[derive(Debug, Clone)]
pub(super) struct Spline {
    reciprocal: Vec<f64>,
}

impl Spline {
    /// For at least 4 columns.
    pub(super) fn new(columns: usize) -> Self {
        let mut reciprocal = Vec::with_capacity(columns);
        reciprocal.push(1.0);
        let (mut above, last) = (2.0, columns - 1);
        for x in 1..columns {
            // The row above reads pivot, `above`; this one 1, 4, 1, the last one 2, 1.
            let before: f64 = reciprocal[x - 1];
            let pivot = if x == last { 1.0 - 2.0 * before } else { 4.0 - above * before };
            reciprocal.push(pivot.recip());
            above = 1.0;
        }
        Self { reciprocal }
    }

    pub(super) fn apply(&self, row: &[f64], bands: usize, slope: &mut [f64]) {
        solve(&self.reciprocal, row, bands, slope);
    }
}

dispatched! {
    /// Elimination and back substitution, all bands side by side.
    fn solve<'a>(reciprocal: &'a [f64], row: &'a [f64], bands: usize, slope: &'a mut [f64]) {
        let last = reciprocal.len() - 1;
        let at = |x: usize| &row[x * bands..(x + 1) * bands];
        for (x, pivot) in reciprocal.iter().enumerate() {
            let (done, rest) = slope.split_at_mut(x * bands);
            let here = &mut rest[..bands];
            if x == 0 || x == last {
                let (end, next, third) =
                    if x == 0 { (at(0), at(1), at(2)) } else { (at(x), at(x - 1), at(x - 2)) };
                let sign = if x == 0 { 0.5 } else { -0.5 };
                for (here, ((end, next), third)) in here.iter_mut().zip(end.iter().zip(next).zip(third)) {
                    *here = sign * 5.0f64.mul_add(next - end, third - next);
                }
            } else {
                for (here, (before, after)) in here.iter_mut().zip(at(x - 1).iter().zip(at(x + 1))) {
                    *here = 3.0 * (after - before);
                }
            }
            if let Some(start) = done.len().checked_sub(bands) {
                let factor: f64 = if x == last { -2.0 } else { -1.0 };
                for (here, above) in here.iter_mut().zip(&done[start..]) {
                    *here = factor.mul_add(*above, *here);
                }
            }
            // Stored over the pivot, so that the next row subtracts it as it is.
            for here in here.iter_mut() {
                *here *= pivot;
            }
        }
        for x in (0..last).rev() {
            let (here, after) = slope[x * bands..].split_at_mut(bands);
            let factor: f64 = if x == 0 { -2.0 } else { -reciprocal[x] };
            for (here, after) in here.iter_mut().zip(&after[..bands]) {
                *here = factor.mul_add(*after, *here);
            }
        }
    }
}
