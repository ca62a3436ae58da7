//! The distance of one column from the span of others, by orthogonalisation.
//!
//! d = ‖P⊥ a_g‖ in the inner product ⟨a,b⟩ = Σ u_w a_w b_w, P⊥ removing the span of the nuisance columns:
//! 1/d² is the Cramér–Rao bound of g with the nuisances unknown, [J⁻¹]_gg, without forming J or an
//! inverse, whose condition number is the square of this one's. Modified Gram–Schmidt, the last column
//! orthogonalised twice ('twice is enough'). Scale-free: a column may be in any unit. Lengths of the columns
//! come from the triangular factor, by Pythagoras, but for that of the last after more than [`FEW`] nuisances.
//!
//! Rounding: the columns come with a relative error of a few u per element (u = 2⁻⁵³), so the residual
//! carries about u(‖a_g‖ + Σ|cᵢ|‖aᵢ‖), cᵢ the coefficients of a_g on the nuisances. What is left of a nuisance carries
//! as much of its own, which turns its direction by δᵢ, and so the residual by δᵢ² of itself. Both together, the first
//! divided by the residual, are the reported relative error.
//!
//! A nuisance column that is zero, or of which less than [`DEPENDENT`] of that sum is left after removing the others,
//! is dropped and reported: what is left of it is rounding noise, which may have any direction. Unless it depends on the
//! others exactly, the distance is then too large by any factor: such a projection is [in doubt](Projector::in_doubt), and
//! is to be done again in more digits ([`careful`](super::careful)).
//!
//! Sources: paper S25–S29; Björck, Linear Algebra Appl. 197, 297 (1994), doi:10.1016/0024-3795(94)90493-6;
//! Giraud, Langou, Rozložník, Numer. Math. 101, 87 (2005), doi:10.1007/s00211-005-0615-4.

mod passes;

use self::passes::{Pass, eliminate, reduce_last};
use super::careful::{BLIND, Careful, back_substitute};
use crate::scene::Columns;
use crate::units::times_power_of_two;

/// Share of ‖aᵢ‖ + Σ|cⱼ|‖aⱼ‖ of a nuisance column below which what is left of it is rounding noise.
const DEPENDENT: f64 = 1e-14;
/// Σδᵢ² beyond which the directions of the nuisances are no longer orthogonal enough for lengths by Pythagoras.
const NEARLY_DEPENDENT: f64 = 1e-24;
/// Nuisances of which the length of the last column is left to Pythagoras.
const FEW: usize = 2;
/// Lengths between these square without losing digits at either end.
const SAFE_LENGTHS: std::ops::RangeInclusive<f64> = 1e-140..=1e140;
/// Rounding errors of an element and of the sums, in units of u; measured against 30-digit answers.
const ROUNDINGS: f64 = 6.0;
/// How much more of them there may be in the column asked for than in one of many: in few bands nothing is averaged out (19 u
/// is the most that was seen in 10⁷ cases).
const ALONE: f64 = 3.0;
const UNIT_ROUNDOFF: f64 = 0.5 * f64::EPSILON;
/// Relative rounding error beyond which a projection is done again in more digits.
const IN_DOUBT: f64 = 1e-9;

/// What is left of a column after the span of the others has been removed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Projection {
    /// ‖P⊥ a_g‖.
    pub residual: f64,
    /// ‖a_g‖: the same with no nuisance.
    pub norm: f64,
    /// a_g = Σ cᵢ aᵢ + residual vector; 0 for a dropped column.
    pub coefficients: Vec<f64>,
    /// Indices of the nuisance columns that were dropped as zero or dependent.
    pub dropped: Vec<usize>,
    /// Estimated bound on the relative rounding error of `residual`; above 1 nothing is known of it.
    pub relative_error: f64,
    /// Unit upper triangle and norms of the factorisation, row by row over all columns.
    triangle: Vec<f64>,
    norms: Vec<f64>,
}

