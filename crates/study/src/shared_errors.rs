//! Errors of the emissivities as noise that all pixels of an object share.
//!
//! What the library says of a material is off by the same in all pixels and frames of an object: the counts of the sum are off by
//! κ Σ_j w_j C_j δ_j, C = B(T) − X the contrast of the surface in its state (∂S/∂e), δ of target and of alternative independent, with
//! the covariance of `[sensitivity]` or of a class. By [`hadar::identifiability::shared`] the separation is at least the nearest
//! distance with the sums of absolute covariances in the noise, and at most that of any state with the covariance itself.
//!
//! The contrast of the alternative depends on its state. In states of which no band counts more than 1 + η of the target's it is bounded, and
//! so is what the nearest distance says; of any other state one band alone differs by η of its counts. The lower end is the least of
//! the two, for the best of some η; where gain or temperatures of the surroundings are unknown there is none. The upper end is the least of
//! states that are found, also with the lighting held: what it misses makes an answer undecided, not a 'yes'.
//!
//! Of more bands than [`MOST_BANDS`] with nodes within them, or of classes, the upper end is the distance without errors.

mod errors;

use self::errors::{Errors, band_of};
use crate::condition::Condition;
use crate::distances::Statistical;
use crate::size::sensitivity::linear::contrast;
use crate::size::sensitivity::scatter::Scatter;
use crate::{Study, Surface};
use hadar::error::Result;
use hadar::fisher::{Counting, Nuisance};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::identifiability::shared::{SharedCovariance, separation_along};
use hadar::instrument::Camera;
use hadar::planck;
use hadar::scene::State;
use hadar::spectrum::Bands;
use hadar_scenario::{DistanceKind, SensitivitySpec};

