//! Distances from the target to one alternative, by every reading: per √photon, of a camera, and the photons they ask
//! for where priors compete with the photons.

use super::{Study, Surface};
use crate::error::Result;
use crate::fisher::{Counting, Nuisance, Unknowns};
use crate::identifiability::local::{LocalDistance, LocalSolver};
use crate::identifiability::nearest::{NearestDistance, NearestSolver};
use crate::scenario::DistanceKind;

impl Study {
    /// Local distance per √photon among `photons` photons.
    pub(super) fn local(
        &self,
        unknowns: Unknowns,
        alternative: &Surface,
        photons: f64,
    ) -> Result<LocalDistance> {
        LocalSolver::new(&self.bands, &self.surroundings, unknowns)
            .per_photon(&self.target.emissivity, &alternative.emissivity, &self.state, photons)
            .map_err(|error| error.at(self.scenario.place("bands")))
    }

    /// The same with gain unknown too; with no band to spare for it nothing is left, exactly.
    pub(super) fn local_unknown_gain(&self, alternative: &Surface, photons: f64) -> Result<f64> {
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

    pub(super) fn nearest(&self, alternative: &Surface, photons: f64) -> Result<NearestDistance> {
        NearestSolver::new(&self.bands, &self.surroundings, self.unknowns.clone(), self.range).per_photon(
            &self.target.emissivity,
            &alternative.emissivity,
            &self.state,
            photons,
        )
    }

    /// From the nearest state back to the target's own material, within all that physics allows.
    pub(super) fn return_distance(
        &self,
        alternative: &Surface,
        nearest: &NearestDistance,
    ) -> Result<NearestDistance> {
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
    pub(super) fn photons_with_priors(
        &self,
        kind: DistanceKind,
        alternative: &Surface,
    ) -> Result<Option<f64>> {
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
