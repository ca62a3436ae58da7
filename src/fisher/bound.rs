//! The distance of one column from the span of others, by orthogonalisation.
//!
//! d = ‖P⊥ a_g‖ in the inner product ⟨a,b⟩ = Σ u_w a_w b_w, P⊥ removing the span of the nuisance columns:
//! 1/d² is the Cramér–Rao bound of g with the nuisances unknown, [J⁻¹]_gg, without forming J or an
//! inverse, whose condition number is the square of this one's. Modified Gram–Schmidt, the last column
//! orthogonalised twice ('twice is enough'). Scale-free: a column may be in any unit.
//!
//! A nuisance column that is zero, or of which less than [`DEPENDENT`] is left after removing the others,
//! is dropped and reported.
//!
//! Rounding: the columns come with a relative error of a few u per element (u = 2⁻⁵³), so the residual
//! carries about u(‖a_g‖ + Σ|cᵢ|‖aᵢ‖), cᵢ the coefficients of a_g on the nuisances. Divided by the residual
//! this is the reported relative error.
//!
//! Sources: paper S25–S29; Björck, Linear Algebra Appl. 197, 297 (1994), doi:10.1016/0024-3795(94)90493-6;
//! Giraud, Langou, Rozložník, Numer. Math. 101, 87 (2005), doi:10.1007/s00211-005-0615-4.

use crate::simd::dispatched;
use crate::sum::{BLOCK, Compensated, LANES, fold};

/// Share of a nuisance column below which what is left of it is rounding noise.
const DEPENDENT: f64 = 1e-14;
/// Rounding errors of an element and of the sums, in units of u; measured against 30-digit answers.
const ROUNDINGS: f64 = 4.0;
const UNIT_ROUNDOFF: f64 = 0.5 * f64::EPSILON;

/// What is left of a column after the span of the others has been removed.
#[derive(Debug, Clone, PartialEq)]
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
        let values = factor.singular_values();
        values.max() / values.min()
    }
}

/// Workspace that projects columns again and again without allocating.
#[derive(Debug, Clone, Default)]
pub struct Projector {
    columns: Vec<f64>,
    weights: Vec<f64>,
    /// Dot products of the pivot with itself and the later columns.
    dots: Vec<f64>,
}

impl Projector {
    /// Projects the last of `columns` (column after column, each as long as `weights`) off the others.
    ///
    /// `weights` are the u_w ≥ 0. `cancellation` ≥ 1 tells by how much the elements of the last column
    /// are less accurate than a few ulp.
    #[must_use]
    pub fn project(&mut self, columns: &[f64], weights: &[f64], cancellation: f64) -> Projection {
        let rows = weights.len();
        let count = if rows == 0 { 0 } else { columns.len() / rows };
        if count == 0 {
            return Projection {
                residual: 0.0,
                norm: 0.0,
                coefficients: Vec::new(),
                dropped: Vec::new(),
                relative_error: 0.0,
                triangle: Vec::new(),
                norms: Vec::new(),
            };
        }
        self.columns.clear();
        self.columns.extend_from_slice(&columns[..count * rows]);
        self.weights.clear();
        self.weights.extend_from_slice(weights);
        self.dots.resize(count, 0.0);

        let last = count - 1;
        let mut triangle = vec![0.0; count * count];
        let mut norms = vec![0.0; count];
        let mut lengths = vec![0.0; count];
        let mut dropped = Vec::new();
        for (i, length) in lengths.iter_mut().enumerate() {
            let column = &columns[i * rows..(i + 1) * rows];
            *length = square(column, weights).sqrt();
        }
        for pivot in 0..last {
            let (head, tail) = self.columns.split_at_mut((pivot + 1) * rows);
            let column = &head[pivot * rows..];
            let squared = square(column, &self.weights);
            triangle[pivot * count + pivot] = 1.0;
            let left = squared.sqrt();
            // Scaled before it is compared: the threshold is a share of the column's own length.
            if left.is_nan() || left <= DEPENDENT * lengths[pivot] {
                dropped.push(pivot);
                continue;
            }
            norms[pivot] = left;
            for (i, other) in tail.chunks_exact_mut(rows).enumerate() {
                let factor = weighted_dot(column, other, &self.weights) / squared;
                subtract(column, factor, other);
                triangle[pivot * count + pivot + 1 + i] = factor;
            }
        }
        // Once more for the last column: the first pass leaves a share of u·condition of the nuisances in it.
        let (nuisances, goal) = self.columns.split_at_mut(last * rows);
        for (pivot, column) in nuisances.chunks_exact(rows).enumerate() {
            if norms[pivot] > 0.0 {
                let factor = weighted_dot(column, goal, &self.weights) / (norms[pivot] * norms[pivot]);
                subtract(column, factor, goal);
                triangle[pivot * count + last] += factor;
            }
        }
        let residual = square(goal, &self.weights).sqrt();
        norms[last] = residual;
        triangle[count * count - 1] = 1.0;

        let coefficients = back_substitute(&triangle, &norms, last);
        let carried: f64 = coefficients.iter().zip(&lengths).map(|(c, length)| (c * length).abs()).sum();
        let noise = ROUNDINGS * UNIT_ROUNDOFF * (cancellation * lengths[last] + carried);
        let relative_error = if residual > 0.0 { noise / residual } else { 0.0 };
        Projection { residual, norm: lengths[last], coefficients, dropped, relative_error, triangle, norms }
    }
}

