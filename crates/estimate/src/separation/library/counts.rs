//! How many groups: each count judged by pixels that were kept apart.
//!
//! The loss of a pixel is ν ln(χ²/ν) − 2 ln π, ν its degrees of freedom, π the share of its group. The fewest groups within a standard error of
//! the least mean loss are taken.

use super::super::group::{chi_square, states};
use super::super::sample::Sample;
use super::Tried;
use super::fit::{Made, Maker};
use hadar::error::Result;
use rayon::prelude::*;

impl Maker<'_> {
    /// The place of the count that is taken, and the loss of each.
    pub(super) fn judged(&self, made: &[(usize, Made)], kept: &Sample) -> Result<(usize, Vec<Tried>)> {
        let mut losses: Vec<Vec<f64>> = Vec::new();
        let mut tried = Vec::new();
        for (count, made) in made {
            let curves: Vec<Vec<f64>> =
                made.curves.iter().map(|c| self.radiometry.at_nodes(&c.emissivity)).collect();
            let prior = made.curves.iter().map(|c| self.probability(&c.emissivity)).collect();
            let maps = kept.decomposed(self.setting, &curves, prior)?;
            let found = states(&maps, self.radiometry);
            let total: usize = made.information.iter().map(|i| i.pixels).sum();
            let unknowns = 1 + self.radiometry.changes().len();
            let freedom = (self.radiometry.used.len() as f64 - unknowns as f64).max(1.0);
            let terms: Vec<[f64; 2]> = found
                .par_iter()
                .enumerate()
                .map(|(i, state)| {
                    // What no group explains costs the same with every count.
                    let Some(state) = state else { return [0.0; 2] };
                    let e: Vec<f64> = self
                        .radiometry
                        .used
                        .iter()
                        .map(|b| made.curves[state.group].emissivity[*b])
                        .collect();
                    let counts = kept.used(i, &self.radiometry.used);
                    let chi = chi_square(self.radiometry, &counts, &e, state).max(f64::MIN_POSITIVE);
                    let share = made.information[state.group].pixels as f64 / total.max(1) as f64;
                    [freedom * libm::log(chi / freedom), -2.0 * libm::log(share)]
                })
                .collect();
            let each: Vec<f64> = terms.iter().map(|[chi, name]| chi + name).collect();
            let pixels = each.len().max(1) as f64;
            tried.push(Tried {
                count: *count,
                left: made.curves.len(),
                loss: each.iter().sum::<f64>() / pixels,
                error: 0.0,
                chi_square_reduced: libm::exp(terms.iter().map(|t| t[0]).sum::<f64>() / pixels / freedom),
            });
            losses.push(each);
        }
        let best = (0..tried.len()).min_by(|a, b| tried[*a].loss.total_cmp(&tried[*b].loss)).unwrap_or(0);
        for (own, loss) in tried.iter_mut().zip(&losses) {
            let apart: Vec<f64> = loss.iter().zip(&losses[best]).map(|(a, b)| a - b).collect();
            let count = apart.len().max(2) as f64;
            let mean = apart.iter().sum::<f64>() / count;
            own.error =
                (apart.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count * (count - 1.0))).sqrt();
        }
        let least = tried[best].loss;
        let chosen = tried.iter().position(|one| one.loss <= least + one.error).unwrap_or(best);
        Ok((chosen, tried))
    }
}
