//! Distances from the target to every alternative, and what a camera makes of them.

use super::{PriorAverage, Study, Surface, Warning, warn};
use crate::error::Result;
use crate::fisher::{Counting, Nuisance, Unknowns};
use crate::identifiability::Status;
use crate::identifiability::detection::{self, ErrorBracket};
use crate::identifiability::local::{LocalDistance, LocalSolver};
use crate::identifiability::multi;
use crate::identifiability::nearest::{NearestDistance, NearestSolver};
use crate::policy;
use crate::scenario::{DistanceKind, Scenario};
use crate::scene::Parameter;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// What can be told apart from the target, alternative by alternative.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Identification {
    /// The scenario with its defaults filled in.
    pub scenario: Scenario,
    /// ΣS·Δν of the target, photons s⁻¹ m⁻² sr⁻¹.
    pub photon_radiance: f64,
    /// The pairs, in the order of the alternatives.
    pub pairs: Vec<PairResult>,
    /// The alternative that is hardest to tell apart.
    pub limiting: String,
    /// The target against the library as a whole (Algorithm 3).
    pub identifiability: Identifiability,
    /// The hardest alternative on average over the priors; `None` without priors.
    pub prior_average: Option<PriorAverage>,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
}

/// A target against all its alternatives (Algorithm 3): the one hardest to tell apart decides.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Identifiability {
    /// Least distance per √photon, by the distance that decides (S33).
    pub distance_minimum: f64,
    /// Least statistical distance with the camera.
    pub statistical_distance_minimum: Option<f64>,
    /// Φ of it.
    pub detection_probability_minimum: Option<f64>,
    /// Identifiability log₂ 2P of the paper, bits.
    pub identifiability_bits: Option<f64>,
    /// Whether the camera tells the target from every alternative as reliably as required.
    pub identifiable: Option<bool>,
    /// Alternatives that it tells the target from.
    pub told_from: Option<usize>,
    /// The paper's prediction vector S32, target first: a heuristic, no bound and no test's probability.
    pub prediction_heuristic: Option<Vec<Prediction>>,
}

/// An entry of the prediction vector S32.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Prediction {
    /// The material.
    pub material: String,
    /// Its share by S32.
    pub probability: f64,
}

/// The state of the alternative that looks most like the target.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct NearestState {
    /// Its temperature, K.
    pub temperature_k: f64,
    /// Its lighting factors.
    pub lighting: Vec<f64>,
    /// Its gain.
    pub gain: f64,
    /// Temperatures of the environment objects, K, where they are unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment_temperature_k: Option<Vec<f64>>,
}

/// Photons for the requirement by each reading of the distance, shot noise only.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct PhotonsRequired {
    /// By the nearest distance.
    pub nearest: Option<f64>,
    /// By the local distance.
    pub local: Option<f64>,
    /// By the local distance with unknown gain (S29).
    pub local_unknown_gain: Option<f64>,
}

impl PhotonsRequired {
    /// By the distance of a kind.
    #[must_use]
    pub const fn of(&self, kind: DistanceKind) -> Option<f64> {
        match kind {
            DistanceKind::Nearest => self.nearest,
            DistanceKind::Local => self.local,
            DistanceKind::LocalUnknownGain => self.local_unknown_gain,
        }
    }
}

/// One target against one alternative.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PairResult {
    /// The target's material.
    pub target: String,
    /// The alternative.
    pub alternative: String,
    /// Local distance per √photon, nuisances of the scenario.
    pub distance_local: f64,
    /// The same with gain unknown too: the paper's S29.
    pub distance_local_unknown_gain: f64,
    /// The same with nothing unknown but the material.
    pub distance_no_nuisance: f64,
    /// Nearest distance per √photon.
    pub distance_nearest: f64,
    /// The state it belongs to.
    pub nearest_state: NearestState,
    /// What of that state stands at the edge of its range.
    pub nearest_at_edge: Vec<String>,
    /// Distance from that state back to the target's material, per √photon.
    pub distance_return: f64,
    /// Photons for the requirement by the chosen distance, shot noise only; none suffice where `None`.
    pub photons_required: Option<f64>,
    /// The same by all three readings.
    pub photons_required_by: PhotonsRequired,
    /// Statistical distance of the camera by the chosen distance, with its noise.
    pub statistical_distance: Option<f64>,
    /// Whether that reaches the requirement.
    pub told_apart: Option<bool>,
    /// What the paper's shortcut √(N/(1+γ))·d₀ makes of it.
    pub statistical_distance_shortcut: Option<f64>,
    /// Φ(d).
    pub detection_probability: Option<f64>,
    /// 1 − Φ(d).
    pub miss_probability: Option<f64>,
    /// log₂ 2P.
    pub information_bits: Option<f64>,
    /// Mutual information of the binary decision.
    pub mutual_information_bits: Option<f64>,
    /// Estimate for a test that must fit temperature and lighting itself.
    pub two_sided_probability: Option<f64>,
    /// Rigorous bounds on the error of the best test between the two states.
    pub error_bracket: Option<ErrorBracket>,
    /// Condition number of the scaled scores; `None` if infinite.
    pub condition_number: Option<f64>,
    /// Estimated bound on the relative rounding error of the local distance.
    pub relative_error: f64,
    /// What kind of answer the local distance is.
    pub status: Status,
    /// The change of the nuisances that imitates the alternative, where the status is `blind`.
    pub blind_direction: Option<BTreeMap<String, f64>>,
}

