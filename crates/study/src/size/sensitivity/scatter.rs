//! How the emissivity of a surface may scatter: by a stated deviation and correlation length (`ripple`), or by the sample covariance of
//! the spectra of a class, Σ_i m_i m_iᵀ with m_i = √(w_i/(1 − Σw²)) (e_i − ē): a draw is ē + Σ_i z_i m_i, z_i independent standard normal.

use super::ripple::Ripple;
use crate::Study;
use crate::classes::Members;
use hadar_scenario::{SensitivitySpec, Spread};
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// How an emissivity scatters about what is entered.
pub(crate) enum Scatter<'s> {
    Ripple(Ripple),
    /// Of the sample of a class.
    Modes(&'s [Vec<f64>]),
}

/// Where a scatter is from.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ScatterOf {
    /// Name of the class of materials.
    pub class: String,
    /// Root mean square over the bands.
    pub error: f64,
    /// Length over which errors are correlated, cm⁻¹; `None` for the sample covariance of the class.
    pub correlation_cm1: Option<f64>,
    /// Number of spectra in the class.
    pub spectra: usize,
}

impl Scatter<'_> {
    /// Deviation at a node.
    pub(crate) fn sigma(&self, node: usize) -> f64 {
        match self {
            Self::Ripple(ripple) => ripple.sigma,
            Self::Modes(modes) => modes.iter().map(|mode| mode[node] * mode[node]).sum::<f64>().sqrt(),
        }
    }

    /// An emissivity that is drawn.
    pub(crate) fn applied(&self, emissivity: &[f64], random: &mut ChaCha8Rng) -> Vec<f64> {
        match self {
            Self::Ripple(ripple) => ripple.applied(emissivity, random),
            Self::Modes(modes) => {
                let mut drawn = emissivity.to_vec();
                for mode in *modes {
                    let z: f64 = StandardNormal.sample(random);
                    drawn.iter_mut().zip(mode).for_each(|(e, m)| *e += z * m);
                }
                drawn.iter_mut().for_each(|e| *e = e.clamp(0.0, 1.0));
                drawn
            }
        }
    }
}

impl Study {
    /// How the target's emissivity, and that of alternative `index`, scatter: as their classes say, else as `spec` does.
    pub(crate) fn scatters(
        &self,
        index: usize,
        spec: SensitivitySpec,
    ) -> [(Scatter<'_>, Option<ScatterOf>); 2] {
        let [targets, alternatives] = &self.members;
        let nodes = self.bands.nodes_cm1();
        let ripple = |spec: SensitivitySpec| {
            Scatter::Ripple(Ripple::new(nodes, spec.emissivity_error, spec.correlation_cm1))
        };
        let of_class = |members: &Members, error: f64, correlation_cm1: Option<f64>| ScatterOf {
            class: members.name.clone(),
            error,
            correlation_cm1,
            spectra: members.spectra,
        };
        [targets.first(), alternatives.get(index)].map(|members| {
            let Some(members) = members else { return (ripple(spec), None) };
            if !members.modes.is_empty() {
                let squares = members.modes.iter().flatten().map(|m| m * m).sum::<f64>();
                let of = of_class(members, (squares / nodes.len() as f64).sqrt(), None);
                return (Scatter::Modes(&members.modes), Some(of));
            }
            match members.spec.as_ref().and_then(|class| class.spread) {
                Some(Spread::Stated { emissivity_error, correlation_cm1 }) => {
                    let of = of_class(members, emissivity_error, Some(correlation_cm1));
                    (ripple(SensitivitySpec { emissivity_error, correlation_cm1 }), Some(of))
                }
                Some(Spread::Sample) | None => (ripple(spec), None),
            }
        })
    }
}
