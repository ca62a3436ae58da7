//! Inner products along a row of a map from those at a few nodes, and the distance they leave.
//!
//! Every product is Σ c_w/S_w(τ), and S_w is linear in τ. With h one number for all bands,
//!
//!   t = ((2 + h)τ − 1)/(1 + hτ),   (1 + hτ)/(1 + gτ) = 2(1 + h)/(2 + h + g + (g − h)t)
//!
//! maps τ = 0…1 to t = −1…1 and makes each term times 1 + hτ a simple pole in t. The polynomial through n Chebyshev
//! nodes misses 1/(t − p) by exactly the share Tₙ(t)/Tₙ(p) of it, so that no inner product is off by more than
//! 1/Tₙ(z) of the product of the two lengths, z the pole nearest to the interval. With growths G = 1 + g between G₁ and
//! G₂ the poles on both sides are equally far for 1 + h = √(G₁G₂), at z = (√G₂ + √G₁)/(√G₂ − √G₁).
//!
//! Source: the remainder of interpolation (Davis, 'Interpolation and Approximation' (1963), §3.1) for a simple pole.

use super::passes::Entries;
use crate::simd::{Chunk, LANES, dispatched};

/// Share of a product that interpolation may miss: 2⁻⁵³.
const LARGEST_ERROR_LN: f64 = 53.0 * std::f64::consts::LN_2;
/// |v|² may be this many times what the nuisances leave of it: that many times its rounding error is in the result.
const LOST: f64 = 16.0;
/// Share of a nuisance column, squared, that must be left by the ones before.
const LEFT: f64 = 1.0 / 64.0;

/// The variable t, and how many nodes it takes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chebyshev {
    /// h of the module's equations.
    h: f64,
    /// Number of nodes.
    pub(super) count: usize,
}

impl Chebyshev {
    /// For signals that grow from `least` to `most` times theirs along the row; `None` if it takes more than `limit`
    /// nodes.
    pub(super) fn new(least: f64, most: f64, limit: usize) -> Option<Self> {
        if !(least > 0.0 && most.is_finite()) {
            return None;
        }
        let (low, high) = (least.sqrt(), most.sqrt());
        // Signals that grow alike need one node; rounding makes two of it.
        let apart = (high - low).max(4.0 * f64::EPSILON * high);
        let z = (high + low) / apart;
        let nodes = ((LARGEST_ERROR_LN + std::f64::consts::LN_2) / z.acosh()).ceil();
        (nodes <= limit as f64).then(|| Self { h: low * high - 1.0, count: nodes.max(2.0) as usize })
    }

    /// 1 + hτ.
    pub(super) fn factor(self, tau: f64) -> f64 {
        1.0 + self.h * tau
    }

    /// t of τ.
    pub(super) fn t(self, tau: f64) -> f64 {
        ((2.0 + self.h) * tau - 1.0) / self.factor(tau)
    }

    /// τ of t = 0.
    pub(super) fn middle(self) -> f64 {
        1.0 / (2.0 + self.h)
    }

    /// τ of every node.
    pub(super) fn nodes(self, cosines: &Cosines, out: &mut Vec<f64>) {
        out.clear();
        out.extend((0..self.count).map(|j| {
            let t = cosines.at(j, 1);
            (1.0 + t) / (2.0 + self.h - self.h * t)
        }));
    }

    /// Coefficients on T₀, T₁… of (1 + hτ) times the products given at the nodes.
    pub(super) fn coefficients(
        self,
        cosines: &Cosines,
        nodes: &[f64],
        values: &[Entries],
        out: &mut Vec<Entries>,
    ) {
        out.clear();
        out.resize(self.count, Entries::default());
        for (j, (values, &tau)) in values.iter().zip(nodes).enumerate() {
            let factor = 2.0 / self.count as f64 * self.factor(tau);
            for (k, out) in out.iter_mut().enumerate() {
                let share = if k == 0 { 0.5 * factor } else { factor * cosines.at(j, k) };
                for (out, value) in out.iter_mut().zip(values) {
                    *out += share * value;
                }
            }
        }
    }
}

/// Tₖ at the Chebyshev nodes, kept as long as their number stays. The recurrence of the Tₖ would lose k² units in the
/// last place near the ends.
#[derive(Debug, Clone, Default)]
pub(super) struct Cosines {
    count: usize,
    /// cos πm/2n for m = 0…4n − 1.
    table: Vec<f64>,
}

impl Cosines {
    /// Makes ready for `count` nodes.
    pub(super) fn prepare(&mut self, count: usize) {
        if self.count == count {
            return;
        }
        self.count = count;
        let step = std::f64::consts::PI / (2 * count) as f64;
        self.table.clear();
        self.table.extend((0..4 * count).map(|m| libm::cos(step * m as f64)));
    }

    /// Tₖ at node j: cos kπ(j + ½)/n.
    fn at(&self, j: usize, k: usize) -> f64 {
        self.table[k * (2 * j + 1) % self.table.len()]
    }
}

/// Points of a row, eight at a time.
pub(super) struct Points<'a> {
    /// Number of columns: nuisances qᵢ, x and r.
    pub(super) columns: usize,
    pub(super) coefficients: &'a [Entries],
    /// t and ψ of the points.
    pub(super) t: &'a [Chunk],
    pub(super) psi: &'a [Chunk],
    pub(super) out: &'a mut [Chunk],
}

