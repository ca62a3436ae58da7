//! What scenarios share that differ in something else, computed once: distances per √photon of a pair, whatever the exposure, the noise
//! or, without air, the distance, and integrals over the bands. Each is found again by all that it depends on, bit by bit. Priors compete
//! with the photons of the camera, so that no distances are remembered with them.

use super::integration::{Integrals, Integrand};
use hadar::error::Result;
use hadar::fisher::Unknowns;
use hadar::identifiability::local::LocalDistance;
use hadar::identifiability::nearest::{NearestDistance, Searched, StateRange};
use hadar::scene::{State, Surroundings};
use hadar::spectrum::Bands;
use hadar_scenario::DistanceKind;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

/// Pairs that are kept at most; looking through more would take longer than computing one.
const MOST: usize = 1000;
/// Sets of integrals that are kept: comparing the spectra of more would take longer.
const MOST_INTEGRALS: usize = 16;
/// Sets of bands of which it is kept what searches have computed: one for each row that is computed at a time will do.
const MOST_SEARCHED: usize = 8;

/// What scenarios share.
#[derive(Debug, Clone, Default)]
pub struct Remembered(Arc<Shared>);

#[derive(Debug, Default)]
struct Shared {
    /// Distances of pairs.
    pairs: Mutex<Vec<Arc<Known>>>,
    /// Integrals over the bands, the last ones.
    integrals: Mutex<VecDeque<Arc<(Integrand, Integrals)>>>,
    /// What searches have computed of their bands, the last ones.
    searched: Mutex<Vec<(Bands, Searched)>>,
}

/// A pair and what is known of it; whoever needs it first computes it, and others wait.
#[derive(Debug)]
struct Known {
    scene: Scene,
    found: Mutex<Option<PerPhoton>>,
}

/// All that the distances depend on.
#[derive(Debug, PartialEq)]
pub(super) struct Scene {
    pub(super) state: State,
    pub(super) tolerance: f64,
    pub(super) range: StateRange,
    pub(super) unknowns: Unknowns,
    pub(super) target: Vec<f64>,
    pub(super) alternative: Vec<f64>,
    pub(super) surroundings: Surroundings,
    pub(super) bands: Bands,
}

/// Distances of a pair per √photon.
#[derive(Debug, Clone)]
pub(super) struct PerPhoton {
    pub(super) local: LocalDistance,
    pub(super) local_unknown_gain: LocalDistance,
    pub(super) nearest: NearestDistance,
    /// From the nearest state back to the target.
    pub(super) back: NearestDistance,
}

impl PerPhoton {
    /// The distance of a kind.
    pub(super) const fn distance(&self, kind: DistanceKind) -> f64 {
        match kind {
            DistanceKind::Nearest => self.nearest.distance,
            DistanceKind::Local => self.local.distance,
            DistanceKind::LocalUnknownGain => self.local_unknown_gain.distance,
        }
    }
}

impl Remembered {
    /// Distances of a scene: remembered, or computed.
    pub(super) fn or_compute(
        &self,
        scene: Scene,
        compute: impl FnOnce() -> Result<PerPhoton>,
    ) -> Result<PerPhoton> {
        let Some(known) = self.of(scene) else { return compute() };
        // Who was stopped while he computed has left nothing.
        let mut found = known.found.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = found.as_ref() {
            return Ok(found.clone());
        }
        let new = compute()?;
        *found = Some(new.clone());
        Ok(new)
    }

    /// The integrals of an integrand: remembered, or computed.
    pub(super) fn integrals(
        &self,
        integrand: Integrand,
        compute: impl FnOnce() -> Result<Integrals>,
    ) -> Result<Integrals> {
        let kept = || self.0.integrals.lock().unwrap_or_else(PoisonError::into_inner);
        let last: Vec<_> = kept().iter().cloned().collect();
        if let Some(found) = last.iter().find(|known| known.0 == integrand) {
            return Ok(found.1.clone());
        }
        // Rows that are computed at a time may each compute it.
        let found = compute()?;
        let mut kept = kept();
        kept.truncate(MOST_INTEGRALS - 1);
        kept.push_front(Arc::new((integrand, found.clone())));
        Ok(found)
    }

    /// Searches in some bands, with what others before have computed of these and, behind it, for the next ones.
    pub(super) fn searching<T>(&self, bands: &Bands, search: impl FnOnce(Searched) -> (T, Searched)) -> T {
        let kept = || self.0.searched.lock().unwrap_or_else(PoisonError::into_inner);
        let mut before = kept();
        let place = before.iter().position(|(known, _)| known == bands);
        let (own, known) =
            place.map(|place| before.remove(place)).unwrap_or_else(|| (bands.clone(), Searched::default()));
        drop(before);
        let (found, known) = search(known);
        let mut kept = kept();
        if kept.len() >= MOST_SEARCHED {
            kept.remove(0);
        }
        kept.push((own, known));
        found
    }

    /// What is known of a scene, or a place for it; none where there are too many.
    fn of(&self, scene: Scene) -> Option<Arc<Known>> {
        let mut known = self.0.pairs.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known.iter().rev().find(|known| known.scene == scene) {
            return Some(Arc::clone(found));
        }
        if known.len() >= MOST {
            return None;
        }
        let new = Arc::new(Known { scene, found: Mutex::new(None) });
        known.push(Arc::clone(&new));
        Some(new)
    }
}
