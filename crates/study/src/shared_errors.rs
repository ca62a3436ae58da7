//! Errors of the emissivities as noise that all pixels of an object share.
//!
//! What the library says of a material is off by the same in all pixels and frames of an object: the counts of the sum are off by
//! κ Σ_j w_j C_j δ_j, C = B(T) − X the contrast of the surface in its state (∂S/∂e), δ of target and of alternative independent, with
//! the covariance of `[sensitivity]` or of a class. By [`hadar::identifiability::shared`] the separation is at least the nearest
//! distance with the sums of absolute covariances in the noise, and at most that of any state with the covariance itself.
//!
//! Assumption: the contrast of the alternative is the largest of those of the nearest states without errors and with them; what is so
//! found is searched, not proved. Of more bands than [`MOST_BANDS`] with nodes within them, or of classes, the upper end is the distance without errors.

use crate::condition::Condition;
use crate::distances::Statistical;
use crate::size::sensitivity::linear::contrast;
use crate::size::sensitivity::scatter::Scatter;
use crate::{Study, Surface};
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::identifiability::nearest::NearestSolver;
use hadar::identifiability::shared::{ErrorChain, SharedCovariance, separation_along};
use hadar::instrument::Camera;
use hadar::scene::State;
use hadar::spectrum::Bands;
use hadar_scenario::{DistanceKind, Scope, SensitivitySpec};

/// The covariance of more bands takes more than a second.
const MOST_BANDS: usize = 1000;
/// How often the contrast of another nearest state may turn out larger.
const TURNS: usize = 4;

/// The band of every node.
fn band_of(bands: &Bands) -> Vec<usize> {
    let nodes = bands.sum_nodes(&vec![1.0; bands.nodes_cm1().len()]);
    let of_band = |(band, nodes): (usize, &f64)| std::iter::repeat_n(band, *nodes as usize);
    nodes.iter().enumerate().flat_map(of_band).collect()
}

/// Errors of one surface, and what each of its nodes does to the counts of its band.
struct Errors<'s> {
    scatter: &'s Scatter<'s>,
    /// κ w_j C_j, counts.
    counts: Vec<f64>,
}

impl Errors<'_> {
    /// Adds Σ_v |C_wv|, or more, of every band.
    fn add_sums(&self, band_of: &[usize], sums: &mut [f64]) {
        match self.scatter {
            Scatter::Modes(modes) => {
                for mode in *modes {
                    let moved = self.moved(mode, band_of, sums.len());
                    let all: f64 = moved.iter().map(|m| m.abs()).sum();
                    sums.iter_mut().zip(&moved).for_each(|(sum, m)| *sum += m.abs() * all);
                }
            }
            Scatter::Ripple(ripple) => {
                let var = ripple.sigma * ripple.sigma;
                // Σ over all nodes before this one, and over all behind it, with their correlations.
                let mut before = 0.0;
                for (node, correlation) in &ripple.chain {
                    let own = self.counts[*node].abs();
                    before *= correlation;
                    sums[band_of[*node]] += var * own * (before + own);
                    before += own;
                }
                let (mut behind, mut correlation) = (0.0, 0.0);
                for (node, to_before) in ripple.chain.iter().rev() {
                    behind *= correlation;
                    sums[band_of[*node]] += var * self.counts[*node].abs() * behind;
                    behind += self.counts[*node].abs();
                    correlation = *to_before;
                }
            }
        }
    }

    /// Counts by which one mode of the emissivity moves every band.
    fn moved(&self, mode: &[f64], band_of: &[usize], bands: usize) -> Vec<f64> {
        let mut moved = vec![0.0; bands];
        for ((band, counts), m) in band_of.iter().zip(&self.counts).zip(mode) {
            moved[*band] += counts * m;
        }
        moved
    }

    /// Adds the covariance of the bands.
    fn add_covariance(&self, band_of: &[usize], covariance: &mut SharedCovariance, bands: usize) {
        match self.scatter {
            Scatter::Modes(modes) => {
                modes.iter().for_each(|mode| covariance.add_mode(&self.moved(mode, band_of, bands)));
            }
            Scatter::Ripple(ripple) => {
                let var = ripple.sigma * ripple.sigma;
                // Of every band what its nodes before have in common with the next one.
                let mut before = vec![0.0; bands];
                for (node, correlation) in &ripple.chain {
                    let (band, own) = (band_of[*node], self.counts[*node]);
                    before.iter_mut().for_each(|sum| *sum *= correlation);
                    covariance.add(band, band, var * own * own);
                    for (other, sum) in before.iter().enumerate().filter(|(_, sum)| **sum != 0.0) {
                        covariance.add(band, other, var * own * sum);
                        covariance.add(other, band, var * own * sum);
                    }
                    before[band] += own;
                }
            }
        }
    }

    /// As a chain along bands of one node each, which these are in their order.
    fn chain(&self, order: &[usize]) -> Option<ErrorChain> {
        let Scatter::Ripple(ripple) = self.scatter else { return None };
        let counts = order.iter().map(|node| ripple.sigma * self.counts[*node]).collect();
        Some(ErrorChain { counts, correlation: ripple.chain.iter().map(|(_, rho)| *rho).collect() })
    }
}

