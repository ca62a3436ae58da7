//! Projection of columns that are whitened first, and brought to a length near 1 by a power of two each.
//!
//! The elements are scores s = a·√u, formed without a square that could overflow or underflow before the result does. For
//! scenes of hardly any light, unknowns of hardly any effect or that are nearly the same, and wherever a prior adds a row.

use super::LocalSolver;
use crate::fisher::Reduced;
use crate::scene::{Columns, State};
use crate::units::times_power_of_two;

impl LocalSolver<'_> {
    /// Projects the columns of the last evaluation, the weight u of a band being the square of `root` of its index and
    /// signal; priors count as among so many photons as `sqrt_photons` is the square root of.
    pub(super) fn reduce_scaled(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        root: impl Fn(usize, f64) -> f64,
        sqrt_photons: f64,
    ) -> Reduced {
        let roots: Vec<f64> = self
            .jacobian
            .signal()
            .iter()
            .enumerate()
            // A band without photons tells nothing.
            .map(|(w, &signal)| Some(root(w, signal)).filter(|root| root.is_finite()).unwrap_or(0.0))
            .collect();
        let priors: Vec<(usize, f64)> = self
            .parameters
            .iter()
            .enumerate()
            .filter(|_| sqrt_photons.is_finite())
            .filter_map(|(i, parameter)| self.unknowns.sigma_prior(*parameter).map(|sigma| (i, sigma)))
            .collect();
        let rows = roots.len() + priors.len();
        self.columns.clear();
        let mut powers = Vec::with_capacity(self.parameters.len());
        for i in 0..self.parameters.len() {
            let start = self.columns.len();
            self.columns.extend(self.jacobian.column(i).iter().zip(&roots).map(|(a, root)| a * root));
            self.columns.extend(
                priors.iter().map(
                    |&(owner, sigma)| {
                        if owner == i { 1.0 / (sigma * sqrt_photons) } else { 0.0 }
                    },
                ),
            );
            let column = &mut self.columns[start..];
            let largest = column.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
            let power = if largest > 0.0 && largest.is_finite() { largest.log2().floor() as i32 } else { 0 };
            column.iter_mut().for_each(|value| *value = times_power_of_two(*value, -power));
            powers.push(power);
        }
        self.ones.clear();
        self.ones.resize(rows, 1.0);
        let root = |w: usize| roots[w];
        let [cancellation, nuisances] = self.cancellations(emissivity, alternative, state, root);
        let last = self.columns.rchunks(rows.max(1)).next().unwrap_or_default();
        let norm = crate::sum::dot(last, last).sqrt();
        let columns = Columns { values: &mut self.columns, stride: rows };
        let found = self.projector.reduce(columns, &self.ones, cancellation).blurred(nuisances);
        self.projector.unscale(&powers, Reduced { norm, ..found })
    }
}
