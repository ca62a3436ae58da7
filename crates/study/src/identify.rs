//! Distances from the target to every alternative, and what a camera makes of them.

mod answers;
mod bands_that_matter;
mod chosen_bands;
mod exact;
mod matrix;
mod priors;
mod results;
mod safety;
mod samples;
mod scaling;
mod within_reach;

pub use answers::{Answers, Asked, Watch};
pub use bands_that_matter::{BandsThatMatter, Choice, Passband};
pub use chosen_bands::Reached;
pub use exact::{Exact, ExactLibrary, ExactPair, Law, Trial};
pub use matrix::{Apart, Check, Matrix, Rows, TargetVerdict};
pub use priors::PriorAverage;
pub(super) use results::PhotonsRequired;
pub use results::{
    Identifiability, Identification, NearestProof, NearestState, PairResult, Prediction, SafetyMaterial,
    SafetyOfTarget,
};
pub(super) use safety::AT_99;
pub use samples::SampleSpectra;
pub(super) use scaling::quantile;
pub use scaling::{BandNumber, LibrarySize, Scaling};

use super::classes::MixtureAnswer;
use super::decision::YesNo;
use super::distances::Statistical;
use super::remembered::PerPhoton;
use super::{Study, Surface, Warning, warn};
use hadar::demand::{self, Ledger};
use hadar::error::Result;
use hadar::fisher::{Counting, Nuisance};
use hadar::identifiability::Status;
use hadar::identifiability::detection;
use hadar::identifiability::multi;
use hadar::identifiability::nearest::{NearestDistance, leaves_priors_out};
use hadar::instrument::Camera;
use hadar::parallel;
use hadar::policy;
use hadar::scene::Parameter;
use hadar_scenario::DistanceKind;

impl Study {
    /// Distances to every alternative; with a camera also what it makes of them.
    ///
    /// # Errors
    /// A scene without photons, or fewer bands than unknowns.
    pub fn identify(&self) -> Result<Identification> {
        let ledger = Ledger::open();
        demand::add(&self.looked_up);
        let found = parallel::booked(self.alternatives.len(), |index| {
            let mixtures = self.classes.get(index).and_then(|answer| answer.mixtures.as_ref());
            self.against(index).pair(&self.alternatives[index], mixtures)
        })?;
        let (pairs, pair_warnings): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        let limiting =
            self.limiting(&pairs).map_or_else(String::new, |index| pairs[index].alternative.clone());
        let mut warnings = self.warnings.clone();
        warnings.extend(self.camera_warnings());
        if self.scenario.envelope.is_some() {
            warnings.push(Warning::EnvelopeNotSearched);
        }
        warnings.extend(pair_warnings.into_iter().flatten());
        Ok(Identification {
            scenario: self.scenario.clone(),
            photon_radiance: self.photon_radiance(),
            identifiability: self.identifiability(&pairs),
            prior_average: None,
            safety: self.safety(&pairs)?,
            pairs,
            limiting,
            classes: self.classes.clone(),
            conditions: Vec::new(),
            warnings,
            stats: ledger.close(),
        })
    }

    /// The same with what a 'yes' of its camera rests on.
    ///
    /// # Errors
    /// As [`Study::identify`].
    pub fn identify_with_conditions(&self) -> Result<Identification> {
        let mut found = self.identify()?;
        if let Some(camera) = &self.camera {
            found.conditions = self.conditions_of_pairs(camera, &found.pairs, &[])?;
        }
        Ok(found)
    }

