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

/// Counts and variance of a band from which they are many: where one band of a hundred counts has all of the difference, 1 − Φ(d) is at most
/// 2.3 % too large up to d = 3 (by summation of the Poisson law, in the tests), and less in more bands.
const MANY: f64 = 100.0;
/// Statistical distance whose error is the least number there is.
const CERTAIN: f64 = 37.5;

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
    /// The statistical distance, of few counts that at which Φ is what is known of the probability.
    pub(crate) found: Statistical,
    /// By which law.
    pub(crate) decided_by: DecisionLaw,
    /// Whether it is enough.
    pub(crate) told: YesNo,
}

impl Study {
    /// The decision between the target and an alternative by the distance of a kind.
    pub(crate) fn decided(
        &self,
        kind: DistanceKind,
        alternative: &Surface,
        counting: &Counting,
    ) -> Result<Decision> {
        let (found, state) = self.statistical_at(kind, alternative, counting)?;
        self.decision(alternative, (&self.bands, counting), found, state.as_ref())
    }

    /// The same of a distance that is known; `nearest` is the state of the alternative that it is of, where the nearest decides.
    pub(crate) fn decision(
        &self,
        alternative: &Surface,
        (bands, counting): (&Bands, &Counting),
        found: Statistical,
        nearest: Option<&State>,
    ) -> Result<Decision> {
        let by = |found: Statistical, decided_by| {
            Ok(Decision { found, decided_by, told: answer(found.bounds(), self.required) })
        };
        let state = match nearest {
            Some(state) if found.distance > 0.0 && !self.counts_are_many(bands, counting) => state,
            _ => return by(found, DecisionLaw::Gaussian),
        };
        let added: Vec<f64> = (0..bands.len()).map(|w| counting.var_added(w)).collect();
        let [own, other] = [(&self.target, &self.state), (alternative, state)]
            .map(|(surface, state)| self.counts_of((surface, state), bands, counting));
        let between = decision_bounds(&own, &other, &added, None)?;
        if between.law == DecisionLaw::Gaussian {
            return by(found, DecisionLaw::Gaussian);
        }
        let known = self.unknowns.nuisances().is_empty();
        let most = match known {
            true => between.error_upper,
            false => detection::error_bracket(found.bounds()[0]).upper.max(between.error_lower),
        };
        let [lower, distance] = [most, between.error_lower].map(distance_of);
        // The law of few counts knows nothing of errors that readings share.
        let [lower, distance] = match self.errors_shared() {
            Some(_) => [lower.min(found.lower), distance.min(found.distance)],
            None => [lower, distance],
        };
        by(Statistical { distance, lower, relative_error: Some(0.0) }, between.law)
    }

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

    /// Whether every band of the target has so many counts, or so much noise, that Φ(d) holds.
    pub(crate) fn counts_are_many(&self, bands: &Bands, counting: &Counting) -> bool {
        let counts = self.counts_of((&self.target, &self.state), bands, counting);
        counts.iter().enumerate().all(|(w, counts)| counts + counting.var_added(w) >= MANY)
    }

    /// The statistical distance that surely suffices, whatever the state of the alternative: that which is required, or of few counts
    /// that by which the bound of Bhattacharyya does.
    pub(crate) fn surely_required(&self, counting: &Counting) -> f64 {
        if self.scenario.requirement.by != DistanceKind::Nearest
            || self.counts_are_many(&self.bands, counting)
        {
            return self.required;
        }
        self.required.max((-2.0 * (2.0 * detection::miss_probability(self.required)).ln()).max(0.0).sqrt())
    }
}

/// The statistical distance at which a test errs so often; that of an error that is 0 as a number is the largest there is.
fn distance_of(error: f64) -> f64 {
    match error {
        error if error >= 0.5 => 0.0,
        error => detection::distance_for_miss(error).unwrap_or(CERTAIN),
    }
}

/// Yes where the lower end reaches what is required, no where not even the upper does.
fn answer([lower, upper]: [f64; 2], required: f64) -> YesNo {
    if lower >= required {
        YesNo::Yes
    } else if upper < required {
        YesNo::No
    } else {
        YesNo::Undecided
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One band that has all of the difference, summed over its counts: what is called many is that, and ten counts are not.
    #[test]
    fn many_counts_are_normal_and_few_are_not() {
        let off = |counts: f64| {
            let worst = (3..=30).flat_map(|i| [0.1, -0.1].map(|step| step * f64::from(i))).map(|d| {
                let means = [counts, (counts.sqrt() + d).powi(2)];
                let mut laws = means.map(|mean: f64| (-mean).exp());
                let mut error = 0.0;
                for n in 1..2000 {
                    error += 0.5 * laws[0].min(laws[1]);
                    laws = [0, 1].map(|i| laws[i] * means[i] / f64::from(n));
                }
                error / detection::miss_probability(d.abs()) - 1.0
            });
            worst.fold(0.0, |worst: f64, off| if off.abs() > worst.abs() { off } else { worst })
        };
        let many = off(MANY);
        assert!(many < 0.0 && many > -0.024, "{many}");
        assert!(off(10.0) < -0.3);
    }

    #[test]
    fn an_answer_is_undecided_between_its_ends() {
        let of = |lower, upper| answer([lower, upper], 1.0);
        assert_eq!((of(1.0, 1.0), of(0.9, 0.99), of(0.9, 1.0)), (YesNo::Yes, YesNo::No, YesNo::Undecided));
        // What is no number is not met.
        assert_eq!(of(f64::NAN, f64::NAN), YesNo::Undecided);
    }

    #[test]
    fn errors_come_back_as_distances() {
        for d in [0.1, 1.0, 5.0, 30.0] {
            assert!((distance_of(detection::miss_probability(d)) / d - 1.0).abs() < 1e-9);
        }
        assert_eq!((distance_of(0.5), distance_of(0.0)), (0.0, CERTAIN));
    }
}