/// The covariance of more bands takes more than a second.
const MOST_BANDS: usize = 1000;
/// Shares of the target's counts within which the contrast of an alternative is bounded; the best of them counts.
const SHARES: [f64; 2] = [0.1, 0.4];
/// Halvings of a range of temperatures.
const HALVINGS: usize = 60;
/// Lightings at which states are looked for.
const LIGHTINGS: usize = 5;

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
        let (with, _) =
            self.with_shared_errors(&mut solver, &alternative.emissivity, seen, (found, state), spec)?;
        let (undone, distance) = (with.lower < self.required, with.distance);
        Ok(Some(Condition::SharedErrors { error: spec.emissivity_error, distance, undone }))
    }

    /// The errors that are stated and that count: of an object, by the distance that is a limit.
    pub(crate) fn errors_shared(&self) -> Option<SensitivitySpec> {
        let is_limit = self.scenario.requirement.by == DistanceKind::Nearest;
        self.scenario.sensitivity.filter(|_| is_limit && self.scenario.is_of_object())
    }

    /// A distance that was found with the emissivities as they are, by readings that share errors of such a spec.
    pub(crate) fn with_shared_errors(
        &self,
        solver: &mut NearestSolver<'_>,
        alternative: &[f64],
        (bands, counting): (&Bands, &Counting),
        (found, nearest): (Statistical, State),
        spec: SensitivitySpec,
    ) -> Result<(Statistical, State)> {
        if found.distance == 0.0 {
            return Ok((found, nearest));
        }
        let [of_target, of_other] = self.scatters_beside(alternative, spec);
        let band_of = band_of(bands);
        let kappa = counting.counts_per_radiance;
        let counts_of =
            |state: &State| -> Vec<f64> { contrast(self, bands, state).iter().map(|c| kappa * c).collect() };
        let own = Errors { scatter: &of_target, counts: counts_of(&self.state) };
        let noisy = |other: &Errors<'_>| {
            let mut noisy = counting.clone();
            noisy.var_added.resize(bands.len(), 0.0);
            own.add_sums(&band_of, &mut noisy.var_added);
            other.add_sums(&band_of, &mut noisy.var_added);
            noisy
        };
        // From below: within a share of the target's counts the contrast of the alternative is bounded, beyond it the difference itself.
        let mut lower: f64 = 0.0;
        let mut states = vec![nearest.clone()];
        for share in SHARES {
            let Some(most) = self.most_contrast(alternative, (bands, counting), share) else { break };
            let other = Errors { scatter: &of_other, counts: most };
            let within =
                solver.with_counting(&self.target.emissivity, alternative, &self.state, &noisy(&other))?;
            let beyond = self.beyond([&own, &other], alternative, (bands, counting), &band_of, share);
            lower = lower.max(self.sure(within.distance, within.lower).min(beyond));
            states.push(within.state);
        }
        // From above: any state, with the covariance itself. What priors add to a distance is not in the separation of two states.
        let is_chain = band_of.len() == bands.len()
            && [&of_target, &of_other].iter().all(|scatter| matches!(scatter, Scatter::Ripple(_)));
        let mut upper = found.distance;
        let mut state = nearest;
        if (is_chain || bands.len() <= MOST_BANDS) && !self.unknowns.has_priors() {
            if self.is_unknown(Nuisance::Lighting) {
                let there = Errors { scatter: &of_other, counts: counts_of(&state) };
                states.extend(self.at_lightings(alternative, bands, &noisy(&there)));
            }
            for at in states {
                let there = Errors { scatter: &of_other, counts: counts_of(&at) };
                let d = self.separation_at([&own, &there], alternative, &at, (bands, counting), &band_of)?;
                if d < upper {
                    (upper, state) = (d, at);
                }
            }
        }
        let lower = lower.min(upper).min(found.lower);
        Ok((Statistical { distance: upper, lower, ..found }, state))
    }

    /// How the emissivities of the target and of an alternative scatter: as the class says of which it is one.
    fn scatters_beside(&self, alternative: &[f64], spec: SensitivitySpec) -> [Scatter<'_>; 2] {
        let is_of = |surface: &Surface| surface.emissivity == alternative;
        let of_class = self.members[1].iter().position(|members| members.surfaces.iter().any(is_of));
        let index = of_class.or_else(|| self.alternatives.iter().position(is_of));
        self.scatters(index.unwrap_or(usize::MAX), spec).map(|(scatter, _)| scatter)
    }

    /// Nearest states of the alternative with its lighting held.
    fn at_lightings(&self, alternative: &[f64], bands: &Bands, noisy: &Counting) -> Vec<State> {
        let objects = self.surroundings.objects().len().max(1) as f64;
        let [low, high] = self.range.lighting;
        let high = high.min(1.0 / objects).max(low);
        let at = |i: usize| {
            let v = low + (high - low) * i as f64 / (LIGHTINGS - 1) as f64;
            let range = StateRange { lighting: [v, v], ..self.range };
            let mut solver = NearestSolver::new(bands, &self.surroundings, self.unknowns.clone(), range);
            solver.with_counting(&self.target.emissivity, alternative, &self.state, noisy).ok()
        };
        (0..LIGHTINGS).filter_map(at).map(|found| found.state).collect()
    }

    /// The most counts by which an error of 1 at a node of the alternative moves its band, in any state of which no band counts more than
    /// 1 + `share` of the target's: |B(T) − X| ≤ max(B(T₊), X₊), T₊ the hottest at which its own emission alone counts so much, X₊ the brightest
    /// that its surroundings can be. `None` where gain or their temperatures are unknown, of which nothing is bounded here.
    fn most_contrast(
        &self,
        alternative: &[f64],
        (bands, counting): (&Bands, &Counting),
        share: f64,
    ) -> Option<Vec<f64>> {
        if self.is_unknown(Nuisance::Gain) || self.is_unknown(Nuisance::EnvironmentTemperature) {
            return None;
        }
        let nodes = bands.nodes_cm1();
        let target = bands.weigh(&self.surroundings.signal(&self.target.emissivity, &self.state));
        let mut radiance = vec![0.0; nodes.len()];
        let mut exceeds = |temperature_k: f64| {
            planck::photon_radiance_into(nodes, temperature_k, &mut radiance);
            radiance.iter_mut().zip(alternative).for_each(|(b, e)| *b *= e);
            bands.weigh(&radiance).iter().zip(&target).any(|(own, most)| *own > (1.0 + share) * most)
        };
        let mut ends = self.range.temperature_k;
        if !self.is_unknown(Nuisance::Temperature) {
            ends = [self.state.temperature_k; 2];
        } else if exceeds(ends[1]) {
            // From above, so that what is found is no colder.
            for _ in 0..HALVINGS {
                let middle = (ends[0] * ends[1]).sqrt();
                ends[usize::from(exceeds(middle))] = middle;
            }
        }
        planck::photon_radiance_into(nodes, ends[1], &mut radiance);
        for object in 0..self.surroundings.objects().len() {
            let light = self.surroundings.object_signal(object, &self.state);
            radiance.iter_mut().zip(light).for_each(|(most, light)| *most = most.max(light));
        }
        let kappa = counting.counts_per_radiance;
        Some(radiance.iter().zip(bands.weights_cm1()).map(|(most, weight)| kappa * most * weight).collect())
    }

    /// What any state reaches at least of which some band counts more than 1 + `share` of the target's: by that band alone, at that count,
    /// beyond which the difference grows faster than all of its noise.
    fn beyond(
        &self,
        [own, other]: [&Errors<'_>; 2],
        alternative: &[f64],
        (bands, counting): (&Bands, &Counting),
        band_of: &[usize],
        share: f64,
    ) -> f64 {
        let kappa = counting.counts_per_radiance;
        let target = bands.weigh(&self.surroundings.signal(&self.target.emissivity, &self.state));
        let (mut of_own, mut of_light, mut per_count) =
            (vec![0.0; bands.len()], vec![0.0; bands.len()], vec![0.0_f64; bands.len()]);
        let lights: Vec<Vec<f64>> = (0..self.surroundings.objects().len())
            .map(|object| self.surroundings.object_signal(object, &self.state))
            .collect();
        for (node, band) in band_of.iter().enumerate() {
            of_own[*band] += own.scatter.sigma(node) * own.counts[node].abs();
            let sigma = other.scatter.sigma(node);
            let brightest = lights.iter().map(|light| light[node]).fold(0.0, f64::max);
            of_light[*band] += sigma * kappa * bands.weights_cm1()[node] * brightest;
            per_count[*band] = per_count[*band].max(sigma / alternative[node]);
        }
        let of_band = |w: usize| {
            let [own, there] = [kappa * target[w], kappa * target[w] * (1.0 + share)];
            let root = 0.5 * [own, there].map(|n| (n + counting.var_added(w)).sqrt()).iter().sum::<f64>();
            let errors = of_own[w] + (per_count[w] * there).max(of_light[w]);
            0.5 * (there - own) / root.hypot(errors)
        };
        (0..bands.len()).map(of_band).fold(f64::INFINITY, f64::min)
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
        let scatters = self.scatters_beside(&alternative.emissivity, spec);
        let band_of = band_of(&self.bands);
        let bands = self.bands.len();
        let mut covariance = SharedCovariance::none(bands.min(MOST_BANDS));
        // Of more bands what the variances are at most.
        let mut sums = vec![0.0; bands];
        for (scatter, state) in scatters.iter().zip([Some(&self.state), nearest.as_ref()]) {
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