dispatched! {
    /// (1 + hτ) ‖P⊥ v‖² with v = r + ψx; NaN where more than a digit would be lost.
    pub(super) fn left_into<'a>(points: Points<'a>) {
        let Points { columns, coefficients, t, psi, out } = points;
        for ((t, psi), out) in t.iter().zip(psi).zip(out) {
            *out = match columns {
                2 => left::<2, 3>(coefficients, *t, *psi),
                3 => left::<3, 6>(coefficients, *t, *psi),
                4 => left::<4, 10>(coefficients, *t, *psi),
                5 => left::<5, 15>(coefficients, *t, *psi),
                6 => left::<6, 21>(coefficients, *t, *psi),
                _ => [f64::NAN; LANES],
            };
        }
    }
}

#[inline(always)]
fn lanes(of: impl Fn(usize) -> f64) -> Chunk {
    std::array::from_fn(of)
}

#[inline(always)]
#[allow(clippy::needless_range_loop, reason = "an elimination reads best by its indices")]
fn left<const K: usize, const P: usize>(coefficients: &[Entries], t: Chunk, psi: Chunk) -> Chunk {
    let products = clenshaw::<P>(coefficients, t);
    let mut matrix = [[[0.0; LANES]; K]; K];
    let mut entry = 0;
    for i in 0..K {
        for j in i..K {
            matrix[i][j] = products[entry];
            entry += 1;
        }
    }
    let (nuisances, x, r) = (K - 2, K - 2, K - 1);
    let (xx, xr, rr) = (matrix[x][x], matrix[x][r], matrix[r][r]);
    let terms = lanes(|l| (psi[l] * psi[l]).mul_add(xx[l], rr[l]));
    let mut left = lanes(|l| (2.0 * psi[l]).mul_add(xr[l], terms[l]));
    let mut along: [Chunk; K] =
        std::array::from_fn(|i| lanes(|l| psi[l].mul_add(matrix[i][x][l], matrix[i][r][l])));
    let diagonal: [Chunk; K] = std::array::from_fn(|i| matrix[i][i]);
    let mut good = [true; LANES];
    for i in 0..nuisances {
        let pivot = matrix[i][i];
        let inverse = pivot.map(|pivot| 1.0 / pivot);
        for j in i + 1..nuisances {
            let share = lanes(|l| matrix[i][j][l] * inverse[l]);
            for k in j..nuisances {
                matrix[j][k] = lanes(|l| (-share[l]).mul_add(matrix[i][k][l], matrix[j][k][l]));
            }
            along[j] = lanes(|l| (-share[l]).mul_add(along[i][l], along[j][l]));
        }
        left = lanes(|l| (-along[i][l] * inverse[l]).mul_add(along[i][l], left[l]));
        good = std::array::from_fn(|l| good[l] & (pivot[l] >= LEFT * diagonal[i][l]));
    }
    lanes(|l| if good[l] & (LOST * left[l] >= terms[l]) { left[l] } else { f64::NAN })
}

/// Σ cₖTₖ(t).
#[inline(always)]
fn clenshaw<const P: usize>(coefficients: &[Entries], t: Chunk) -> [Chunk; P] {
    let (mut now, mut before) = ([[0.0; LANES]; P], [[0.0; LANES]; P]);
    let Some((constant, others)) = coefficients.split_first() else { return now };
    let twice = t.map(|t| 2.0 * t);
    for coefficients in others.iter().rev() {
        let next: [Chunk; P] =
            std::array::from_fn(|p| lanes(|l| twice[l].mul_add(now[p][l], coefficients[p] - before[p][l])));
        (before, now) = (now, next);
    }
    std::array::from_fn(|p| lanes(|l| t[l].mul_add(now[p][l], constant[p] - before[p][l])))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1/(1 + gτ) for growths within the range, between the nodes: off by no more than 2⁻⁵³ and rounding.
    #[test]
    fn interpolation_misses_a_pole_by_less_than_rounding() {
        for (least, most) in [(1.0, 1.0), (1.05, 1.06), (0.9, 1.0), (1.0, 2.1), (5.0, 10.0)] {
            let chebyshev = Chebyshev::new(least, most, 16).unwrap();
            let (mut nodes, mut cosines) = (Vec::new(), Cosines::default());
            cosines.prepare(chebyshev.count);
            chebyshev.nodes(&cosines, &mut nodes);
            let growth = |i: usize| least + (most - least) * i as f64 / 20.0;
            let at = |tau: f64| std::array::from_fn(|i| 1.0 / (1.0 + (growth(i) - 1.0) * tau));
            let values: Vec<Entries> = nodes.iter().map(|&tau| at(tau)).collect();
            let mut coefficients = Vec::new();
            chebyshev.coefficients(&cosines, &nodes, &values, &mut coefficients);
            for step in 0..=100 {
                let tau = f64::from(step) / 100.0;
                let found = clenshaw::<21>(&coefficients, [chebyshev.t(tau); LANES]);
                for (found, exact) in found.iter().zip(at(tau)) {
                    let error = (found[0] / (exact * chebyshev.factor(tau)) - 1.0).abs();
                    assert!(error < 12.0 * f64::EPSILON, "{least} {most} {tau}: {error:e}");
                }
            }
        }
        assert!(Chebyshev::new(1.0, 1e6, 16).is_none() && Chebyshev::new(1.0, f64::INFINITY, 16).is_none());
    }
}
