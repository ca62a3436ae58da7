//! The density of a mixture of normal laws at a reading.
//!
//! A state is N(y; x, 1); a state that stands for its cell is N(y; x, 1 + ΣJJᵀ), J the change of x over the cell along each
//! axis, over √12: a mixture of them resembles that over all states also where the cells are larger than the noise. Its
//! inverse covariance is 1 − GᵀG, G = L⁻¹J, LLᵀ = 1 + JJᵀ (rows J), and its determinant det(LLᵀ).

use crate::sum::dot;

/// Terms of a likelihood this much below its largest, in logarithm, are none.
const NEGLIGIBLE: f64 = 40.0;

/// States, dimension by dimension.
#[derive(Debug, Clone, Default)]
pub(super) struct Cloud {
    /// Coordinates of each state.
    pub(super) at: Vec<f64>,
    /// J of each state, axis by axis.
    cells: Vec<f64>,
    pub(super) count: usize,
}

impl Cloud {
    /// From coordinates and cells, state by state.
    pub(super) fn new(at: &[f64], cells: &[f64], r: usize) -> Self {
        let count = at.len() / r.max(1);
        Self { at: transposed(at, count), cells: transposed(cells, count), count }
    }

    pub(super) fn scaled(&self, factor: f64) -> Self {
        let scaled = |values: &[f64]| values.iter().map(|value| factor * value).collect();
        Self { at: scaled(&self.at), cells: scaled(&self.cells), count: self.count }
    }

    pub(super) fn coordinate(&self, dimension: usize, state: usize) -> f64 {
        self.at[dimension * self.count + state]
    }
}

fn transposed(rows: &[f64], count: usize) -> Vec<f64> {
    let width = rows.len() / count.max(1);
    (0..width).flat_map(|d| (0..count).map(move |i| rows[i * width + d])).collect()
}

/// Squared separations of a reading from some states, and other numbers of each.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    squares: Vec<f64>,
    along: Vec<f64>,
}

impl Scratch {
    pub(super) fn squares(&mut self, cloud: &Cloud, y: &[f64]) {
        self.squares.clear();
        self.squares.resize(cloud.count, 0.0);
        for (x, y) in cloud.at.chunks_exact(cloud.count.max(1)).zip(y) {
            self.squares.iter_mut().zip(x).for_each(|(sum, x)| *sum += (y - x) * (y - x));
        }
    }

    /// ln Σ exp(log − ½ square) − ln n.
    pub(super) fn log_mean(&mut self, log: impl Fn(usize) -> f64) -> f64 {
        let mut most = f64::NEG_INFINITY;
        for (i, square) in self.squares.iter_mut().enumerate() {
            *square = log(i) - 0.5 * *square;
            most = most.max(*square);
        }
        let near = self.squares.iter().filter(|log| **log > most - NEGLIGIBLE);
        let sum: f64 = near.map(|log| (log - most).exp()).sum();
        most + sum.ln() - (self.squares.len().max(1) as f64).ln()
    }
}

/// States that stand for their cells.
pub(super) struct Cells {
    cloud: Cloud,
    axes: usize,
    /// −ln det L.
    logs: Vec<f64>,
}

impl Cells {
    pub(super) fn new(cloud: &Cloud, factor: f64, r: usize, axes: usize) -> Self {
        let mut cloud = cloud.scaled(factor);
        let mut logs = Vec::with_capacity(cloud.count);
        let mut rows = vec![0.0; axes * r];
        for i in 0..cloud.count {
            (0..axes * r).for_each(|d| rows[d] = cloud.cells[d * cloud.count + i]);
            logs.push(-orthogonalise(&mut rows, r, axes));
            (0..axes * r).for_each(|d| cloud.cells[d * cloud.count + i] = rows[d]);
        }
        Self { cloud, axes, logs }
    }

    /// ln of the mixture's density at y, up to what all mixtures share.
    pub(super) fn log_density(&self, y: &[f64], scratch: &mut Scratch) -> f64 {
        let (count, cells) = (self.cloud.count, &self.cloud.cells);
        scratch.squares(&self.cloud, y);
        for axis in 0..self.axes {
            scratch.along.clear();
            scratch.along.resize(count, 0.0);
            let columns = cells.chunks_exact(count.max(1)).skip(axis * y.len());
            for ((g, x), y) in columns.zip(self.cloud.at.chunks_exact(count.max(1))).zip(y) {
                let terms = g.iter().zip(x).zip(&mut scratch.along);
                terms.for_each(|((g, x), sum)| *sum += g * (y - x));
            }
            scratch
                .squares
                .iter_mut()
                .zip(&scratch.along)
                .for_each(|(square, along)| *square -= along * along);
        }
        scratch.log_mean(|i| self.logs[i])
    }
}

/// Rows J become G; ln det L.
fn orthogonalise(rows: &mut [f64], r: usize, axes: usize) -> f64 {
    let own: Vec<Vec<f64>> = (0..axes).map(|i| rows[i * r..(i + 1) * r].to_vec()).collect();
    let mut lower = vec![0.0; axes * axes];
    let mut log = 0.0;
    for i in 0..axes {
        for j in 0..=i {
            let mut sum = f64::from(u8::from(i == j)) + dot(&own[i], &own[j]);
            sum -= (0..j).map(|l| lower[i * axes + l] * lower[j * axes + l]).sum::<f64>();
            lower[i * axes + j] = if i == j { sum.max(1.0).sqrt() } else { sum / lower[j * axes + j] };
        }
        log += lower[i * axes + i].ln();
        for d in 0..r {
            let before: f64 = (0..i).map(|l| lower[i * axes + l] * rows[l * r + d]).sum();
            rows[i * r + d] = (own[i][d] - before) / lower[i * axes + i];
        }
    }
    log
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    /// The density of one state against the inverse and the determinant of its whole covariance.
    #[test]
    fn a_cell_is_a_normal_law_with_its_covariance() {
        let (r, axes) = (4, 2);
        let (x, y) = ([0.3, -1.2, 0.4, 2.0], [1.0, 0.5, -0.7, 1.1]);
        let cells = [0.5, -0.3, 0.8, 0.1, 2.0, 1.5, -0.2, 0.4];
        for factor in [0.1, 1.0, 7.0] {
            let cloud = Cloud::new(&x, &cells, r);
            let found = Cells::new(&cloud, factor, r, axes).log_density(&y, &mut Scratch::default());
            let j = factor * DMatrix::from_row_slice(axes, r, &cells);
            let covariance = DMatrix::identity(r, r) + j.transpose() * &j;
            let off = DVector::from_fn(r, |i, _| y[i] - factor * x[i]);
            let square = off.dot(&(covariance.clone().try_inverse().unwrap() * &off));
            let expected = -0.5 * square - 0.5 * covariance.determinant().ln();
            assert!((found - expected).abs() < 1e-10 * expected.abs().max(1.0), "{found} {expected}");
        }
    }
}