impl Study {
    /// What errors of the emissivities as they usually are do to what is told of an object, where the scenario states none.
    pub(crate) fn usual_errors(&self, alternative: &Surface) -> Result<Option<Condition>> {
        let kind = self.scenario.requirement.by;
        if kind != DistanceKind::Nearest {
            return Ok(Some(Condition::EmissivityKnown));
        }
        let Some(counting) = self.counting().filter(|_| self.scenario.sensitivity.is_none()) else {
            return Ok(None);
        };
        let (found, Some(state)) = self.statistical_at(kind, alternative, &counting)? else {
            return Ok(Some(Condition::EmissivityKnown));
        };
        let (spec, seen) = (SensitivitySpec::default(), (&self.bands, &counting));
        let mut solver = self.nearest_solver();
        let (with, _) = self.with_shared_errors(
            &mut solver,
            &alternative.emissivity,
            seen,
            (found, state),
            (spec, false),
        )?;
        let (undone, distance) = (with.lower < self.required, with.distance);
        Ok(Some(Condition::SharedErrors { error: spec.emissivity_error, distance, undone }))
    }

    /// The errors that are stated and that count: of an object, by the distance that is a limit.
    pub(crate) fn errors_shared(&self) -> Option<SensitivitySpec> {
        let is_limit = self.scenario.requirement.by == DistanceKind::Nearest;
        self.scenario.sensitivity.filter(|_| is_limit && self.scenario.scope() == Scope::Object)
    }

    /// A distance that was found with the emissivities as they are, by readings that share errors of such a spec; where states are followed
    /// from trial to trial nothing is proved of it.
    pub(crate) fn with_shared_errors(
        &self,
        solver: &mut NearestSolver<'_>,
        alternative: &[f64],
        (bands, counting): (&Bands, &Counting),
        (found, nearest): (Statistical, State),
        (spec, followed): (SensitivitySpec, bool),
    ) -> Result<(Statistical, State)> {
        if found.distance == 0.0 {
            return Ok((found, nearest));
        }
        let index = self.alternatives.iter().position(|other| other.emissivity == alternative);
        let [(of_target, _), (of_other, _)] = self.scatters(index.unwrap_or(usize::MAX), spec);
        let band_of = band_of(bands);
        let counts_of = |state: &State| -> Vec<f64> {
            contrast(self, bands, state).iter().map(|c| counting.counts_per_radiance * c).collect()
        };
        let own = Errors { scatter: &of_target, counts: counts_of(&self.state) };
        let mut other = Errors { scatter: &of_other, counts: counts_of(&nearest) };
        // What priors add to a distance is not in the separation of two states.
        let is_chain = band_of.len() == bands.len()
            && [&of_target, &of_other].iter().all(|scatter| matches!(scatter, Scatter::Ripple(_)));
        let exact = (is_chain || bands.len() <= MOST_BANDS) && !self.unknowns.has_priors();
        let (mut state, mut lower, mut upper) = (nearest, 0.0, found.distance);
        for _ in 0..TURNS {
            let mut noisy = counting.clone();
            noisy.var_added.resize(bands.len(), 0.0);
            own.add_sums(&band_of, &mut noisy.var_added);
            other.add_sums(&band_of, &mut noisy.var_added);
            let own_emissivity = &self.target.emissivity;
            let bounded = match followed {
                true => {
                    solver.refine_with_counting(own_emissivity, alternative, &self.state, &noisy, &state)?
                }
                false => solver.with_counting(own_emissivity, alternative, &self.state, &noisy)?,
            };
            lower = self.sure(bounded.distance, bounded.lower).min(found.distance);
            for at in [&state, &bounded.state].into_iter().filter(|_| exact) {
                let there = Errors { scatter: &of_other, counts: counts_of(at) };
                let both = [&own, &there];
                upper = upper.min(self.separation_at(both, alternative, at, (bands, counting), &band_of)?);
            }
            state = bounded.state;
            let here = counts_of(&state);
            let grown = here.iter().zip(&other.counts).any(|(a, b)| a.abs() > b.abs() * (1.0 + 1e-6));
            if !grown {
                break;
            }
            for (kept, here) in other.counts.iter_mut().zip(here) {
                if here.abs() > kept.abs() {
                    *kept = here;
                }
            }
        }
        let lower = lower.min(upper);
        Ok((Statistical { distance: upper, lower, ..found }, state))
    }