/// Coefficients of the last column on the first `last`, from the unit upper triangle.
fn back_substitute(triangle: &[f64], norms: &[f64], last: usize) -> Vec<f64> {
    let count = last + 1;
    let mut coefficients: Vec<f64> = (0..last).map(|row| triangle[row * count + last]).collect();
    for row in (0..last).rev() {
        if norms[row] == 0.0 {
            coefficients[row] = 0.0;
            continue;
        }
        let known: f64 =
            (row + 1..last).map(|column| triangle[row * count + column] * coefficients[column]).sum();
        coefficients[row] -= known;
    }
    coefficients
}

dispatched! {
    /// Σ u a b.
    fn weighted_dot<'a>(a: &'a [f64], b: &'a [f64], weights: &'a [f64]) -> f64 {
        let mut total = Compensated::default();
        for ((a, b), u) in a.chunks(BLOCK).zip(b.chunks(BLOCK)).zip(weights.chunks(BLOCK)) {
            let mut lanes = [0.0; LANES];
            let (a8, b8, u8) = (a.chunks_exact(LANES), b.chunks_exact(LANES), u.chunks_exact(LANES));
            let tail = a8.remainder().iter().zip(b8.remainder()).zip(u8.remainder());
            for (lane, ((a, b), u)) in lanes.iter_mut().zip(tail) {
                *lane = (a * u) * b;
            }
            for ((a, b), u) in a8.zip(b8).zip(u8) {
                for i in 0..LANES {
                    lanes[i] = (a[i] * u[i]).mul_add(b[i], lanes[i]);
                }
            }
            total.add(fold(lanes));
        }
        total.value()
    }
}

fn square(a: &[f64], weights: &[f64]) -> f64 {
    weighted_dot(a, a, weights)
}

dispatched! {
    fn subtract<'a>(column: &'a [f64], factor: f64, from: &'a mut [f64]) {
        for (from, column) in from.iter_mut().zip(column) {
            *from = (-factor).mul_add(*column, *from);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_and_a_point_above_it() {
        // Columns (1,0,0), (1,1,0) and (3,4,5): what is left is 5; coefficients −1 and 4.
        let columns = [1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 3.0, 4.0, 5.0];
        let p = Projector::default().project(&columns, &[1.0; 3], 1.0);
        assert!((p.residual - 5.0).abs() < 1e-15 && (p.norm - 50f64.sqrt()).abs() < 1e-14);
        assert!((p.coefficients[0] + 1.0).abs() < 1e-15 && (p.coefficients[1] - 4.0).abs() < 1e-15);
        assert!(p.dropped.is_empty());
    }

    #[test]
    fn zero_and_dependent_nuisances_are_dropped_and_reported() {
        let columns = [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, -2e100, -4e100, -6e100, 3.0, 2.0, 1.0];
        let p = Projector::default().project(&columns, &[1.0; 3], 1.0);
        assert_eq!(p.dropped, [0, 2]);
        // |(3,2,1) − (10/14)(1,2,3)|² = 14 − 100/14.
        assert!((p.residual - (14.0 - 100.0 / 14.0_f64).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn the_scaled_condition_number_of_two_columns_is_that_of_their_angle() {
        let angle: f64 = 1e-3;
        let columns = [1e9, 0.0, 1e-7 * angle.cos(), 1e-7 * angle.sin()];
        let p = Projector::default().project(&columns, &[1.0; 2], 1.0);
        let exact = ((1.0 + angle.cos()) / (1.0 - angle.cos())).sqrt();
        assert!((p.condition_number() / exact - 1.0).abs() < 1e-6);
    }
}
