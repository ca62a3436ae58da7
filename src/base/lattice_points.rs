//! A rank-1 lattice that fills the unit cube evenly, however many of its points are taken.
//!
//! Point i of a lattice in n dimensions begun at s is s + iα modulo 1 with the steps α = (φ⁻¹, φ⁻², …, φ⁻ⁿ), φ the root of
//! φⁿ⁺¹ = φ + 1: the golden ratio for n = 1, the plastic number for n = 2.
//!
//! Source: Roberts, 'The unreasonable effectiveness of quasirandom sequences' (2018), who names φ the generalised golden
//! ratio.

/// Points of the unit cube.
#[derive(Debug, Clone, PartialEq)]
pub struct GoldenLattice {
    /// Point 0, and the steps from each point to the next.
    start: Vec<f64>,
    steps: Vec<f64>,
}

impl GoldenLattice {
    /// A lattice that begins at `start`, in as many dimensions as that has.
    #[must_use]
    pub fn new(start: Vec<f64>) -> Self {
        let n = start.len() as f64;
        let golden = (0..60).fold(1.5f64, |phi, _| (1.0 + phi).powf(1.0 / (n + 1.0)));
        let steps = (1..=start.len()).map(|i| golden.powi(-(i as i32))).collect();
        Self { start, steps }
    }

    /// Point number `index`.
    #[must_use]
    pub fn point(&self, index: usize) -> Vec<f64> {
        self.start
            .iter()
            .zip(&self.steps)
            .map(|(start, step)| (start + step * index as f64).fract())
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lattice_fills_the_square() {
        let lattice = GoldenLattice::new(vec![0.1, 0.7]);
        let points: Vec<Vec<f64>> = (0..256).map(|i| lattice.point(i)).collect();
        for corner in 0..16 {
            let (x, y) = (f64::from(corner % 4) / 4.0, f64::from(corner / 4) / 4.0);
            let inside = |p: &&Vec<f64>| p[0] >= x && p[0] < x + 0.25 && p[1] >= y && p[1] < y + 0.25;
            let count = points.iter().filter(inside).count();
            assert!((12..=20).contains(&count), "{count}");
        }
    }
}
