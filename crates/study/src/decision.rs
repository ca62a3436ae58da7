//! One law of decisions for every command: what a test reaches between target and alternative, and whether that is enough.
//!
//! d in [d_low, d_high] as proved and as found. Where counts are many the best test between the two nearest states is right with Φ(d);
//! where they are few the probability of the two states is the exact one or a bracket of it
//! ([`hadar::identifiability::decision`]), and over all states of an alternative whose state is unknown no more than
//!
//! P ≥ 1 − ½exp(−d_low²/2)
//!
//! is known (Bhattacharyya; e.g. T. Kailath, IEEE Trans. Commun. Technol. 15, 52 (1967)). Enough is P ≥ Φ(d_req): *yes* by the lower end,
//! *no* by the upper, and *undecided* between.

use crate::distances::Statistical;
use crate::{Study, Surface};
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::identifiability::decision::{DecisionLaw, decision_bounds};
use hadar::identifiability::detection;
use hadar::scene::State;
use hadar::spectrum::Bands;
use hadar_scenario::DistanceKind;

/// Counts and variance of a band from which they are many: with all of the difference in one band of a hundred Φ(d) is off by no more than
/// 2.3 % of the error up to d = 3, by summation of the Poisson law, on the safe side; and by less in more bands.
const MANY: f64 = 100.0;
/// Statistical distance of a probability that is 1 as a number.
const CERTAIN: f64 = 8.3;

hadar::named! {
    /// A verdict.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum YesNo {
        /// The requirement is met, under the conditions that are listed.
        Yes = "yes",
        /// It is not.
        No = "no",
        /// What is proved does not reach it, what was found does.
        Undecided = "undecided",
    }
    /// The name in JSON.
    name
}

/// What is known of the decision between the target and an alternative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Decision {
    /// Probability of a right answer of the best test: at least, and at most.
    pub(crate) probability: [f64; 2],
    /// By which law.
    pub(crate) decided_by: DecisionLaw,
    /// Whether that is enough.
    pub(crate) told: YesNo,
}

impl Decision {
    /// The statistical distances at which Φ is what is known of the probability.
    pub(crate) fn distances(&self, found: Statistical) -> [f64; 2] {
        if self.decided_by == DecisionLaw::Gaussian {
            return found.solved_by();
        }
        self.probability.map(|probability| {
            // Of certainty there is no distance.
            let certain = if probability > 0.5 { found.distance.max(CERTAIN) } else { 0.0 };
            detection::distance_for_probability(probability).unwrap_or(certain)
        })
    }
}

impl Study {
    /// The statistical distance to an alternative, and whether it is enough.
    pub(crate) fn decided(
        &self,
        kind: DistanceKind,
        alternative: &Surface,
        counting: &Counting,
    ) -> Result<(Statistical, Decision)> {
        let (found, state) = self.statistical_at(kind, alternative, counting)?;
        let state = state.as_ref().unwrap_or(&self.state);
        let decision = self.decision(kind, alternative, (&self.bands, counting), found, state)?;
        Ok((found, decision))
    }

    /// Whether a statistical distance is enough; `state` is the nearest of the alternative that was found.
    pub(crate) fn decision(
        &self,
        kind: DistanceKind,
        alternative: &Surface,
        (bands, counting): (&Bands, &Counting),
        found: Statistical,
        state: &State,
    ) -> Result<Decision> {
        let distances = found.bounds();
        let by_distance = Decision {
            probability: distances.map(detection::probability),
            decided_by: DecisionLaw::Gaussian,
            told: answer(distances, self.required),
        };
        if kind != DistanceKind::Nearest || found.distance == 0.0 || self.counts_are_many(bands, counting) {
            return Ok(by_distance);
        }
        let added: Vec<f64> = (0..bands.len()).map(|w| counting.var_added(w)).collect();
        let [own, other] = [(&self.target, &self.state), (alternative, state)]
            .map(|(surface, state)| self.counts_of((surface, state), bands, counting));
        let between = decision_bounds(&own, &other, &added, None)?;
        if between.law == DecisionLaw::Gaussian {
            return Ok(by_distance);
        }
        let known = self.unknowns.nuisances().is_empty();
        let lower = if known { between.lower } else { 1.0 - detection::error_bracket(distances[0]).upper };
        let probability = [lower.min(between.upper), between.upper];
        Ok(Decision {
            probability,
            decided_by: between.law,
            told: answer(probability, detection::probability(self.required)),
        })
    }
}

impl Study {
    /// Counts of a surface in every band.
    fn counts_of(
        &self,
        (surface, state): (&Surface, &State),
        bands: &Bands,
        counting: &Counting,
    ) -> Vec<f64> {
        let signal = bands.weigh(&self.surroundings.signal(&surface.emissivity, state));
        signal.into_iter().map(|signal| counting.counts_per_radiance * signal).collect()
    }

    /// Whether every band of the target has so many counts, or so much noise, that Φ(d) holds to more digits than are printed.
    pub(crate) fn counts_are_many(&self, bands: &Bands, counting: &Counting) -> bool {
        let counts = self.counts_of((&self.target, &self.state), bands, counting);
        counts.iter().enumerate().all(|(w, counts)| counts + counting.var_added(w) >= MANY)
    }

    /// The statistical distance that surely suffices, whatever the state of the alternative: that which is required, or of few counts
    /// that by which the bound of Bhattacharyya does.
    pub(crate) fn surely_required(&self, counting: &Counting) -> f64 {
        if self.scenario().requirement.by != DistanceKind::Nearest
            || self.counts_are_many(&self.bands, counting)
        {
            return self.required;
        }
        self.required.max((-2.0 * (2.0 * detection::miss_probability(self.required)).ln()).max(0.0).sqrt())
    }
}

/// Yes where the lower end reaches what is required, no where not even the upper does.
pub(crate) fn answer([lower, upper]: [f64; 2], required: f64) -> YesNo {
    if lower >= required {
        YesNo::Yes
    } else if upper < required {
        YesNo::No
    } else {
        YesNo::Undecided
    }
}
