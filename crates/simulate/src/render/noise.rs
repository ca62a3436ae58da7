//! Noise that is fixed in space: smooth functions of a position, the same on every machine.
//!
//! Gradients or values hashed from the corners of a unit lattice are joined by the quintic 6t⁵ − 15t⁴ + 10t³, so that
//! the noise has two continuous derivatives.
//!
//! Source: K. Perlin, SIGGRAPH 2002, doi:10.1145/566654.566636.

use super::vector::Vector;

/// Root mean square of [`GradientLine`]: 2√(∫w²x² dx ∫w² dx), w the falling quintic on [0, 1].
pub(super) const GRADIENT_RMS: f64 = 0.215_71;
/// Root mean square of [`value`]: (∫(w² + (1 − w)²) dx)^{3/2}/√3.
pub(super) const VALUE_RMS: f64 = 0.400_442;
/// Root mean square slope, across any direction, of [`value_slope`].
pub(super) const VALUE_SLOPE_RMS: f64 = 1.081_40;

const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Half-way between the axes and the diagonals, cos and sin of 22.5°.
const COS: f64 = 0.923_879_532_511_286_7;
const SIN: f64 = 0.382_683_432_365_089_8;
/// Sixteen directions around the circle.
const DIRECTIONS: [[f64; 2]; 16] = [
    [1.0, 0.0],
    [COS, SIN],
    [DIAGONAL, DIAGONAL],
    [SIN, COS],
    [0.0, 1.0],
    [-SIN, COS],
    [-DIAGONAL, DIAGONAL],
    [-COS, SIN],
    [-1.0, 0.0],
    [-COS, -SIN],
    [-DIAGONAL, -DIAGONAL],
    [-SIN, -COS],
    [0.0, -1.0],
    [SIN, -COS],
    [DIAGONAL, -DIAGONAL],
    [COS, -SIN],
];

/// A hash of a lattice point, every bit of which depends on all of its coordinates.
#[inline]
fn hash(x: u32, y: u32, z: u32, seed: u32) -> u32 {
    let mixed = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77) ^ z.wrapping_mul(0xc2b2_ae3d);
    let mut h = mixed ^ seed.wrapping_mul(0x27d4_eb2f);
    h = (h ^ (h >> 16)).wrapping_mul(0x7feb_352d);
    h = (h ^ (h >> 15)).wrapping_mul(0x846c_a68b);
    h ^ (h >> 16)
}

/// Lattice cell, wrapped to 32 bits, and the place in it.
#[inline]
fn cell(x: f64) -> (u32, f64) {
    let floor = x.floor();
    (floor as i64 as u32, x - floor)
}

