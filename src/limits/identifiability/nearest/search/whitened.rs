//! A pair in thinned bands, whitened by the target's own noise.

use super::table::{Emission, Thinned};
use crate::aligned::Aligned;
use crate::identifiability::nearest::residual::{Comparison, Target};

/// What does not depend on the alternative's state.
pub(super) struct Whitened {
    /// κ/(2√(κS + σ²)) of every band.
    whitening: Aligned,
    /// Whitened signal of the target.
    pub(super) signal: Aligned,
    /// Emissivity of the alternative at the thinned nodes, and what its emission in each band is multiplied by.
    pub(super) emissivity: Aligned,
    pub(super) strength: Aligned,
}

impl Whitened {
    pub(super) fn new(comparison: &Comparison<'_>, thinned: &Thinned, target: &Target<'_>) -> Self {
        let count = thinned.bands.len();
        let [mut signal, mut whitening] = [(); 2].map(|()| Aligned::unset(count));
        let bands = comparison.target.signal().iter().zip(comparison.noise()).step_by(thinned.stride);
        for ((s, noise), (signal, w)) in bands.zip(signal.iter_mut().zip(whitening.iter_mut())) {
            let root = (target.counts * s + noise).sqrt();
            *w = if root > 0.0 { 0.5 * target.counts / root } else { 0.0 };
            *signal = s * *w;
        }
        let at_nodes = thinned.nodes.iter().map(|&j| target.alternative[j]);
        let emissivity = Aligned::filled(thinned.nodes.len(), at_nodes);
        let strength = if thinned.bands.one_node_per_band() {
            let nodes = emissivity.iter().zip(thinned.bands.weights_cm1()).zip(&whitening);
            Aligned::filled(count, nodes.map(|((e, width), w)| e * width * w))
        } else {
            whitening.clone()
        };
        Self { whitening, signal, emissivity, strength }
    }

    /// Whitened (1 − e′)εₖB(Tₖ).
    pub(super) fn scattered(&self, thinned: &Thinned, radiance: &[f64]) -> Aligned {
        let nodes = thinned.nodes.iter().zip(&self.emissivity).map(|(&j, e)| (1.0 - e) * radiance[j]);
        let values = Aligned::filled(thinned.nodes.len(), nodes);
        let mut banded = Aligned::unset(thinned.bands.len());
        thinned.bands.weigh_into(&values, &mut banded);
        banded.iter_mut().zip(&self.whitening).for_each(|(value, w)| *value *= w);
        banded
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