impl PairResult {
    /// The distance per √photon of a kind.
    #[must_use]
    pub fn distance(&self, kind: DistanceKind) -> f64 {
        match kind {
            DistanceKind::Nearest => self.distance_nearest,
            DistanceKind::Local => self.distance_local,
            DistanceKind::LocalUnknownGain => self.distance_local_unknown_gain,
        }
    }
}

impl Study {
    /// Distances to every alternative; with a camera also what it makes of them.
    ///
    /// # Errors
    /// A scene without photons, or fewer bands than unknowns.
    pub fn identify(&self) -> Result<Identification> {
        let results: Result<Vec<(PairResult, Vec<Warning>)>> =
            self.alternatives.par_iter().map(|alternative| self.pair(alternative)).collect();
        let (pairs, pair_warnings): (Vec<_>, Vec<_>) = results?.into_iter().unzip();
        let kind = self.scenario.requirement.by;
        let decisive = |pair: &PairResult| pair.statistical_distance.unwrap_or_else(|| pair.distance(kind));
        let limiting = pairs
            .iter()
            .min_by(|a, b| decisive(a).total_cmp(&decisive(b)))
            .map_or_else(String::new, |pair| pair.alternative.clone());
        let mut warnings = self.warnings.clone();
        warnings.extend(self.camera_warnings());
        warnings.extend(pair_warnings.into_iter().flatten());
        Ok(Identification {
            scenario: self.scenario.clone(),
            photon_radiance: self.photon_radiance(),
            identifiability: self.identifiability(&pairs),
            prior_average: match self.alternative(&limiting) {
                Some(alternative) => self.prior_average(alternative)?,
                None => None,
            },
            pairs,
            limiting,
            warnings,
        })
    }

    /// What the pairs say together.
    fn identifiability(&self, pairs: &[PairResult]) -> Identifiability {
        let kind = self.scenario.requirement.by;
        let least = |values: Vec<f64>| values.into_iter().fold(f64::INFINITY, f64::min);
        let statistical: Option<Vec<f64>> = pairs.iter().map(|pair| pair.statistical_distance).collect();
        let minimum = statistical.clone().map(least);
        let prediction = statistical.as_ref().map(|distances| {
            let names = std::iter::once(&self.target.name).chain(pairs.iter().map(|pair| &pair.alternative));
            let shares = names.zip(multi::prediction(distances));
            shares.map(|(name, probability)| Prediction { material: name.clone(), probability }).collect()
        });
        Identifiability {
            distance_minimum: least(pairs.iter().map(|pair| pair.distance(kind)).collect()),
            statistical_distance_minimum: minimum,
            detection_probability_minimum: minimum.map(detection::probability),
            identifiability_bits: minimum.map(detection::information_bits),
            identifiable: minimum.map(|d| d >= self.required),
            told_from: statistical.map(|d| d.iter().filter(|d| **d >= self.required).count()),
            prediction_heuristic: prediction,
        }
    }

    /// ΣS·Δν of the target, photons s⁻¹ m⁻² sr⁻¹.
    #[must_use]
    pub fn photon_radiance(&self) -> f64 {
        self.target_signal().iter().sum()
    }

    /// Signal of the target in each band, photons s⁻¹ m⁻² sr⁻¹.
    #[must_use]
    pub fn target_signal(&self) -> Vec<f64> {
        self.bands.weigh(&self.surroundings.signal(&self.target.emissivity, &self.state))
    }

    /// Counting of the scenario's camera.
    #[must_use]
    pub fn counting(&self) -> Option<Counting> {
        self.camera.as_ref().map(|camera| camera.counting(&self.bands, self.scenario.target.distance_m))
    }

