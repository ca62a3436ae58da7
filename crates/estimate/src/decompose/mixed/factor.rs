//! A small symmetric matrix of full rank, decomposed: D H D = L Lᵀ (Cholesky), D its scale that makes the diagonal 1.
//!
//! A pivot that rounding takes away is a direction without information beside the density: it stays at least [`LEAST_PIVOT`].

use super::parts::{MOST_COORDINATES, Point, Square};

/// A pivot of columns of length 1 is at least that.
const LEAST_PIVOT: f64 = 1e-12;

/// A matrix of full rank, scaled to a diagonal of 1 by D and decomposed: D H D = L Lᵀ (Cholesky).
pub(super) struct Factor {
    pub(super) count: usize,
    lower: Square,
    scale: Point,
}

impl Factor {
    pub(super) fn new(whole: &Square, count: usize) -> Self {
        let nothing = [0.0; MOST_COORDINATES];
        let mut factor = Self { count, lower: [nothing; MOST_COORDINATES], scale: nothing };
        for (i, (scale, row)) in factor.scale.iter_mut().zip(whole).enumerate().take(count) {
            *scale = libm::sqrt(row[i].max(f64::MIN_POSITIVE)).recip();
        }
        let Self { lower, scale, .. } = &mut factor;
        for i in 0..count {
            for j in 0..=i {
                let done: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
                let rest = (whole[i][j] * scale[i]).mul_add(scale[j], -done);
                lower[i][j] = if i == j { libm::sqrt(rest.max(LEAST_PIVOT)) } else { rest / lower[j][j] };
            }
        }
        factor
    }

    /// L⁻¹ D of a vector.
    fn forward(&self, of: &Point) -> Point {
        let mut x = [0.0; MOST_COORDINATES];
        for i in 0..self.count {
            let done: f64 = (0..i).map(|k| self.lower[i][k] * x[k]).sum();
            x[i] = of[i].mul_add(self.scale[i], -done) / self.lower[i][i];
        }
        x
    }

    /// H⁻¹ of a slope, and the slope along it.
    pub(super) fn step(&self, slope: &Point) -> (Point, f64) {
        let mut x = self.forward(slope);
        let gain = x[..self.count].iter().map(|x| x * x).sum();
        for i in (0..self.count).rev() {
            let after: f64 = (i + 1..self.count).map(|k| self.lower[k][i] * x[k]).sum();
            x[i] = (x[i] - after) / self.lower[i][i];
        }
        (0..self.count).for_each(|i| x[i] *= self.scale[i]);
        (x, gain)
    }

    pub(super) fn logarithm(&self) -> f64 {
        (0..self.count).map(|i| 2.0 * libm::log(self.lower[i][i] / self.scale[i])).sum()
    }

    /// Deviation of a coordinate.
    pub(super) fn sigma(&self, at: usize) -> f64 {
        let mut one = [0.0; MOST_COORDINATES];
        one[at] = 1.0;
        let along = self.forward(&one);
        libm::sqrt(along[..self.count].iter().map(|x| x * x).sum())
    }
}

/// A symmetric matrix in other coordinates, that `turn` brings a slope into: one side, then the other.
pub(super) fn on_both_sides(whole: &mut Square, count: usize, turn: impl Fn(&mut Point)) {
    whole[..count].iter_mut().for_each(&turn);
    for i in 1..count {
        let (above, below) = whole.split_at_mut(i);
        above.iter_mut().zip(&mut below[0]).for_each(|(row, x)| std::mem::swap(&mut row[i], x));
    }
    whole[..count].iter_mut().for_each(&turn);
}
