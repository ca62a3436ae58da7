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

use crate::simd::{LANES, dispatched, fold};

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
        let (mut weight, mut shift) = (vec![0.0; root.len()], vec![0.0; root.len()]);
        let out = [&mut weight[..], &mut shift[..]];
        let constant = about(Bands { root, counts, noise, own, reach, out });
        Self { weight, shift, constant }
    }
}

/// What [`about`] reads and writes.
struct Bands<'a> {
    root: &'a [f64],
    counts: &'a [f64],
    noise: &'a [f64],
    own: &'a [f64],
    reach: f64,
    out: [&'a mut [f64]; 2],
}

dispatched! {
    /// Weights and shifts of every band; returned is the constant.
    fn about<'a>(bands: Bands<'a>) -> f64 {
        let Bands { root, counts, noise, own, reach, out: [weights, shifts] } = bands;
        let seen = counts.iter().zip(noise).zip(root.iter().zip(own));
        let mut lanes = [0.0; LANES];
        for (place, (((counts, noise), (y, own)), (weight, shift))) in
            seen.zip(weights.iter_mut().zip(shifts)).enumerate()
        {
            let s = (counts + noise).max(0.0).sqrt();
            let usable = s > 1e-150 && *y > 0.0;
            let (residual, inverse) = ((own - counts) / (y + s), 1.0 / s);
            let w = (y * inverse).sqrt() / (s + y + reach);
            // Half of p/weight, p = −r/s.
            let half = -0.5 * residual * inverse / w;
            *weight = if usable { w } else { 0.0 };
            *shift = if usable { half - w * counts } else { 0.0 };
            lanes[place % LANES] += if usable { residual.mul_add(residual, -half * half) } else { 0.0 };
        }
        fold(&lanes)
    }
}
