//! What priors make of the hardest pair, on average over what they allow.

use crate::scenario::DistanceKind;
use crate::study::{Study, Surface};
use hadar::error::Result;
use hadar::identifiability::bayes::{BayesianBound, Distances, Pair};
use hadar::identifiability::detection;

/// The target's state drawn from the priors, instead of standing where the scenario says: finite also where the
/// nominal state is in thermal equilibrium.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct PriorAverage {
    /// The alternative.
    pub alternative: String,
    /// Photons at which the detection probability, averaged over the prior, is that of the requirement; none
    /// suffice where `None`.
    pub photons_required: Option<f64>,
    /// Photons by the hybrid Cramér–Rao bound of estimates of the material fraction: a local figure that averages
    /// information, no limit of decisions, which may need far more (near equilibrium) or fewer.
    pub photons_required_hybrid_bound: Option<f64>,
}

impl Study {
    /// The averages over the priors for one alternative; `None` without priors.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn prior_average(&self, alternative: &Surface) -> Result<Option<PriorAverage>> {
        if !self.unknowns.has_priors() {
            return Ok(None);
        }
        let kind = self.scenario.requirement.by;
        let distances = match kind {
            DistanceKind::Nearest => Distances::Nearest(self.range),
            DistanceKind::Local | DistanceKind::LocalUnknownGain => Distances::Local,
        };
        let bound = BayesianBound::new(&self.bands, &self.surroundings, self.decisive_unknowns());
        let pair = Pair {
            emissivity: &self.target.emissivity,
            alternative: &alternative.emissivity,
            state: &self.state,
        };
        let probability = detection::probability(self.required);
        // Beyond d = 8 the probability is 1 to all its digits.
        let average =
            if probability < 1.0 { bound.photons_for_average(pair, probability, distances)? } else { None };
        Ok(Some(PriorAverage {
            alternative: alternative.name.clone(),
            photons_required: average,
            photons_required_hybrid_bound: bound.photons_required(pair, self.required)?,
        }))
    }
}
