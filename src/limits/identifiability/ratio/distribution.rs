//! The distribution function of Λ under either state, from a Fourier series, and its inverse.
//!
//! With all but e⁻³⁷ of the law inside (a, b), P = b − a and τ_j = 2πj/P, its density there is the series
//! (1/P)[1 + 2Σ Re φ(τ_j)e^{−iτ_j(x−μ)}], up to what wraps around; φ is that of the state itself (s = 0 or 1). Between
//! the nodes of a table the distribution function is the cubic with the same values and slopes. Only for laws whose φ
//! falls below 10⁻¹⁶ within some hundred terms: with few counts the law has steps, which no series resolves.

use super::line::Line;
use std::f64::consts::PI;

/// −ln of what is left out.
const LEFT_OUT: f64 = 37.0;
/// Most terms of the series.
const TERMS: usize = 1024;
/// Terms in a row below 10⁻¹⁶ that end it.
const IN_A_ROW: usize = 6;

/// The law of Λ = ln(q/p) under one state, where it is finite.
///
/// Good to about 10⁻¹⁰ of probability; steps of a few bands of very many counts, below 10⁻⁶ each, are smoothed.
#[derive(Debug, Clone)]
pub struct RatioDistribution {
    low: f64,
    step: f64,
    /// Distribution function and density × `step` at the nodes.
    nodes: Vec<(f64, f64)>,
    /// Cell in which the quantiles of k/len begin.
    guide: Vec<usize>,
}

impl RatioDistribution {
    /// Nothing if the series does not end.
    pub(super) fn new(line: &Line) -> Option<Self> {
        let mean = line.moments.slope;
        let low = mean - line.reach(-1.0, LEFT_OUT);
        let high = mean + line.reach(1.0, LEFT_OUT);
        let period = high - low;
        if !(period > 0.0 && low.is_finite() && high.is_finite()) {
            return None;
        }
        let coefficients = series(line, 2.0 * PI / period, low - mean)?;
        let cells = (32 * coefficients.len()).next_power_of_two().max(2048);
        let root = |k: usize| (2.0 * PI * k as f64 / cells as f64).sin_cos();
        let roots: Vec<(f64, f64)> = (0..cells).map(root).collect();
        let mut most = 0.0_f64;
        let node = |i: usize| {
            let (mut density, mut sum) = (1.0, i as f64 / cells as f64);
            let mut turned = 0;
            for (&(re, im), j) in coefficients.iter().zip(1..) {
                turned = (turned + i) & (cells - 1);
                let (sine, cosine) = roots[turned];
                // c e^{−iθ}
                density += 2.0 * (re * cosine + im * sine);
                sum += (re * sine - im * cosine) / (PI * f64::from(j));
            }
            (sum, (density / cells as f64).max(0.0))
        };
        let mut nodes: Vec<(f64, f64)> = (0..=cells).map(node).collect();
        // The integral begins at 0.
        let offset = nodes[0].0;
        for node in &mut nodes {
            most = most.max((node.0 - offset).clamp(0.0, 1.0));
            node.0 = most;
        }
        let mut guide = Vec::with_capacity(cells);
        let mut cell = 0;
        for k in 0..cells {
            while cell + 1 < cells && nodes[cell + 1].0 <= k as f64 / cells as f64 {
                cell += 1;
            }
            guide.push(cell);
        }
        Some(Self { low, step: period / cells as f64, nodes, guide })
    }

    /// P(Λ ≤ x), given that Λ is finite; 0 for an x that is no number.
    #[must_use]
    pub fn cumulative(&self, x: f64) -> f64 {
        let place = (x - self.low) / self.step;
        let last = self.nodes.len() - 2;
        if place.is_nan() || place <= 0.0 {
            return 0.0;
        }
        if place >= (last + 1) as f64 {
            return 1.0;
        }
        let cell = (place as usize).min(last);
        self.cubic(cell, place - cell as f64).0
    }

    /// The x with P(Λ ≤ x) = `probability`, which is taken into [0, 1].
    #[must_use]
    #[inline]
    pub fn quantile(&self, probability: f64) -> f64 {
        let u = if probability > 0.0 { probability.min(1.0) } else { 0.0 };
        let last = self.nodes.len() - 2;
        let start = (u * self.guide.len() as f64) as usize;
        let mut cell = self.guide[start.min(self.guide.len() - 1)];
        while cell < last && self.nodes[cell + 1].0 < u {
            cell += 1;
        }
        let (from, to) = (self.nodes[cell].0, self.nodes[cell + 1].0);
        let mut y = if to > from { ((u - from) / (to - from)).clamp(0.0, 1.0) } else { 0.5 };
        // The chord is within 1e-3 of a cell; two steps leave nothing.
        for _ in 0..2 {
            let (value, slope) = self.cubic(cell, y);
            if slope > 0.0 {
                y = (y - (value - u) / slope).clamp(0.0, 1.0);
            }
        }
        self.low + self.step * (cell as f64 + y)
    }

    /// The cubic of a cell and its slope, y in [0, 1].
    #[inline]
    fn cubic(&self, cell: usize, y: f64) -> (f64, f64) {
        let ((a, da), (b, db)) = (self.nodes[cell], self.nodes[cell + 1]);
        let rise = b - a;
        let (c2, c3) = (3.0 * rise - 2.0 * da - db, da + db - 2.0 * rise);
        (a + y * (da + y * (c2 + y * c3)), da + y * (2.0 * c2 + 3.0 * y * c3))
    }
}

/// φ(τ_j)e^{−iτ_j(low − μ)} until it is nothing, with a look beyond.
fn series(line: &Line, tau: f64, start: f64) -> Option<Vec<(f64, f64)>> {
    crate::stop::check();
    let term = |j: usize| {
        let tau = tau * j as f64;
        let (ln_modulus, late) = line.ln_phi(tau);
        let (sine, cosine) = (late - tau * start).sin_cos();
        let modulus = ln_modulus.exp();
        (modulus, (modulus * cosine, modulus * sine))
    };
    let mut coefficients = Vec::new();
    let mut quiet = 0;
    while quiet < IN_A_ROW {
        if coefficients.len() >= TERMS {
            return None;
        }
        let (modulus, coefficient) = term(coefficients.len() + 1);
        quiet = if modulus < 1e-16 { quiet + 1 } else { 0 };
        coefficients.push(coefficient);
    }
    // A revival of size φ at term j is a ripple of φ/(πj) of the distribution function.
    let end = coefficients.len();
    let looks = (0..64).map(|k| end + 1 + k * k * end / 16);
    let clear = looks.map(|j| term(j).0 / j as f64).all(|ripple| ripple < 1e-10);
    // Half a step of a law that is one is about half the mean of |φ|.
    (clear && line.graininess().1 < 1e-6).then_some(coefficients)
}