impl Projection {
    /// Unit upper triangle, row by row, and the lengths its rows are to be multiplied by.
    pub(crate) fn factor(&self) -> (&[f64], &[f64]) {
        (&self.triangle, &self.norms)
    }

    /// Ratio of the largest to the smallest singular value of all columns scaled to unit length;
    /// infinite if a column was dropped or nothing is left.
    #[must_use]
    pub fn condition_number(&self) -> f64 {
        let n = self.norms.len();
        if !self.dropped.is_empty() || self.residual == 0.0 {
            return f64::INFINITY;
        }
        let mut factor = nalgebra::DMatrix::<f64>::zeros(n, n);
        for column in 0..n {
            for row in 0..=column {
                factor[(row, column)] = self.norms[row] * self.triangle[row * n + column];
            }
            let length = factor.column(column).norm();
            factor.column_mut(column).unscale_mut(length);
        }
        // With a limit on its iterations, which no number that is one ever reaches.
        match nalgebra::SVD::try_new(factor, false, false, f64::EPSILON, 1000) {
            Some(svd) => svd.singular_values.max() / svd.singular_values.min(),
            None => f64::INFINITY,
        }
    }
}

/// What [`Projector::reduce`] finds; the rest of a [`Projection`] stays in the projector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reduced {
    pub(crate) residual: f64,
    pub(crate) norm: f64,
    /// Estimated bounds on the relative rounding errors of the two.
    pub(crate) relative_error: f64,
    pub(crate) relative_error_norm: f64,
}

impl Reduced {
    const NOTHING: Self = Self { residual: 0.0, norm: 0.0, relative_error: 0.0, relative_error_norm: 0.0 };

    /// Whether what is left of the column is no more than the rounding of its own elements.
    pub(crate) fn is_nothing(&self) -> bool {
        self.residual * (1.0 + self.relative_error) <= BLIND * self.norm
    }

    /// Both lengths times a factor.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self { residual: factor * self.residual, norm: factor * self.norm, ..self }
    }

    /// The same where the nuisances are so many times less accurate than a few ulp.
    pub(crate) fn blurred(self, cancellation: f64) -> Self {
        Self { relative_error: cancellation * self.relative_error, ..self }
    }
}

/// Workspace that projects columns again and again without allocating much.
#[derive(Debug, Clone, Default)]
pub struct Projector {
    /// Inner products of the pivot with the columns, and the shares of it that are taken off them.
    dots: Vec<f64>,
    shares: Vec<f64>,
    /// ‖aᵢ‖², of what is left of each nuisance column; 0 if it was dropped.
    squares: Vec<f64>,
    /// ‖aᵢ‖ of the columns as they came.
    lengths: Vec<f64>,
    /// As in [`Projection`].
    triangle: Vec<f64>,
    norms: Vec<f64>,
    coefficients: Vec<f64>,
    dropped: Vec<usize>,
    /// Σδᵢ² of the directions that were kept.
    turned: f64,
    /// Whether there were as many directions as rows that count.
    full: bool,
}

impl Projector {
    /// Projects the last of `columns` (column after column, each as long as `weights`) off the others,
    /// in place: afterwards the columns are orthogonal to each other.
    ///
    /// `weights` are the u_w ≥ 0. `cancellation` ≥ 1 tells by how much the elements of the last column
    /// are less accurate than a few ulp.
    #[must_use]
    pub fn project(&mut self, columns: &mut [f64], weights: &[f64], cancellation: f64) -> Projection {
        let columns = Columns { values: columns, stride: weights.len() };
        let found = self.reduce(columns, weights, cancellation);
        self.projection(found)
    }

