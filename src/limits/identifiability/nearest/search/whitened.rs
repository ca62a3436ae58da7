//! A pair in thinned bands, whitened by the target's own noise.

use super::table::{Emission, Thinned};
use crate::aligned::Aligned;
use crate::identifiability::nearest::residual::{Comparison, Target};

/// What does not depend on the alternative's state.
pub(super) struct Whitened {
    /// κ/(2√(κS + σ²)) of every band.
    whitening: Vec<f64>,
    /// Whitened signal of the target.
    pub(super) signal: Aligned,
    /// Emissivity of the alternative at the thinned nodes, and what its emission in each band is multiplied by.
    pub(super) emissivity: Vec<f64>,
    pub(super) strength: Aligned,
}

impl Whitened {
    pub(super) fn new(comparison: &Comparison<'_>, thinned: &Thinned, target: &Target<'_>) -> Self {
        let kept = |values: &[f64]| -> Vec<f64> { values.iter().copied().step_by(thinned.stride).collect() };
        let signal = kept(comparison.target.signal());
        let whitening: Vec<f64> = signal
            .iter()
            .zip(kept(comparison.noise()))
            .map(|(signal, noise)| (target.counts * signal + noise).sqrt())
            .map(|root| if root > 0.0 { 0.5 * target.counts / root } else { 0.0 })
            .collect();
        let emissivity: Vec<f64> = thinned.nodes.iter().map(|&j| target.alternative[j]).collect();
        let signal: Vec<f64> = signal.iter().zip(&whitening).map(|(s, w)| s * w).collect();
        let strength = if thinned.bands.one_node_per_band() {
            let nodes = emissivity.iter().zip(thinned.bands.weights_cm1()).zip(&whitening);
            let strength: Vec<f64> = nodes.map(|((e, width), w)| e * width * w).collect();
            Aligned::from(&strength[..])
        } else {
            Aligned::from(&whitening[..])
        };
        Self { whitening, signal: Aligned::from(&signal[..]), emissivity, strength }
    }

    fn whiten(&self, thinned: &Thinned, node_values: &[f64]) -> Vec<f64> {
        let mut banded = thinned.bands.weigh(node_values);
        banded.iter_mut().zip(&self.whitening).for_each(|(value, w)| *value *= w);
        banded
    }

    /// Whitened (1 − e′)εₖB(Tₖ).
    pub(super) fn scattered(&self, thinned: &Thinned, radiance: &[f64]) -> Vec<f64> {
        let nodes = thinned.nodes.iter().zip(&self.emissivity);
        let values: Vec<f64> = nodes.map(|(&j, e)| (1.0 - e) * radiance[j]).collect();
        self.whiten(thinned, &values)
    }

    /// The whitened emission of the alternative, and its derivative along T′.
    pub(super) fn emission(&self, emission: &Emission) -> [Vec<f64>; 2] {
        emission.spectra().map(|spectrum| spectrum.iter().zip(&*self.strength).map(|(b, s)| b * s).collect())
    }

    /// Σ over the thinned bands of the alternative's emission is that of these times the blackbody radiance.
    pub(super) fn emitted(&self, thinned: &Thinned) -> Vec<f64> {
        self.emissivity.iter().zip(thinned.bands.weights_cm1()).map(|(e, width)| e * width).collect()
    }
}
