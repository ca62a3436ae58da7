//! Errors of an emissivity that are correlated along the wavenumber: δ_{k+1} = ρ δ_k + s √(1 − ρ²) z, ρ = exp(−Δν/ℓ), with
//! deviation s, correlation length ℓ (cm⁻¹) and independent standard normal z.

use hadar::order;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Correlated errors at the nodes of the bands.
pub(crate) struct Ripple {
    /// Nodes in ascending wavenumber, with the correlation to the one before.
    pub(crate) chain: Vec<(usize, f64)>,
    pub(crate) sigma: f64,
}

impl Ripple {
    /// Of deviation `sigma` and that correlation length.
    pub(crate) fn new(nodes_cm1: &[f64], sigma: f64, correlation_cm1: f64) -> Self {
        let mut order: Vec<usize> = (0..nodes_cm1.len()).collect();
        order::ascending(&mut order, |a| nodes_cm1[*a]);
        let mut before = f64::NEG_INFINITY;
        let chain = order.into_iter().map(|node| {
            let correlation = ((before - nodes_cm1[node]) / correlation_cm1).exp();
            before = nodes_cm1[node];
            (node, correlation)
        });
        Self { chain: chain.collect(), sigma }
    }

    /// An emissivity with errors.
    pub(crate) fn applied(&self, emissivity: &[f64], random: &mut ChaCha8Rng) -> Vec<f64> {
        let mut shaken = emissivity.to_vec();
        let mut error = 0.0;
        for (node, correlation) in &self.chain {
            let fresh: f64 = StandardNormal.sample(random);
            error = correlation * error + (1.0 - correlation * correlation).sqrt() * fresh;
            shaken[*node] = (emissivity[*node] + self.sigma * error).clamp(0.0, 1.0);
        }
        shaken
    }
}