    /// The pair that decides, by its place, since two alternatives may have the same name: the nearest that was found of those surely not
    /// told, else that of which the least is proved.
    pub(super) fn limiting(&self, pairs: &[PairResult]) -> Option<usize> {
        let kind = self.scenario.requirement.by;
        let decisive = |i: &usize| {
            let (pair, mixtures) =
                (&pairs[*i], self.classes.get(*i).and_then(|answer| answer.mixtures.as_ref()));
            let not_told = pair.told == Some(YesNo::No);
            let own = match pair.statistical_distance_bounds {
                Some([lower, _]) if !not_told => lower,
                Some([_, upper]) => upper,
                None => pair.distance(kind),
            };
            // Of mixtures what is proved decides.
            (!not_told, mixtures.map_or(own, |found| own.min(found.distance_lower)))
        };
        (0..pairs.len()).min_by(|a, b| {
            let (a, b) = (decisive(a), decisive(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        })
    }

    /// What the pairs say together.
    fn identifiability(&self, pairs: &[PairResult]) -> Identifiability {
        let kind = self.scenario.requirement.by;
        let least = |values: Vec<f64>| values.into_iter().fold(f64::INFINITY, f64::min);
        let statistical: Option<Vec<f64>> = pairs.iter().map(|pair| pair.statistical_distance).collect();
        let minimum = statistical.clone().map(least);
        let bounds: Option<Vec<[f64; 2]>> =
            pairs.iter().map(|pair| pair.statistical_distance_bounds).collect();
        let end = |of: usize| bounds.as_ref().map(|all| least(all.iter().map(|ends| ends[of]).collect()));
        let prediction = statistical.as_ref().map(|distances| {
            let names = std::iter::once(&self.target.name).chain(pairs.iter().map(|pair| &pair.alternative));
            let shares = names.zip(multi::prediction(distances));
            shares.map(|(name, probability)| Prediction { material: name.clone(), probability }).collect()
        });
        Identifiability {
            distance_minimum: least(pairs.iter().map(|pair| pair.distance(kind)).collect()),
            statistical_distance_minimum: minimum,
            statistical_distance_minimum_bounds: end(0).zip(end(1)).map(|(lower, upper)| [lower, upper]),
            detection_probability_minimum: minimum.map(detection::probability),
            identifiability_bits: minimum.map(detection::information_bits),
            identifiable: minimum.map(|_| pairs.iter().all(|pair| pair.told_apart == Some(true))),
            told_from: minimum.map(|_| pairs.iter().filter(|pair| pair.told_apart == Some(true)).count()),
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
        self.camera.as_ref().map(|camera| self.counting_of(camera))
    }

    /// Counting of a camera that sees the scene from where the scenario's does, through the same bands.
    #[must_use]
    pub fn counting_of(&self, camera: &Camera) -> Counting {
        camera.counting(&self.bands, &self.view_of(camera))
    }

    /// Signal of the target in each band, photons s⁻¹ m⁻² sr⁻¹, and the counting of the scenario's camera.
    pub(super) fn seen(&self) -> (Vec<f64>, Option<Counting>) {
        let Some(camera) = &self.camera else { return (self.target_signal(), None) };
        let view = self.view_of(camera);
        let counting = camera.counting(&self.bands, &view);
        (view.signal, Some(counting))
    }

    /// With `mixtures`, target and alternative are the worst mixtures found of two classes.
    fn pair(
        &self,
        alternative: &Surface,
        mixtures: Option<&MixtureAnswer>,
    ) -> Result<(PairResult, Vec<Warning>)> {
        let kind = self.scenario.requirement.by;
        let (signal, counting) = self.seen();
        let photon_radiance: f64 = signal.iter().sum();
        let camera_photons = counting.as_ref().map(|counting| counting.counts_per_radiance * photon_radiance);
        // Priors weigh by the number of photons they compete with: the camera's, else those required.
        let with_priors = self.photons_by_priors(alternative)?;
        let photons = camera_photons.or(with_priors.and_then(|by| by.of(kind))).unwrap_or(f64::INFINITY);
        let per_photon = self.per_photon(alternative, photons)?;
        let by_kind = per_photon.distance(kind);
        let PerPhoton { local, local_unknown_gain: unknown_gain, nearest, back } = per_photon;
        let required = |distance: f64| policy::photons_required(self.required, distance);
        let required_by = with_priors.unwrap_or_else(|| PhotonsRequired {
            nearest: required(nearest.distance),
            local: required(local.distance),
            local_unknown_gain: required(unknown_gain.distance),
        });
        let decision =
            counting.as_ref().map(|counting| self.decided(kind, alternative, counting)).transpose()?;
        // What is proved of all mixtures may not suffice where the worst that was found does.
        let proved = mixtures.is_none_or(|all| all.distance_lower >= self.required);
        let told =
            decision.map(|one| if one.told == YesNo::Yes && !proved { YesNo::Undecided } else { one.told });
        let statistical = decision.map(|decision| decision.found);
        let relative_error_statistical = statistical.and_then(|found| found.relative_error);
        let bounds = statistical.map(Statistical::bounds);
        let statistical = statistical.map(|found| found.distance);
        let limit = match (kind, &counting) {
            (DistanceKind::Nearest, _) | (_, None) => statistical,
            (_, Some(counting)) => {
                Some(self.statistical_distance(DistanceKind::Nearest, alternative, counting)?)
            }
        };
        let shortcut = counting.as_ref().map(|counting| shortcut(counting, &signal, by_kind));
        let enough = match kind {
            DistanceKind::Nearest if with_priors.is_none() => {
                required(self.sure(nearest.distance, nearest.lower))
            }
            DistanceKind::Nearest => self.photons_enough_with_priors(alternative, required_by.of(kind))?,
            _ => required_by.of(kind),
        };
        let condition = local.condition_number();
        let blind = (local.status == Status::Blind).then(|| {
            local.imitation.iter().map(|(parameter, change)| (parameter_name(*parameter), *change)).collect()
        });
        let ratio = if nearest.distance > 0.0 { (back.distance / nearest.distance).min(1.0) } else { 1.0 };
        let environment = self.is_unknown(Nuisance::EnvironmentTemperature);
        let result = PairResult {
            target: self.target.name.clone(),
            alternative: alternative.name.clone(),
            placeholders: self.target.placeholders(alternative).is_some(),
            distance_local: local.distance,
            distance_local_unknown_gain: unknown_gain.distance,
            distance_no_nuisance: local.distance_no_nuisance,
            distance_nearest: nearest.distance,
            distance_nearest_lower: nearest.lower,
            proof: self.proof_of(&nearest),
            relative_error_nearest: nearest.relative_error,
            nearest_state: NearestState::of(&nearest.state, environment),
            nearest_at_edge: nearest.at_edge.iter().map(|parameter| parameter_name(*parameter)).collect(),
            distance_return: back.distance,
            distance_return_lower: back.lower,
            proof_return: self.proof_of(&back),
            relative_error_return: back.relative_error,
            photons_required: enough,
            photons_required_bounds: [required_by.of(kind), enough],
            photons_required_by: required_by,
            statistical_distance: statistical,
            statistical_distance_nearest: limit,
            statistical_distance_bounds: bounds,
            told,
            told_apart: told.map(|told| told == YesNo::Yes),
            decided_by: decision.map(|decision| decision.decided_by),
            relative_error_statistical,
            statistical_distance_shortcut: shortcut,
            detection_probability: statistical.map(detection::probability),
            detection_probability_bounds: bounds.map(|ends| ends.map(detection::probability)),
            miss_probability: statistical.map(detection::miss_probability),
            information_bits: statistical.map(detection::information_bits),
            mutual_information_bits: statistical.map(detection::mutual_information_bits),
            two_sided_probability: statistical.map(|d| detection::two_sided_probability(d, ratio)),
            error_bracket: statistical
                .filter(|_| kind == DistanceKind::Nearest)
                .map(detection::error_bracket),
            condition_number: condition.is_finite().then_some(condition),
            relative_error: local.relative_error,
            relative_error_unknown_gain: unknown_gain.relative_error,
            relative_error_no_nuisance: local.relative_error_no_nuisance,
            status: local.status,
            blind_direction: blind,
        };
        let mut warnings =
            warn::of_pair(&result, &local, &nearest, kind, &self.range, self.proof_leaves_priors_out());
        warnings.extend(self.placeholders(alternative));
        Ok((result, warnings))
    }

    /// Whether there are priors that a proof leaves out.
    pub(crate) fn proof_leaves_priors_out(&self) -> bool {
        leaves_priors_out(&self.unknowns)
    }

    /// Whether a distance is proved as well as is asked for.
    fn proof_of(&self, found: &NearestDistance) -> NearestProof {
        if found.is_proved_to(self.tolerance()) { NearestProof::Proved } else { NearestProof::Searched }
    }

    /// Photons required by each kind of distance, where prior knowledge makes it depend on their number.
    fn photons_by_priors(&self, alternative: &Surface) -> Result<Option<PhotonsRequired>> {
        if !self.unknowns.has_priors() {
            return Ok(None);
        }
        let photons = |kind| self.photons_with_priors(kind, alternative);
        Ok(Some(PhotonsRequired {
            nearest: photons(DistanceKind::Nearest)?,
            local: photons(DistanceKind::Local)?,
            local_unknown_gain: photons(DistanceKind::LocalUnknownGain)?,
        }))
    }

    /// What is to be said of an alternative of which, as of the target, nothing but one number is known.
    pub(super) fn placeholders(&self, alternative: &Surface) -> Option<Warning> {
        self.target.placeholders(alternative).map(|emissivities| Warning::Placeholders {
            target: self.target.name.clone(),
            alternative: alternative.name.clone(),
            emissivities,
        })
    }
}

/// Statistical distance of photons and γ, the noise of a band over its photons.
fn shortcut(counting: &Counting, signal: &[f64], distance_per_photon: f64) -> f64 {
    let gamma = hadar::instrument::gamma_per_band(counting, signal);
    let photon_radiance: f64 = signal.iter().sum();
    (photon_radiance * counting.counts_per_radiance / (1.0 + gamma)).sqrt() * distance_per_photon
}

/// Name of a parameter as it stands in results.
fn parameter_name(parameter: Parameter) -> String {
    match parameter {
        Parameter::Temperature => "temperature_k".into(),
        Parameter::Lighting(k) => format!("lighting[{k}]"),
        Parameter::Gain => "gain".into(),
        Parameter::EnvironmentTemperature(k) => format!("environment_temperature_k[{k}]"),
        Parameter::Material => "material".into(),
    }
}
