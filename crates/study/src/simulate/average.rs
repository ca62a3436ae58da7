//! The Bayes test between two materials whose states are drawn from the priors, held against the bracket of its probability.

use super::photons::seed_of;
use super::{NORMAL, PhotonLaw, SimulationPlan, normal_error};
use crate::{Study, Surface, Warning};
use hadar::demand::{self, Ledger, Work};
use hadar::error::{Error, Result};
use hadar::fisher::Counting;
use hadar::identifiability::bayes::PriorSpace;
use hadar::identifiability::detection;
use hadar::identifiability::nearest::StateRange;
use hadar::instrument::Camera;
use hadar::statistics::Statistics;
use hadar_simulate::average::{AverageDecisions, AverageScene};

/// Deviations of a share beyond which it contradicts the bracket, one in 2 000 times by chance.
const CONTRADICTS: f64 = 3.5;

/// The Bayes test with a given number of photons.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct AveragePoint {
    /// Photons of the target in the scenario's state in all bands.
    pub photons: f64,
    /// A test is right at least this often; not known where `None`: few photons.
    pub probability_lower: Option<f64>,
    /// No test is right more often.
    pub probability_upper: f64,
    /// What the drawn decisions came to.
    #[serde(flatten)]
    pub decisions: AverageDecisions,
    /// Whether the share lies between the two, within 3.5 of its standard deviations.
    pub bracket_holds: bool,
}

/// Decisions between two materials, averaged over the priors of their states: drawn counts, and the bracket they must keep.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct AverageSimulation {
    /// Name of the target's material in the library.
    pub target: String,
    /// Name of the alternative material in the library.
    pub alternative: String,
    /// Law by which the photons are distributed.
    pub photon_law: PhotonLaw,
    /// Whether electronic noise was added.
    pub camera_noise: bool,
    /// The law that the likelihoods take the counts to follow.
    pub judged_as: &'static str,
    /// Seed from which the counts were drawn.
    pub seed: u64,
    /// A point for each number of photons.
    pub averages: Vec<AveragePoint>,
    /// Whether every share lies in its bracket.
    pub brackets_hold: bool,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// What was computed and what was skipped, with the time.
    pub stats: Work,
}

impl Study {
    /// Draws materials, states and counts, decides by the ratio of the mixtures over the priors, and holds the share of right
    /// decisions against the limits. Photons are those of the plan, else the camera's, else those that the average requires.
    ///
    /// # Errors
    /// A category with `safety = true`; no priors, or an unknown without one; a fixed total; more than one alternative; photons that cannot be drawn; no number of
    /// photons that suffices.
    pub fn simulate_average(&self, plan: &SimulationPlan) -> Result<AverageSimulation> {
        let found = "an average over priors proves nothing of the worst state, and excludes no category";
        self.no_safety(found)?;
        if plan.law == PhotonLaw::NegativeBinomial
            && self.camera.as_ref().is_some_and(|camera| camera.photon_bunching)
        {
            // Drawn as it is, bunching is no noise to be added.
            let camera = self.camera.clone().map(|camera| Camera { photon_bunching: false, ..camera });
            return Self { camera, ..self.clone() }.simulate_average(plan);
        }
        if let Some(index) = self.paired_with(&plan.against)
            && let std::borrow::Cow::Owned(own) = self.against(index)
        {
            return own.simulate_average(plan);
        }
        self.has_all_priors(plan)?;
        let ledger = Ledger::open();
        demand::add(&self.looked_up);
        let rivals = self.rivals(&plan.against)?;
        let [rival] = rivals.as_slice() else {
            let found = format!("--average with {} alternatives", rivals.len());
            return Err(Error::malformed(found, "name one with --against"));
        };
        let photons = if plan.photons.is_empty() && self.camera.is_none() {
            vec![self.photons_of_average(rival)?]
        } else {
            self.photon_numbers(plan, &rivals)?
        };
        let mut warnings = self.warnings.clone();
        warnings.extend(self.image_warnings_at(photons.iter().copied().fold(0.0, f64::max)));
        let (mut averages, mut error) = (Vec::new(), 0.0_f64);
        let last = photons.last().copied().unwrap_or(0.0);
        for photons in photons {
            let (point, off) = self.average_point(plan, rival, photons)?;
            averages.push(point);
            error = error.max(off);
        }
        if error > NORMAL {
            warnings.push(Warning::NormalLikelihood { error });
        }
        let counting = self.counting_at(last, plan.camera_noise);
        Ok(AverageSimulation {
            target: self.target.name.clone(),
            alternative: rival.name.clone(),
            photon_law: plan.law,
            camera_noise: counting.var_added.iter().any(|&var| var > 0.0),
            judged_as: self.judged_as(plan.law, &counting)?.name(),
            seed: plan.design.seed,
            brackets_hold: averages.iter().all(|point| point.bracket_holds),
            averages,
            warnings,
            stats: ledger.close(),
        })
    }