    /// Makes the columns orthogonal to each other, in place, to rounding whatever their angles; returns their
    /// lengths, 0 for those dropped as zero or dependent (which are cleared).
    pub(crate) fn orthogonalise(&mut self, values: &mut [f64], stride: usize, weights: &[f64]) -> &[f64] {
        let last = values.len().checked_div(stride).unwrap_or(0).saturating_sub(1);
        // Once leaves u·condition of the earlier ones in the later, except in the last, which is reduced twice as it
        // is; the second time starts from that.
        let rounds = if last < 2 { 1 } else { 2 };
        let (mut turned, mut dropped) = (0.0_f64, Vec::new());
        for _ in 0..rounds {
            let found = self.reduce(Columns { values, stride }, weights, 1.0);
            let Reduced { residual, norm, relative_error, .. } = found;
            // The same share of what it is made of as for those before it.
            let dependent = residual.is_nan()
                || residual <= DEPENDENT * norm
                || relative_error * DEPENDENT >= ROUNDINGS * UNIT_ROUNDOFF;
            turned = turned.max(self.turned + if dependent { 0.0 } else { relative_error * relative_error });
            if dependent && let Some(column) = values.get_mut(last * stride..) {
                column.fill(0.0);
                self.dropped.push(last);
                if let Some(norm) = self.norms.last_mut() {
                    *norm = 0.0;
                }
            }
            // The second time they are zero.
            dropped.extend(self.dropped.iter().filter(|&&i| self.lengths.get(i).is_some_and(|l| *l > 0.0)));
        }
        self.dropped = dropped;
        self.turned = turned;
        &self.norms
    }

    /// Whether the directions that the last call kept are known to about all digits.
    pub(crate) fn well_known(&self) -> bool {
        self.turned <= NEARLY_DEPENDENT
    }

    /// Length of the last column of the last call along what was left of nuisance i.
    pub(crate) fn along(&self, i: usize) -> f64 {
        let share = self.triangle.get((i + 1) * self.norms.len() - 1);
        share.zip(self.norms.get(i)).map_or(0.0, |(share, norm)| (share * norm).abs())
    }

    /// Whether nuisance i of the last call was zero.
    pub(crate) fn is_zero(&self, i: usize) -> bool {
        self.lengths.get(i).is_none_or(|length| *length == 0.0)
    }

    /// Columns other than zero that the last [`Projector::orthogonalise`] dropped.
    pub(crate) fn dropped(&self) -> &[usize] {
        &self.dropped
    }

    /// By how much rounding may have turned the directions that the last call kept, rad.
    pub(crate) fn turned(&self) -> f64 {
        self.turned.sqrt()
    }

    /// All there is to know about the last [`Projector::reduce`].
    pub(crate) fn projection(&self, found: Reduced) -> Projection {
        let Reduced { residual, norm, relative_error, .. } = found;
        Projection {
            residual,
            norm,
            coefficients: self.coefficients.clone(),
            dropped: self.dropped.clone(),
            relative_error,
            triangle: self.triangle.clone(),
            norms: self.norms.clone(),
        }
    }

    /// [`Projector::project`] without making a [`Projection`] of it.
    ///
    /// 1. Nuisance after nuisance is taken off all later columns.
    /// 2. All of them are taken off the last column once more, since the first time leaves a share of u·condition of
    ///    the nuisances in it.
    /// 3. What is left is the residual, and what it was made of its rounding error.
    pub(crate) fn reduce(&mut self, columns: Columns<'_>, weights: &[f64], cancellation: f64) -> Reduced {
        let Columns { values: columns, stride } = columns;
        let count = columns.len().checked_div(stride).unwrap_or(0);
        self.clear(count);
        let Some(last) = count.checked_sub(1) else {
            return Reduced::NOTHING;
        };
        let columns = &mut columns[..count * stride];
        // Pythagoras saves a pass, but wants orthogonal directions, which many nuisances may not have.
        let square = (last > FEW)
            .then(|| reduce_last(&mut columns[last * stride..], stride, weights, &[], &mut self.dots));
        let turned = self.orthogonalise_nuisances(columns, stride, weights);
        let once = self.take_last_nuisance_off(columns, stride, weights);
        let norm = square.map_or_else(|| length(&self.triangle, &self.norms, last, once), f64::sqrt);
        self.lengths[last] = norm;
        let twice = if last == 0 { once } else { self.take_nuisances_off_again(columns, stride, weights) };
        self.full = self.nothing_is_left(weights);
        let residual = if self.full { 0.0 } else { twice.sqrt() };
        self.triangle[count * count - 1] = 1.0;
        self.norms[last] = residual;

        back_substitute(&self.triangle, &self.norms, last, &mut self.coefficients);
        self.turned = turned;
        let noise = ROUNDINGS * UNIT_ROUNDOFF * (ALONE * cancellation * norm + self.carried(last));
        let relative_error = if residual > 0.0 { noise / residual + turned } else { 0.0 };
        let relative_error_norm =
            if norm > 0.0 { ALONE * ROUNDINGS * UNIT_ROUNDOFF * cancellation } else { 0.0 };
        Reduced { residual, norm, relative_error, relative_error_norm }
    }