#[inline]
fn quintic(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// Gradient noise of period-free unit cells, mean 0, along a line of one y.
///
/// In a cell it is linear in x on either side: what these lines are is found once for all places of the cell that follow each other.
#[derive(Debug, Clone)]
pub(super) struct GradientLine {
    seed: u32,
    /// Cell in y, the place in it, and the share of its upper side.
    j: u32,
    v: f64,
    t: f64,
    /// Where the cell in x begins; NaN before the first.
    start: f64,
    /// Slope and value at the corner, of its left and its right side.
    sides: [[f64; 2]; 2],
}

impl GradientLine {
    pub(super) fn new(y: f64, seed: u32) -> Self {
        let (j, v) = cell(y);
        Self { seed, j, v, t: quintic(v), start: f64::NAN, sides: [[0.0; 2]; 2] }
    }

    #[inline]
    pub(super) fn at(&mut self, x: f64) -> f64 {
        let mut u = x - self.start;
        if !(0.0..1.0).contains(&u) {
            u = self.enter(x);
        }
        let [[a, b], [c, d]] = self.sides;
        let (left, right) = (a * u + b, c * (u - 1.0) + d);
        left + quintic(u) * (right - left)
    }

    /// Enters the cell of x; the place in it.
    fn enter(&mut self, x: f64) -> f64 {
        let (i, u) = cell(x);
        self.start = x - u;
        self.sides = [0, 1].map(|di| {
            let corner = |dj: u32| {
                let hash = hash(i.wrapping_add(di), self.j.wrapping_add(dj), 0, self.seed);
                let [a, b] = DIRECTIONS[(hash >> 28) as usize];
                [a, b * (self.v - f64::from(dj))]
            };
            let (low, high) = (corner(0), corner(1));
            std::array::from_fn(|k| low[k] + self.t * (high[k] - low[k]))
        });
        u
    }
}

/// Value noise in [−1, 1], values on the corners of unit cells.
#[inline]
pub(super) fn value(at: Vector, seed: u32) -> f64 {
    let cells = at.map(cell);
    let fade = cells.map(|(_, t)| quintic(t));
    let mut sum = 0.0;
    for corner in 0..8_u32 {
        let side = [corner & 1, corner >> 1 & 1, corner >> 2];
        let [x, y, z] = std::array::from_fn(|i| cells[i].0.wrapping_add(side[i]));
        let value = f64::from(hash(x, y, z, seed)) / f64::from(u32::MAX) * 2.0 - 1.0;
        let weight: Vector = std::array::from_fn(|i| if side[i] == 1 { fade[i] } else { 1.0 - fade[i] });
        sum += value * weight[0] * weight[1] * weight[2];
    }
    sum
}

/// Slope of value noise with values in [−1, 1] on the corners of unit cells.
pub(super) fn value_slope(at: Vector, seed: u32) -> Vector {
    let cells = at.map(cell);
    let fade = cells.map(|(_, t)| quintic(t));
    let slope = cells.map(|(_, t)| 30.0 * t * t * (t - 1.0) * (t - 1.0));
    let mut sum = [0.0; 3];
    for corner in 0..8_u32 {
        let side = [corner & 1, corner >> 1 & 1, corner >> 2];
        let [x, y, z] = std::array::from_fn(|i| cells[i].0.wrapping_add(side[i]));
        let value = f64::from(hash(x, y, z, seed)) / f64::from(u32::MAX) * 2.0 - 1.0;
        let weight: Vector = std::array::from_fn(|i| if side[i] == 1 { fade[i] } else { 1.0 - fade[i] });
        for i in 0..3 {
            let sign = if side[i] == 1 { 1.0 } else { -1.0 };
            sum[i] += value * sign * slope[i] * weight[(i + 1) % 3] * weight[(i + 2) % 3];
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_noise_has_mean_0_and_the_root_mean_square_it_is_scaled_by() {
        let n = 400;
        let (mut sum, mut square, mut slope) = (0.0, 0.0, 0.0);
        for i in 0..n * n {
            // Far from the origin, and off the lattice.
            let (x, y) = (f64::from(i / n) * 1.37 - 300.0, f64::from(i % n) * 1.73 + 1e6);
            let value = GradientLine::new(y, 7).at(x);
            sum += value;
            square += value * value;
            let [a, b, _] = value_slope([x, y, 0.31 * x], 7);
            slope += a * a + b * b;
        }
        let count = f64::from(n * n);
        // 160 000 nearly independent values: 5 standard errors of each.
        assert!((sum / count).abs() < 5.0 * GRADIENT_RMS / count.sqrt());
        assert!(((square / count).sqrt() / GRADIENT_RMS - 1.0).abs() < 0.01, "{}", (square / count).sqrt());
        assert!(((slope / count).sqrt() / VALUE_SLOPE_RMS - 1.0).abs() < 0.01, "{}", (slope / count).sqrt());
    }

    #[test]
    fn the_noise_is_smooth_across_cells_and_differs_by_seed() {
        let gradient = |x: f64, y: f64, seed: u32| GradientLine::new(y, seed).at(x);
        for (x, y) in [(3.0, 0.4), (-7.0, 2.0), (0.3, -5.0)] {
            let step = 1e-7;
            assert!((gradient(x - step, y - step, 1) - gradient(x + step, y + step, 1)).abs() < 1e-6);
        }
        assert_ne!(gradient(0.3, 0.4, 1), gradient(0.3, 0.4, 2));
        // Back and forth along a line, and at whole numbers.
        let mut line = GradientLine::new(0.7, 3);
        for x in [0.2, 0.9, 1.0, 2.5, 1.7, -0.1, 1e6, 0.2] {
            assert_eq!(line.at(x), gradient(x, 0.7, 3));
        }
    }
}
