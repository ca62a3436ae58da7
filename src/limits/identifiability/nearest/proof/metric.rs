//! The quadratic about the target that lies below the distance.
//!
//! With y = √(N + v) of the target and s = √(N′ + v) of the alternative, (y − s)² = (N′ − N)²/(y + s)². A state nearer than d has
//! s ≤ y + d in *every* band: none is below Σ (N′ − N)²/(2y + d)².

use crate::sum::dot;

/// ‖weight · N′ + shift‖².
#[derive(Debug, Clone, Default)]
pub(super) struct Metric {
    pub(super) weight: Vec<f64>,
    pub(super) shift: Vec<f64>,
    /// ‖shift‖².
    pub(super) cost: f64,
}

impl Metric {
    /// Of a target of such roots and counts, for distances up to a reach.
    pub(super) fn about_target(root: &[f64], counts: &[f64], reach: f64) -> Self {
        let sums = root.iter().map(|y| 2.0 * y + reach);
        let weight: Vec<f64> = sums.map(|sum| if sum > 0.0 { 1.0 / sum } else { 0.0 }).collect();
        let shift: Vec<f64> = weight.iter().zip(counts).map(|(w, n)| -w * n).collect();
        let cost = dot(&shift, &shift);
        Self { weight, shift, cost }
    }
}