    fn pair(&self, alternative: &Surface) -> Result<(PairResult, Vec<Warning>)> {
        let kind = self.scenario.requirement.by;
        let counting = self.counting();
        let signal = self.target_signal();
        let photon_radiance: f64 = signal.iter().sum();
        let camera_photons = counting.as_ref().map(|counting| counting.counts_per_radiance * photon_radiance);
        // Priors weigh by the number of photons they compete with: the camera's, else those required.
        let with_priors = if self.unknowns.has_priors() {
            Some(PhotonsRequired {
                nearest: self.photons_with_priors(DistanceKind::Nearest, alternative)?,
                local: self.photons_with_priors(DistanceKind::Local, alternative)?,
                local_unknown_gain: self.photons_with_priors(DistanceKind::LocalUnknownGain, alternative)?,
            })
        } else {
            None
        };
        let photons = camera_photons.or(with_priors.and_then(|by| by.of(kind))).unwrap_or(f64::INFINITY);
        let local = self.local(self.unknowns.clone(), alternative, photons)?;
        let nearest = self.nearest(alternative, photons)?;
        let unknown_gain = self.local_unknown_gain(alternative, photons)?;
        let required = |distance: f64| policy::photons_required(self.required, distance);
        let required_by = with_priors.unwrap_or_else(|| PhotonsRequired {
            nearest: required(nearest.distance),
            local: required(local.distance),
            local_unknown_gain: required(unknown_gain),
        });
        let back = self.return_distance(alternative, &nearest)?;
        let statistical = counting
            .as_ref()
            .map(|counting| self.statistical_distance(kind, alternative, counting))
            .transpose()?;
        let shortcut = counting.as_ref().map(|counting| {
            let gamma = crate::instrument::gamma_per_band(counting, &signal);
            let distance = match kind {
                DistanceKind::Nearest => nearest.distance,
                DistanceKind::Local => local.distance,
                DistanceKind::LocalUnknownGain => unknown_gain,
            };
            (photon_radiance * counting.counts_per_radiance / (1.0 + gamma)).sqrt() * distance
        });
        let condition = local.condition_number();
        let blind = (local.status == Status::Blind).then(|| {
            local.imitation.iter().map(|(parameter, change)| (parameter_name(*parameter), *change)).collect()
        });
        let ratio = if nearest.distance > 0.0 { (back.distance / nearest.distance).min(1.0) } else { 1.0 };
        let environment = self.is_unknown(Nuisance::EnvironmentTemperature);
        let result = PairResult {
            target: self.target.name.clone(),
            alternative: alternative.name.clone(),
            distance_local: local.distance,
            distance_local_unknown_gain: unknown_gain,
            distance_no_nuisance: local.distance_no_nuisance,
            distance_nearest: nearest.distance,
            nearest_state: NearestState {
                temperature_k: nearest.state.temperature_k,
                lighting: nearest.state.lighting.clone(),
                gain: nearest.state.gain,
                environment_temperature_k: environment.then(|| nearest.state.environment_k.clone()),
            },
            nearest_at_edge: nearest.at_edge.iter().map(|parameter| parameter_name(*parameter)).collect(),
            distance_return: back.distance,
            photons_required: required_by.of(kind),
            photons_required_by: required_by,
            statistical_distance: statistical,
            told_apart: statistical.map(|d| d >= self.required),
            statistical_distance_shortcut: shortcut,
            detection_probability: statistical.map(detection::probability),
            miss_probability: statistical.map(detection::miss_probability),
            information_bits: statistical.map(detection::information_bits),
            mutual_information_bits: statistical.map(detection::mutual_information_bits),
            two_sided_probability: statistical.map(|d| detection::two_sided_probability(d, ratio)),
            error_bracket: statistical.map(detection::error_bracket),
            condition_number: condition.is_finite().then_some(condition),
            relative_error: local.relative_error,
            status: local.status,
            blind_direction: blind,
        };
        let warnings = warn::of_pair(&result, &local, &nearest, kind);
        Ok((result, warnings))
    }

    /// Local distance per √photon among `photons` photons.
    fn local(&self, unknowns: Unknowns, alternative: &Surface, photons: f64) -> Result<LocalDistance> {
        LocalSolver::new(&self.bands, &self.surroundings, unknowns)
            .per_photon(&self.target.emissivity, &alternative.emissivity, &self.state, photons)
            .map_err(|error| error.at(self.scenario.place("bands")))
    }