    /// Makes the nuisance columns orthogonal to each other, and takes all but the last of them off the last column;
    /// Σδᵢ² of the directions that are kept.
    fn orthogonalise_nuisances(&mut self, columns: &mut [f64], stride: usize, weights: &[f64]) -> f64 {
        let count = self.norms.len();
        let mut turned = 0.0;
        for pivot in 0..count - 1 {
            eliminate(Pass { columns, stride, weights, pivot, shares: &self.shares, dots: &mut self.dots });
            let squared = self.dots[pivot];
            self.lengths[pivot] = length(&self.triangle, &self.norms, pivot, squared);
            self.triangle[pivot * count + pivot] = 1.0;
            self.shares.fill(0.0);
            let left = squared.sqrt();
            // Scaled before it is compared: the threshold is a share of the columns that it is made of.
            back_substitute(&self.triangle, &self.norms, pivot, &mut self.coefficients);
            let made_of = self.lengths[pivot] + self.carried(pivot);
            if left.is_nan() || left <= DEPENDENT * made_of {
                self.dropped.push(pivot);
                // It need not be finite, so that no share of it is small enough.
                columns[pivot * stride..(pivot + 1) * stride].fill(0.0);
                continue;
            }
            turned += (ROUNDINGS * UNIT_ROUNDOFF * made_of / left).powi(2);
            (self.norms[pivot], self.squares[pivot]) = (left, squared);
            for i in pivot + 1..count {
                self.shares[i] = self.dots[i] / squared;
                self.triangle[pivot * count + i] = self.shares[i];
            }
        }
        turned
    }

    /// Takes the last nuisance off the last column, as the others are already; the square of what is left of it, and
    /// in `dots` its inner products with all nuisances.
    fn take_last_nuisance_off(&mut self, columns: &mut [f64], stride: usize, weights: &[f64]) -> f64 {
        let last = self.norms.len() - 1;
        let share = self.shares[last];
        self.shares.fill(0.0);
        if let Some(last_pivot) = self.shares[..last].last_mut() {
            *last_pivot = share;
        }
        reduce_last(columns, stride, weights, &self.shares[..last], &mut self.dots)
    }

    /// Takes what `dots` still has of the nuisances off the last column; the square of what is left of it.
    fn take_nuisances_off_again(&mut self, columns: &mut [f64], stride: usize, weights: &[f64]) -> f64 {
        let (count, last) = (self.norms.len(), self.norms.len() - 1);
        for pivot in 0..last {
            let squared = self.squares[pivot];
            self.shares[pivot] = if squared > 0.0 { self.dots[pivot] / squared } else { 0.0 };
            self.triangle[pivot * count + last] += self.shares[pivot];
        }
        reduce_last(columns, stride, weights, &self.shares[..last], &mut self.dots)
    }

    /// Whether there are as many directions as rows that count: they leave nothing but rounding.
    fn nothing_is_left(&self, weights: &[f64]) -> bool {
        let count = self.norms.len();
        let kept = count - 1 - self.dropped.len();
        kept > 0 && kept >= weights.iter().filter(|&&weight| weight > 0.0).take(count).count()
    }

    /// Σ|cⱼ|‖aⱼ‖ of the coefficients of a column on those before it.
    fn carried(&self, column: usize) -> f64 {
        let parts = self.coefficients.iter().zip(&self.lengths).take(column);
        parts.map(|(c, length)| (c * length).abs()).sum()
    }

