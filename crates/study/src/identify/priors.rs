//! What priors make of the hardest pair, on average over what they allow.

use crate::{Study, Surface};
use hadar::error::Result;
use hadar::identifiability::bayes::{BayesianBound, Distances, Pair};
use hadar::identifiability::detection;
use hadar_scenario::DistanceKind;

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
    /// What the error of the average, 10⁻³ of the probability, may make of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub photons_required_relative_error: Option<f64>,
    /// States of the priors that were averaged over.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub states: Option<usize>,
    /// Photons by the hybrid Cramér–Rao bound of estimates of the material fraction: a local figure that averages
    /// information, no limit of decisions, which may need far more (near equilibrium) or fewer.
    pub photons_required_hybrid_bound: Option<f64>,
}

impl Study {
    /// The averages over the priors for one alternative; `None` without priors. `progress` is told the states looked at and
    /// how many there are.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn prior_average(
        &self,
        alternative: &Surface,
        progress: &dyn Fn(usize, usize),
    ) -> Result<Option<PriorAverage>> {
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
        let average = if probability < 1.0 {
            bound.photons_for_average(pair, probability, distances, progress)?
        } else {
            None
        };
        Ok(Some(PriorAverage {
            alternative: alternative.name.clone(),
            photons_required: average.map(|average| average.photons),
            photons_required_relative_error: average.map(|average| average.relative_error),
            states: average.map(|average| average.nodes),
            photons_required_hybrid_bound: bound.photons_required(pair, self.required)?,
        }))
    }
}
