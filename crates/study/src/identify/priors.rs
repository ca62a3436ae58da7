//! How often the hardest pair is decided rightly, on average over the priors of both materials.

use crate::{Study, Surface};
use hadar::error::Result;
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::bayes::{BayesianBound, Pair};
use hadar::identifiability::detection;

/// Two equally likely materials, the state of either drawn from its priors instead of being that of the scenario: finite also
/// where that state is in thermal equilibrium. The probability of a correct decision by the best test, that of the ratio of
/// the two mixtures, bounded from both sides.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct PriorAverage {
    /// Name of the alternative material in the library.
    pub alternative: String,
    /// Fewer photons than this are not enough for any test to be right as often as required; no number suffices where `None`.
    pub photons_required_lower: Option<f64>,
    /// With this number of photons the ratio of the mixtures is right with the required probability; not known where none.
    pub photons_required_upper: Option<f64>,
    /// Photons that the target in the scenario's state sends to the camera; `None` without a camera.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub photons: Option<f64>,
    /// With the camera a test is right at least this often; `None` where that is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub probability_lower: Option<f64>,
    /// With the camera no test is right more often.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub probability_upper: Option<f64>,
    /// States of each class that were averaged over, for the photons.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub states: Option<usize>,
    /// Unknowns without a prior: in the alternative they take the values nearest to the target, which bounds every test, and what
    /// a test reaches is not known.
    pub without_prior: Vec<&'static str>,
    /// Photons by the hybrid Cramér–Rao bound of estimates of the material fraction: a local figure that averages
    /// information, no limit of decisions, which may need far more (near equilibrium) or fewer.
    pub photons_required_hybrid_bound: Option<f64>,
}

impl Study {
    /// The averages over the priors for one alternative; `None` without priors. `progress` is told the lattices looked at and
    /// how many there are.
    ///
    /// # Errors
    /// A scene without photons; a prior outside the range of the alternative.
    pub fn prior_average(
        &self,
        alternative: &Surface,
        progress: &dyn Fn(usize, usize),
    ) -> Result<Option<PriorAverage>> {
        if !self.unknowns.has_priors() {
            return Ok(None);
        }
        let unknowns = self.decisive_unknowns();
        let bound = self.bound_over_priors(&unknowns);
        let pair = self.pair_over_priors(alternative);
        // Nearer to 1 there is no other number.
        let probability = detection::probability(self.required).min(1.0 - f64::EPSILON);
        let average = bound.photons_for_average(pair, probability, progress)?;
        let counting = self.counting();
        let at_camera =
            counting.as_ref().map(|counting| bound.average_probability(pair, counting)).transpose()?;
        Ok(Some(PriorAverage {
            alternative: alternative.name.clone(),
            photons_required_lower: average.map(|average| average.lower),
            photons_required_upper: average.and_then(|average| average.upper),
            photons: counting.map(|counting| counting.counts_per_radiance * self.photon_radiance()),
            probability_lower: at_camera.and_then(|found| found.lower),
            probability_upper: at_camera.map(|found| found.upper),
            states: average.map(|average| average.states),
            without_prior: self.without_prior(&unknowns).iter().map(|nuisance| nuisance.name()).collect(),
            photons_required_hybrid_bound: bound.photons_required(pair, self.required)?,
        }))
    }

    pub(crate) fn bound_over_priors(&self, unknowns: &Unknowns) -> BayesianBound<'_> {
        BayesianBound::new(&self.bands, &self.surroundings, unknowns.clone()).within(self.range)
    }

    pub(crate) fn pair_over_priors<'s>(&'s self, alternative: &'s Surface) -> Pair<'s> {
        Pair { emissivity: &self.target.emissivity, alternative: &alternative.emissivity, state: &self.state }
    }

    /// Unknowns without a prior.
    pub(crate) fn without_prior(&self, unknowns: &Unknowns) -> Vec<Nuisance> {
        unknowns.without_prior(self.surroundings.objects().len())
    }
}
