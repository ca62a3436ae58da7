//! Spectra that are read at other wavenumbers than those of the bands.

use super::setting::Path;
use hadar::spectrum::interpolated;

/// Spectra of a setting on a grid that is finer than its bands, and reaches beyond them.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectra {
    /// Wavenumbers, rising, cm⁻¹.
    pub grid_cm1: Vec<f64>,
    /// Emissivities of the library.
    pub library: Vec<Vec<f64>>,
    /// Radiances of the surroundings; empty for those that are counted.
    pub surroundings: Vec<Vec<f64>>,
    /// The air before the camera.
    pub path: Option<Path>,
}

impl Spectra {
    /// A grid over nodes in which each step between two is divided into `parts`, and which reaches `beyond_cm1` further.
    #[must_use]
    pub fn grid(nodes_cm1: &[f64], parts: usize, beyond_cm1: f64) -> Vec<f64> {
        let mut nodes = nodes_cm1.to_vec();
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        let (Some(low), Some(high)) = (nodes.first().copied(), nodes.last().copied()) else { return nodes };
        let step = if nodes.len() > 1 { (high - low) / (nodes.len() - 1) as f64 } else { beyond_cm1 };
        let outside = (beyond_cm1 / step.max(f64::MIN_POSITIVE)).ceil().clamp(1.0, 1e3) as usize;
        nodes.splice(0..0, (1..=outside).rev().map(|i| low - step * i as f64).filter(|nu| *nu > 0.0));
        nodes.extend((1..=outside).map(|i| high + step * i as f64));
        let parts = parts.max(1);
        let last = nodes.last().copied();
        let each = nodes.windows(2).flat_map(|ends| {
            let (from, to) = (ends[0], ends[1]);
            (0..parts).map(move |i| from + (to - from) * (i as f64 / parts as f64))
        });
        each.chain(last).collect()
    }

    pub(super) fn at(&self, values: &[f64], nodes_cm1: &[f64]) -> Vec<f64> {
        nodes_cm1.iter().map(|nu| interpolated(&self.grid_cm1, values, *nu)).collect()
    }
}