    fn has_all_priors(&self, plan: &SimulationPlan) -> Result<()> {
        if plan.law == PhotonLaw::FixedTotal {
            let found = "--average with a fixed total, whose bracket is not known";
            return Err(Error::malformed(found, "leave out --statistics fixed-total"));
        }
        let place = self.scenario.place("unknown");
        if !self.unknowns.has_priors() {
            let found = "--average, and `unknown.priors` states none";
            return Err(
                Error::malformed(found, "state one, such as priors = { temperature = \"2 K\" }").at(place)
            );
        }
        let without: Vec<&str> =
            self.without_prior(&self.unknowns).iter().map(|nuisance| nuisance.name()).collect();
        if without.is_empty() {
            return Ok(());
        }
        let found =
            format!("--average draws states, and `unknown.priors` has none for {}", without.join(", "));
        Err(Error::malformed(found, "state one for each of `unknown.nuisances`, or leave it out of them")
            .at(place))
    }

    /// The photons that suffice, or where they are not known those that are not enough.
    fn photons_of_average(&self, rival: &Surface) -> Result<f64> {
        let probability = detection::probability(self.required).min(1.0 - f64::EPSILON);
        let bound = self.bound_over_priors(&self.unknowns);
        let found = bound.photons_for_average(self.pair_over_priors(rival), probability, &|_, _| ())?;
        found.map(|found| found.upper.unwrap_or(found.lower)).ok_or_else(|| {
            let found = format!(
                "no number of photons distinguishes {} from {} as often as required, averaged over the priors",
                self.target.name, rival.name
            );
            Error::malformed(found, "name photons with --photons, or another alternative with --against")
        })
    }

    /// The point, and how far the distribution function of a band is from the one that likelihoods take it for.
    fn average_point(
        &self,
        plan: &SimulationPlan,
        rival: &Surface,
        photons: f64,
    ) -> Result<(AveragePoint, f64)> {
        let counting = self.counting_at(photons, plan.camera_noise);
        let scale = counting.counts_per_radiance;
        let statistics = self.judged_as(plan.law, &counting)?;
        let signal = self.target_signal();
        let excess = match &statistics {
            Statistics::Poisson => Vec::new(),
            law => signal.iter().enumerate().map(|(w, s)| law.variance(w, s * scale) - s * scale).collect(),
        };
        let noise = Counting { counts_per_radiance: scale, var_added: excess };
        let pair = self.pair_over_priors(rival);
        let bracket = self.bound_over_priors(&self.unknowns).average_probability(pair, &noise)?;
        let priors = [StateRange::default(), self.range]
            .map(|range| PriorSpace::new(&self.unknowns, &self.state, &range));
        let [own, other] = priors;
        let scene = AverageScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            pair,
            priors: &[own?, other?],
            lighting_total_known: self.unknowns.known_lighting_total().is_some(),
            counts_per_radiance: scale,
            statistics: &statistics,
        };
        let draws = |means: &[f64]| self.draws(plan.law, photons, means, &counting);
        let seed = seed_of(plan.design.seed, photons);
        let decisions = scene.decide(seed, plan.design.per_class as u64, &draws)?;
        let share = decisions.probability;
        // Of the least that a share of one decision more or less tells.
        let one = 1.0 / decisions.trials.max(1) as f64;
        let reach = CONTRADICTS * (share.max(one) * (1.0 - share).max(one) * one).sqrt();
        let above = bracket.lower.is_none_or(|lower| share + reach >= lower);
        let means = signal.iter().map(|s| s * scale).collect();
        let off = normal_error(&statistics, &[means])?.unwrap_or(0.0);
        let point = AveragePoint {
            photons,
            probability_lower: bracket.lower,
            probability_upper: bracket.upper,
            bracket_holds: above && share - reach <= bracket.upper,
            decisions,
        };
        Ok((point, off))
    }
}