    /// The same with gain unknown too; with no band to spare for it nothing is left, exactly.
    fn local_unknown_gain(&self, alternative: &Surface, photons: f64) -> Result<f64> {
        let unknowns = self.unknowns.with(Nuisance::Gain);
        if !self.enough_bands(&unknowns) {
            return Ok(0.0);
        }
        Ok(self.local(unknowns, alternative, photons)?.distance)
    }

    /// Whether there are more bands than unknowns without a prior.
    pub(super) fn enough_bands(&self, unknowns: &Unknowns) -> bool {
        let parameters = unknowns.parameters(self.surroundings.objects().len());
        let free = parameters.iter().filter(|parameter| unknowns.sigma_prior(**parameter).is_none()).count();
        self.bands.len() > free
    }

    fn nearest(&self, alternative: &Surface, photons: f64) -> Result<NearestDistance> {
        NearestSolver::new(&self.bands, &self.surroundings, self.unknowns.clone(), self.range).per_photon(
            &self.target.emissivity,
            &alternative.emissivity,
            &self.state,
            photons,
        )
    }

    /// From the nearest state back to the target's own material, within all that physics allows.
    fn return_distance(&self, alternative: &Surface, nearest: &NearestDistance) -> Result<NearestDistance> {
        NearestSolver::new(&self.bands, &self.surroundings, self.unknowns.clone(), self.range).per_photon(
            &alternative.emissivity,
            &self.target.emissivity,
            &nearest.state,
            f64::INFINITY,
        )
    }

    /// Statistical distance d of a kind at given counts and noise.
    pub(super) fn statistical_distance(
        &self,
        kind: DistanceKind,
        alternative: &Surface,
        counting: &Counting,
    ) -> Result<f64> {
        let (target, other) = (&self.target.emissivity, &alternative.emissivity);
        let local = |unknowns: Unknowns| {
            LocalSolver::new(&self.bands, &self.surroundings, unknowns)
                .with_counting(target, other, &self.state, counting)
                .map(|local| local.distance)
        };
        match kind {
            DistanceKind::Nearest => {
                NearestSolver::new(&self.bands, &self.surroundings, self.unknowns.clone(), self.range)
                    .with_counting(target, other, &self.state, counting)
                    .map(|nearest| nearest.distance)
            }
            DistanceKind::Local => local(self.unknowns.clone()),
            DistanceKind::LocalUnknownGain => {
                let unknowns = self.unknowns.with(Nuisance::Gain);
                if self.enough_bands(&unknowns) { local(unknowns) } else { Ok(0.0) }
            }
        }
    }

    /// Distance per √photon of a kind, priors counting as among `photons` photons.
    pub(super) fn distance_per_photon(
        &self,
        kind: DistanceKind,
        alternative: &Surface,
        photons: f64,
    ) -> Result<f64> {
        match kind {
            DistanceKind::Nearest => self.nearest(alternative, photons).map(|nearest| nearest.distance),
            DistanceKind::Local => {
                self.local(self.unknowns.clone(), alternative, photons).map(|local| local.distance)
            }
            DistanceKind::LocalUnknownGain => self.local_unknown_gain(alternative, photons),
        }
    }

    /// What is unknown for the distance that decides.
    pub(super) fn decisive_unknowns(&self) -> Unknowns {
        match self.scenario.requirement.by {
            DistanceKind::LocalUnknownGain => self.unknowns.with(Nuisance::Gain),
            DistanceKind::Nearest | DistanceKind::Local => self.unknowns.clone(),
        }
    }

    /// Photons at which √N d₀(N) meets the requirement, d₀ depending on N through the priors.
    fn photons_with_priors(&self, kind: DistanceKind, alternative: &Surface) -> Result<Option<f64>> {
        let excess = |log: f64| {
            let photons = log.exp();
            Ok((photons.sqrt() * self.distance_per_photon(kind, alternative, photons)? / self.required)
                .max(1e-300)
                .ln())
        };
        // From a millionth of a photon to 10⁶⁰ of them.
        let (low, high) = (-14.0, 138.0);
        if excess(high)? < 0.0 {
            return Ok(None);
        }
        if excess(low)? >= 0.0 {
            return Ok(Some(0.0));
        }
        crate::root::crossing(low, high, excess).map(|log| Some(log.exp()))
    }
}

/// Name of a parameter as it stands in results.
pub(super) fn parameter_name(parameter: Parameter) -> String {
    match parameter {
        Parameter::Temperature => "temperature_k".into(),
        Parameter::Lighting(k) => format!("lighting[{k}]"),
        Parameter::Gain => "gain".into(),
        Parameter::EnvironmentTemperature(k) => format!("environment_temperature_k[{k}]"),
        Parameter::Material => "material".into(),
    }
}