    /// Variance of an average band by the errors, the alternative in its nearest state, counts².
    pub(crate) fn var_of_errors(
        &self,
        camera: &Camera,
        alternative: &Surface,
        spec: SensitivitySpec,
    ) -> Result<f64> {
        let counting = self.counting_of(camera);
        let kind = self.scenario.requirement.by;
        let (_, nearest) = self.statistical_at(kind, alternative, &counting)?;
        let index = self.alternatives.iter().position(|other| other.emissivity == alternative.emissivity);
        let scatters = self.scatters(index.unwrap_or(usize::MAX), spec);
        let band_of = band_of(&self.bands);
        let bands = self.bands.len();
        let mut covariance = SharedCovariance::none(bands.min(MOST_BANDS));
        // Of more bands what the variances are at most.
        let mut sums = vec![0.0; bands];
        for ((scatter, _), state) in scatters.iter().zip([Some(&self.state), nearest.as_ref()]) {
            let Some(state) = state else { continue };
            let counts = contrast(self, &self.bands, state);
            let counts = counts.iter().map(|c| counting.counts_per_radiance * c).collect();
            let errors = Errors { scatter, counts };
            if bands <= MOST_BANDS {
                errors.add_covariance(&band_of, &mut covariance, bands);
            } else {
                errors.add_sums(&band_of, &mut sums);
            }
        }
        Ok((covariance.trace() + sums.iter().sum::<f64>()) / bands as f64)
    }

    /// The separation of the target from one state of the alternative.
    fn separation_at(
        &self,
        errors: [&Errors<'_>; 2],
        alternative: &[f64],
        state: &State,
        (bands, counting): (&Bands, &Counting),
        band_of: &[usize],
    ) -> Result<f64> {
        let pair = [(self.target.emissivity.as_slice(), &self.state), (alternative, state)];
        let [own, other] = pair.map(|(emissivity, state)| {
            let signal = bands.weigh(&self.surroundings.signal(emissivity, state));
            signal.into_iter().map(|s| counting.counts_per_radiance * s).collect::<Vec<f64>>()
        });
        let difference: Vec<f64> = own.iter().zip(&other).map(|(own, other)| own - other).collect();
        let [own, other] = [own, other].map(|counts| {
            let root = |(w, n): (usize, f64)| (n + counting.var_added(w)).sqrt();
            counts.into_iter().enumerate().map(root).collect::<Vec<f64>>()
        });
        // Of many bands of one node each.
        if bands.len() == band_of.len()
            && let Scatter::Ripple(ripple) = errors[0].scatter
        {
            let order: Vec<usize> = ripple.chain.iter().map(|(node, _)| *node).collect();
            let along = |list: &[f64]| order.iter().map(|node| list[band_of[*node]]).collect::<Vec<f64>>();
            if let [Some(one), Some(two)] = errors.map(|errors| errors.chain(&order)) {
                let (difference, own, other) = (along(&difference), along(&own), along(&other));
                return separation_along(&difference, [&own, &other], [&one, &two]);
            }
        }
        let mut covariance = SharedCovariance::none(bands.len());
        errors.iter().for_each(|errors| errors.add_covariance(band_of, &mut covariance, bands.len()));
        covariance.separation(&difference, [&own, &other])
    }
}
