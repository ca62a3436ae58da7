//! Errors of the emissivity of one surface, as errors of the counts of its bands: κ Σ_j w_j C_j δ_j over the nodes j of a band, κ counts per
//! radiance, w_j weight of a node, C_j its contrast, δ_j the error with the covariance of a [`Scatter`].

use crate::size::sensitivity::scatter::Scatter;
use hadar::identifiability::shared::{ErrorChain, SharedCovariance};
use hadar::spectrum::Bands;

/// The band of every node.
pub(super) fn band_of(bands: &Bands) -> Vec<usize> {
    let nodes = bands.sum_nodes(&vec![1.0; bands.nodes_cm1().len()]);
    let of_band = |(band, nodes): (usize, &f64)| std::iter::repeat_n(band, *nodes as usize);
    nodes.iter().enumerate().flat_map(of_band).collect()
}

/// Errors of one surface, and what each of its nodes does to the counts of its band.
pub(super) struct Errors<'s> {
    pub(super) scatter: &'s Scatter<'s>,
    /// κ w_j C_j, counts.
    pub(super) counts: Vec<f64>,
}

impl Errors<'_> {
    /// Adds Σ_v |C_wv|, or more, of every band.
    pub(super) fn add_sums(&self, band_of: &[usize], sums: &mut [f64]) {
        match self.scatter {
            Scatter::Modes(modes) => {
                for mode in *modes {
                    // Whatever the signs of the counts.
                    let mut moved = vec![0.0; sums.len()];
                    for ((band, counts), m) in band_of.iter().zip(&self.counts).zip(mode) {
                        moved[*band] += (counts * m).abs();
                    }
                    let all: f64 = moved.iter().sum();
                    sums.iter_mut().zip(&moved).for_each(|(sum, m)| *sum += m * all);
                }
            }
            Scatter::Ripple(ripple) => {
                let var = ripple.sigma * ripple.sigma;
                // Σ over all nodes before this one, and over all behind it, with their correlations.
                let mut before = 0.0;
                for (node, correlation) in &ripple.chain {
                    let own = self.counts[*node].abs();
                    before *= correlation;
                    sums[band_of[*node]] += var * own * (before + own);
                    before += own;
                }
                let (mut behind, mut correlation) = (0.0, 0.0);
                for (node, to_before) in ripple.chain.iter().rev() {
                    behind *= correlation;
                    sums[band_of[*node]] += var * self.counts[*node].abs() * behind;
                    behind += self.counts[*node].abs();
                    correlation = *to_before;
                }
            }
        }
    }

    /// Counts by which one mode of the emissivity moves every band.
    fn moved(&self, mode: &[f64], band_of: &[usize], bands: usize) -> Vec<f64> {
        let mut moved = vec![0.0; bands];
        for ((band, counts), m) in band_of.iter().zip(&self.counts).zip(mode) {
            moved[*band] += counts * m;
        }
        moved
    }

    /// Adds the covariance of the bands.
    pub(super) fn add_covariance(&self, band_of: &[usize], covariance: &mut SharedCovariance, bands: usize) {
        match self.scatter {
            Scatter::Modes(modes) => {
                modes.iter().for_each(|mode| covariance.add_mode(&self.moved(mode, band_of, bands)));
            }
            Scatter::Ripple(ripple) => {
                let var = ripple.sigma * ripple.sigma;
                // Of every band what its nodes before have in common with the next one.
                let mut before = vec![0.0; bands];
                for (node, correlation) in &ripple.chain {
                    let (band, own) = (band_of[*node], self.counts[*node]);
                    before.iter_mut().for_each(|sum| *sum *= correlation);
                    covariance.add(band, band, var * own * own);
                    for (other, sum) in before.iter().enumerate().filter(|(_, sum)| **sum != 0.0) {
                        covariance.add(band, other, var * own * sum);
                        covariance.add(other, band, var * own * sum);
                    }
                    before[band] += own;
                }
            }
        }
    }

    /// As a chain along bands of one node each, which these are in their order.
    pub(super) fn chain(&self, order: &[usize]) -> Option<ErrorChain> {
        let Scatter::Ripple(ripple) = self.scatter else { return None };
        let counts = order.iter().map(|node| ripple.sigma * self.counts[*node]).collect();
        Some(ErrorChain { counts, correlation: ripple.chain.iter().map(|(_, rho)| *rho).collect() })
    }
}
