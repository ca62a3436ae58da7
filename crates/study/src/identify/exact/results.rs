//! Simulated decisions as data.

use crate::Warning;
use hadar::identifiability::lattice::LatticeDetection;
use hadar_simulate::sequential::{Interval, Plan};

/// The simulated decision of one pair compared with its limits.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ExactPair {
    /// Name of the alternative of this pair.
    pub alternative: String,
    /// Expected photons of the target in all bands.
    pub photons: f64,
    /// Statistical distance to the closest confuser.
    pub statistical_distance_nearest: f64,
    /// Statistical distance d by the local distance.
    pub statistical_distance_local: f64,
    /// Φ of the nearest distance: the limit of the balanced accuracy at large N.
    pub limit: f64,
    /// Φ of the local distance: what the paper's distance promises.
    pub local: f64,
    /// Estimate for a test of best fits, from the return distance.
    pub two_sided: f64,
    /// Rigorous bounds on the error between the two states, by Bhattacharyya, Chernoff and others.
    pub error_lower: f64,
    /// Upper bound of the probability of error; `error_lower` is the lower one.
    pub error_upper: f64,
    /// Simulated share of correct decisions, averaged over the two states.
    pub balanced: f64,
    /// Confidence interval of the balanced share of correct decisions, 0 to 1.
    pub balanced_interval: Interval,
    /// Share of correct decisions with the target true, and with the alternative true.
    pub classes: [f64; 2],
    /// Number of trials of both materials together.
    pub trials: u64,
    /// Fits that did not converge.
    pub unconverged: u64,
    /// Algorithm 1 on a lattice, in up to three bands.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lattice: Option<LatticeDetection>,
}

/// The simulated decision among all materials at once.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ExactLibrary {
    /// Share of trials in which the target is recognised among all alternatives.
    pub probability: f64,
    /// Confidence interval of that share, 0 to 1.
    pub interval: Interval,
    /// Share of decisions for each material, the target first.
    pub decisions: Vec<(String, f64)>,
    /// Union bound of a test that knows all states, the alternatives in their nearest: 1 less the sum of the pairs'
    /// upper bounds on missing the target. No bound of `probability`.
    pub union_bound_known_states: f64,
    /// Number of trials that were drawn.
    pub trials: u64,
}

/// All simulated decisions.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Exact {
    /// Law by which the counts are distributed.
    pub statistics: &'static str,
    /// Where counts are drawn by the Gaussian law: how far its distribution function is from that of photons with
    /// electronic noise, at most.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normal_error: Option<f64>,
    /// Random generator, with its version.
    pub generator: &'static str,
    /// Seed from which the counts were drawn.
    pub seed: u64,
    /// Confidence level of the intervals.
    pub level: f64,
    /// Pair by pair, the hardest first.
    pub pairs: Vec<ExactPair>,
    /// Among all of them; `None` for a single alternative.
    pub library: Option<ExactLibrary>,
}

impl Exact {
    /// What must be said where trials ended before the interval was as narrow as asked for.
    pub(in super::super) fn ended_early(&self, plan: &Plan) -> Option<Warning> {
        let of_library = self.library.iter().map(|library| library.interval);
        let intervals = self.pairs.iter().map(|pair| pair.balanced_interval).chain(of_library);
        let wide: Vec<f64> =
            intervals.map(|i| i.half_width()).filter(|reached| *reached > plan.half_width()).collect();
        let widest = wide.iter().copied().fold(0.0, f64::max);
        (!wide.is_empty()).then(|| Warning::TrialsEnded {
            wide: wide.len(),
            simulations: self.pairs.len() + usize::from(self.library.is_some()),
            most_trials: plan.most_trials(),
            widest,
            asked: plan.half_width(),
        })
    }
}
