//! Distances from the target to one alternative, by every reading: per √photon, of a camera, and the photons they ask
//! for where priors compete with the photons.

use super::{Study, Surface};
use hadar::demand::{self, Reason, Thing};
use hadar::error::Result;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::local::{LocalDistance, LocalSolver};
use hadar::identifiability::nearest::{NearestDistance, NearestSolver, StateRange};
use hadar::scene::State;
use hadar::spectrum::Bands;
use hadar_scenario::DistanceKind;

/// To what share of itself a nearest distance is proved where nobody asks: with one temperature to search at most, and more.
const TOLERANCE: f64 = 1e-6;
const TOLERANCE_OF_MANY: f64 = 1e-3;

/// A statistical distance: what a state that was found shows, what is proved of it, and what rounding may have done to both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Statistical {
    /// Of the nearest state that was found: no camera does more.
    pub(super) distance: f64,
    /// What a verdict may rest on ([`Study::sure`]).
    pub(super) lower: f64,
    /// Where the solver tells it.
    pub(super) relative_error: Option<f64>,
}

impl Statistical {
    /// What it is at least, and at most, whatever rounding did to it.
    pub(super) fn bounds(self) -> [f64; 2] {
        let error = self.relative_error.unwrap_or(0.0);
        [(self.lower * (1.0 - error)).max(0.0), self.distance * (1.0 + error)]
    }

    /// The same with both ends lowered by three times the error: what is solved for then does in spite of it, also where the error of the
    /// integrals is larger at the solution.
    pub(super) fn solved_by(self) -> [f64; 2] {
        let kept = (1.0 - 3.0 * self.relative_error.unwrap_or(0.0)).max(0.0);
        [self.lower * kept, self.distance * kept]
    }
}

impl Study {
    /// Books local distances, of whose columns of derivatives only those of the unknowns and the material are formed.
    pub(super) fn book_local(&self, unknowns: &Unknowns, count: usize) {
        let objects = self.surroundings.objects().len();
        // The material, temperature and gain; lighting and temperature of every object.
        let (asked, all) = (unknowns.parameters(objects).len() + 1, 3 + 2 * objects);
        demand::computed(Thing::LocalDistances, count as u64);
        demand::computed(Thing::DerivativeColumns, (count * asked) as u64);
        let left_out = count * all.saturating_sub(asked);
        demand::spared(Thing::DerivativeColumns, Reason::NotAsked, left_out as u64);
    }

    /// Books distances of a kind.
    pub(super) fn book_distances(&self, kind: DistanceKind, count: usize) {
        match kind {
            DistanceKind::Nearest => demand::computed(Thing::NearestSearches, count as u64),
            DistanceKind::Local => self.book_local(&self.unknowns, count),
            DistanceKind::LocalUnknownGain => {
                self.book_local(&self.unknowns.with(Nuisance::Gain), count);
            }
        }
    }

    /// Local distance per √photon among `photons` photons.
    pub(super) fn local(
        &self,
        unknowns: Unknowns,
        alternative: &Surface,
        photons: f64,
    ) -> Result<LocalDistance> {
        self.book_local(&unknowns, 1);
        let mut found = LocalSolver::new(&self.bands, &self.surroundings, unknowns)
            .per_photon(&self.target.emissivity, &alternative.emissivity, &self.state, photons)
            .map_err(|error| error.at(self.scenario.place("bands")))?;
        found.relative_error += self.integration.share_of(found.distance);
        found.relative_error_no_nuisance += self.integration.share_of(found.distance_no_nuisance);
        Ok(found)
    }

    /// The same with gain unknown too.
    pub(super) fn local_unknown_gain(&self, alternative: &Surface, photons: f64) -> Result<LocalDistance> {
        self.local(self.unknowns.with(Nuisance::Gain), alternative, photons)
    }

    /// Whether there are more bands than unknowns without a prior.
    pub(super) fn enough_bands(&self, unknowns: &Unknowns) -> bool {
        let parameters = unknowns.parameters(self.surroundings.objects().len());
        let free = parameters.iter().filter(|parameter| unknowns.sigma_prior(**parameter).is_none()).count();
        self.bands.len() > free
    }