    /// Whether all lengths of the last [`Projector::reduce`] are good: none was so large or small that its square lost
    /// digits, be it of the column asked for, of those that were dropped, or of what is left of the others.
    pub(crate) fn in_range(&self, found: Reduced) -> bool {
        let dropped = self.dropped.iter().map(|&i| self.lengths[i]);
        let kept =
            self.norms.iter().take(self.norms.len().saturating_sub(1)).copied().filter(|left| *left > 0.0);
        (self.norms.len() > FEW + 1 || self.well_known())
            && found.residual.is_finite()
            && found.relative_error.is_finite()
            && dropped.chain(kept).chain([found.norm]).all(|length| SAFE_LENGTHS.contains(&length))
    }

    /// Whether the last [`Projector::reduce`] left digits, or a direction, to chance that more digits would settle;
    /// `dependent` tells whether a nuisance depends exactly on those before it.
    pub(crate) fn in_doubt(&self, found: Reduced, dependent: impl Fn(usize) -> bool) -> bool {
        let unsettled = |&i: &usize| self.lengths[i] > 0.0 && !dependent(i);
        // Leaving out fewer nuisances would leave even less.
        let nothing = self.full || found.residual == 0.0 && found.norm == 0.0 || found.is_nothing();
        let rough = found.relative_error.is_nan() || found.relative_error > IN_DOUBT;
        !nothing && (rough || self.dropped.iter().any(unsettled))
    }

    /// Takes what more digits have found for what the last [`Projector::reduce`] did; lengths stay divided by the powers of
    /// two that come with it.
    pub(crate) fn adopt_scaled(&mut self, careful: Careful) -> Reduced {
        let Careful { residual, norm, relative_error, .. } = careful;
        self.lengths = careful.lengths;
        self.norms = careful.norms;
        self.triangle = careful.triangle;
        self.coefficients = careful.coefficients;
        self.dropped = careful.dropped;
        (self.turned, self.full) = (0.0, false);
        let relative_error_norm = if norm > 0.0 { 8.0 * f64::EPSILON } else { 0.0 };
        Reduced { residual, norm, relative_error, relative_error_norm }
    }

    /// [`Projector::adopt_scaled`] in the columns' own units.
    pub(crate) fn adopt(&mut self, careful: Careful) -> Reduced {
        let powers = careful.powers.clone();
        let found = self.adopt_scaled(careful);
        self.unscale(&powers, found)
    }

    /// Takes back that column i was divided by 2 to the power `powers[i]` before it was reduced.
    pub(crate) fn unscale(&mut self, powers: &[i32], found: Reduced) -> Reduced {
        let Some(last) = powers.last() else { return found };
        for (c, power) in self.coefficients.iter_mut().zip(powers) {
            *c = times_power_of_two(*c, last - power).clamp(f64::MIN, f64::MAX);
        }
        let [residual, norm] = [found.residual, found.norm].map(|length| times_power_of_two(length, *last));
        Reduced { residual, norm, ..found }
    }

    /// Zeros for `count` columns.
    fn clear(&mut self, count: usize) {
        for work in [&mut self.dots, &mut self.shares, &mut self.squares, &mut self.lengths, &mut self.norms]
        {
            work.clear();
            work.resize(count, 0.0);
        }
        self.triangle.clear();
        self.triangle.resize(count * count, 0.0);
        self.coefficients.clear();
        self.coefficients.resize(count.saturating_sub(1), 0.0);
        self.dropped.clear();
    }
}

/// ‖aᵢ‖ by Pythagoras, from the parts of it along the pivots and the square of what is left.
fn length(triangle: &[f64], norms: &[f64], column: usize, squared: f64) -> f64 {
    let parts = norms[..column].iter().enumerate().map(|(pivot, norm)| {
        let part = triangle[pivot * norms.len() + column] * norm;
        part * part
    });
    (squared + parts.sum::<f64>()).sqrt()
}

#[cfg(test)]
mod tests;
