//! What a quadratic in the counts says of the distance.
//!
//! With y = √(N + v) of the target and s = √(N′ + v) of the alternative, and any counts N₀ with s₀, r₀ = y − s₀,
//!
//! ‖y − s‖² = ‖r₀‖² − Σ (r₀/s₀)(N′ − N₀) + Σ (y/s₀)(s − s₀)²,   (s − s₀)² = (N′ − N₀)²/(s + s₀)².
//!
//! A state nearer than d has s ≤ y + d in *every* band. So no state nearer than d is below the quadratic
//!
//! ‖r₀‖² − Σ (r₀/s₀)(N′ − N₀) + Σ (y/s₀)(N′ − N₀)²/(s₀ + y + d)²,
//!
//! whose value and slope at N₀ are exact. With N₀ = N it is the weighted least-squares sum Σ (N′ − N)²/(2y + d)².
//! A band in which s₀ is 0 is left out: each adds a square.

/// constant + ‖weight · N′ + shift‖².
#[derive(Debug, Clone, Default)]
pub(super) struct Metric {
    pub(super) weight: Vec<f64>,
    pub(super) shift: Vec<f64>,
    pub(super) constant: f64,
}

impl Metric {
    /// About the target itself.
    pub(super) fn about_target(root: &[f64], counts: &[f64], reach: f64) -> Self {
        let weight: Vec<f64> =
            root.iter().map(|y| 2.0 * y + reach).map(|sum| if sum > 0.0 { 1.0 / sum } else { 0.0 }).collect();
        let shift = weight.iter().zip(counts).map(|(w, n)| -w * n).collect();
        Self { weight, shift, constant: 0.0 }
    }

    /// About other counts.
    pub(super) fn about(root: &[f64], counts: &[f64], noise: &[f64], own: &[f64], reach: f64) -> Self {
        let bands = root.len();
        let (mut weight, mut shift, mut constant) = (vec![0.0; bands], vec![0.0; bands], 0.0);
        for w in 0..bands {
            let (y, other) = (root[w], (counts[w] + noise[w]).max(0.0).sqrt());
            if other <= 1e-150 || y <= 0.0 {
                continue;
            }
            let residual = (own[w] - counts[w]) / (y + other);
            weight[w] = (y / other).sqrt() / (other + y + reach);
            // Half of p/weight, p = −r/s.
            let half = -0.5 * residual / (other * weight[w]);
            shift[w] = half - weight[w] * counts[w];
            constant += residual * residual - half * half;
        }
        Self { weight, shift, constant }
    }
}