    /// To what share of a distance the nearest state is proved: as asked for, else what is cheap enough for the unknowns.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        let surroundings = if self.is_unknown(Nuisance::EnvironmentTemperature) {
            self.surroundings.objects().len()
        } else {
            0
        };
        let searched = usize::from(self.is_unknown(Nuisance::Temperature)) + surroundings;
        self.tolerance.unwrap_or(if searched <= 1 { TOLERANCE } else { TOLERANCE_OF_MANY })
    }

    /// A solver of nearest states that proves them.
    pub(crate) fn nearest_solver(&self) -> NearestSolver<'_> {
        NearestSolver::new(&self.bands, &self.surroundings, self.unknowns.clone(), self.range)
            .proving(self.tolerance())
    }

    pub(super) fn nearest(&self, alternative: &Surface, photons: f64) -> Result<NearestDistance> {
        demand::computed(Thing::NearestSearches, 1);
        let (target, other) = (&self.target.emissivity, &alternative.emissivity);
        let found = self.nearest_solver().per_photon(target, other, &self.state, photons)?;
        Ok(self.with_integrals(found))
    }

    /// With the error that integrals over bands add to that of rounding.
    fn with_integrals(&self, found: NearestDistance) -> NearestDistance {
        let share = self.integration.share_of(found.distance);
        let lower = found.lower.min(found.distance * (1.0 - share).max(0.0));
        NearestDistance { lower, relative_error: found.relative_error + share, ..found }
    }

    /// From the nearest state back to the target's own material, within all that physics allows, per √photon of the target: the
    /// nearest state may send none. Priors have no part in it.
    pub(super) fn return_distance(
        &self,
        alternative: &Surface,
        nearest: &NearestDistance,
    ) -> Result<NearestDistance> {
        demand::computed(Thing::NearestSearches, 1);
        let unknowns = self.unknowns.without_priors();
        NearestSolver::new(&self.bands, &self.surroundings, unknowns, StateRange::default())
            .proving(self.tolerance())
            .with_counting(
                &alternative.emissivity,
                &self.target.emissivity,
                &nearest.state,
                &Counting::shot(1.0, &self.target_signal()),
            )
            .map(|found| self.with_integrals(found))
    }

    /// What the error of the integrals is of a statistical distance in some bands.
    pub(super) fn integral_error(&self, distance: f64, bands: &Bands, counting: &Counting) -> f64 {
        if self.integration.relative_error == 0.0 {
            return 0.0;
        }
        let signal = bands.weigh(&self.surroundings.signal(&self.target.emissivity, &self.state));
        // η of N moves √(N + σ²) by ηN/(2√(N + σ²)), and that of the alternative by as much.
        let moved = |(w, signal): (usize, &f64)| {
            let counts = counting.counts_per_radiance * signal;
            if counts > 0.0 { counts * (counts / (counts + counting.var_added(w))) } else { 0.0 }
        };
        let moved: f64 = signal.iter().enumerate().map(moved).sum();
        self.integration.share_of(distance / moved.sqrt())
    }

    /// Statistical distance d of a kind at given counts and noise, as a state that was found shows it.
    pub(super) fn statistical_distance(
        &self,
        kind: DistanceKind,
        alternative: &Surface,
        counting: &Counting,
    ) -> Result<f64> {
        self.statistical(kind, alternative, counting).map(|found| found.distance)
    }

    /// The same with what is proved of it and its rounding error.
    pub(super) fn statistical(
        &self,
        kind: DistanceKind,
        alternative: &Surface,
        counting: &Counting,
    ) -> Result<Statistical> {
        self.statistical_at(kind, alternative, counting).map(|(found, _)| found)
    }

    /// The same with the nearest state, where that is what decides.
    pub(super) fn statistical_at(
        &self,
        kind: DistanceKind,
        alternative: &Surface,
        counting: &Counting,
    ) -> Result<(Statistical, Option<State>)> {
        self.book_distances(kind, 1);
        let (target, other) = (&self.target.emissivity, &alternative.emissivity);
        let integrals = |distance: f64| self.integral_error(distance, &self.bands, counting);
        let local = |unknowns: Unknowns| {
            let mut solver = LocalSolver::new(&self.bands, &self.surroundings, unknowns);
            let found = solver.with_counting(target, other, &self.state, counting)?;
            let distance = found.distance;
            let relative_error = Some(found.relative_error + integrals(distance));
            Ok((Statistical { distance, lower: distance, relative_error }, None))
        };
        match kind {
            DistanceKind::Nearest => {
                let search = |solver: &mut NearestSolver<'_>| {
                    let found = solver.with_counting(target, other, &self.state, counting)?;
                    let lower = self.sure(found.distance, found.lower);
                    let relative_error = Some(found.relative_error + integrals(found.distance));
                    let NearestDistance { distance, state, .. } = found;
                    let found = (Statistical { distance, lower, relative_error }, state);
                    let (found, state) = match self.errors_shared() {
                        Some(spec) => {
                            let seen = (&self.bands, counting);
                            self.with_shared_errors(solver, other, seen, found, spec)?
                        }
                        None => found,
                    };
                    Ok((found, Some(state)))
                };
                match &self.remembered {
                    Some(remembered) => remembered.searching(&self.bands, |known| {
                        let mut solver = self.nearest_solver().knowing(known);
                        (search(&mut solver), solver.searched())
                    }),
                    None => search(&mut self.nearest_solver()),
                }
            }
            DistanceKind::Local => local(self.unknowns.clone()),
            DistanceKind::LocalUnknownGain => local(self.unknowns.with(Nuisance::Gain)),
        }
    }

    /// What a verdict may rest on: the distance where it is proved, else what is proved of it.
    pub(super) fn sure(&self, distance: f64, lower: f64) -> f64 {
        let proved = lower >= (1.0 - self.tolerance()) * distance;
        if proved { distance } else { lower }
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
            DistanceKind::LocalUnknownGain => {
                self.local_unknown_gain(alternative, photons).map(|local| local.distance)
            }
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
    pub(super) fn photons_with_priors(
        &self,
        kind: DistanceKind,
        alternative: &Surface,
    ) -> Result<Option<f64>> {
        self.photons_by(|photons| self.distance_per_photon(kind, alternative, photons))
    }

    /// Photons at which what is proved of √N d₀(N) meets the requirement, at least as many as at which the distance does.
    pub(super) fn photons_enough_with_priors(
        &self,
        alternative: &Surface,
        photons: Option<f64>,
    ) -> Result<Option<f64>> {
        let Some(photons) = photons.filter(|photons| *photons > 0.0) else { return Ok(photons) };
        let sure = |photons: f64| {
            let found = self.nearest(alternative, photons)?;
            Ok((found.distance, self.sure(found.distance, found.lower)))
        };
        let (distance, proved) = sure(photons)?;
        if proved >= distance {
            return Ok(Some(photons));
        }
        let enough = self.photons_by(|photons| sure(photons).map(|(_, proved)| proved))?;
        Ok(enough.map(|enough| enough.max(photons)))
    }

    /// The same of any distance per √photon that depends on the photons.
    fn photons_by(&self, distance: impl Fn(f64) -> Result<f64>) -> Result<Option<f64>> {
        let excess = |log: f64| {
            let photons = log.exp();
            Ok((photons.sqrt() * distance(photons)? / self.required).max(1e-300).ln())
        };
        // From a millionth of a photon to 10⁶⁰ of them.
        let (low, high) = (-14.0, 138.0);
        let most = excess(high)?;
        if most < 0.0 {
            return Ok(None);
        }
        let least = excess(low)?;
        if least >= 0.0 {
            return Ok(Some(0.0));
        }
        hadar::root::crossing_between([low, least], [high, most], excess).map(|log| Some(log.exp()))
    }
}
