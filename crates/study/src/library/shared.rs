//! What unknowns that the whole cube shares do to emissivities that are found in it.
//!
//! The library is made once more with each unknown by its deviation otherwise than told. A cluster of the second library is that of the first
//! with which it has most pixels in common; the difference Δe of their emissivities is one deviation, whose square is added to the variance in
//! each band, and to those of its magnitude and mean; where there is none, nothing is known of the emissivity. The cube does not tell these unknowns here: an emissivity is as free as they are.
//!
//! Assumptions: to first order; unknowns are independent.

use super::LibraryStudy;
use super::results::SharedOfLibrary;
use crate::shared_unknown::{Of, Stated, spectra};
use hadar::error::Result;
use hadar::material::Library;
use hadar_estimate::decompose::{Maps, NO_MATERIAL, Setting, Told};
use hadar_estimate::separation::{Cluster, Found};
use hadar_scenario::decompose::SharedUnknown;
use std::sync::Arc;

/// Deviation of an even distribution from 0 to 1: what is known of an emissivity beforehand.
const BLIND: f64 = 0.288_675;

impl LibraryStudy {
    /// Each unknown put into the deviations of the clusters, and what it did.
    pub(super) fn with_shared(
        &self,
        library: &Library,
        found: &mut Found,
        again: &dyn Fn(&Setting<'_>) -> Result<Found>,
    ) -> Result<Vec<SharedOfLibrary>> {
        let (measured, scenario) = (&self.measured, &self.scenario);
        if scenario.unknown.shared == SharedUnknown::default() && measured.found.is_empty() {
            return Ok(Vec::new());
        }
        let told = Told::of(&self.setting());
        let environment = &scenario.environment[..];
        let spectra =
            spectra((&measured.bands, &[], &measured.lights), (&[], environment, library), self.air.as_ref());
        let of = Of {
            told: &told,
            environment,
            sky: None,
            found: &measured.found,
            spectra: &Arc::new(spectra),
            air: self.air.as_ref(),
            source: &scenario.source,
        };
        let used: Vec<usize> =
            (0..measured.bands.len()).filter(|band| !measured.bad_bands.contains(band)).collect();
        let mut rows = Vec::new();
        for unknown in of.unknowns(&scenario.unknown.shared)? {
            let other = again(&told.with(&unknown.cause, unknown.sigma)?.setting())?;
            let (mut square, mut count, mut lost) = (0.0, 0_usize, 0);
            for place in 0..found.clusters.len() {
                let like = counterpart(&found.maps, &other.maps, place);
                let Some(like) = like.and_then(|like| other.clusters.get(like)) else {
                    lost += 1;
                    blind(&mut found.clusters[place], &used);
                    continue;
                };
                square += widened(&mut found.clusters[place], like, &used);
                count += used.len();
            }
            let emissivity_rms = (square / count.max(1) as f64).sqrt();
            rows.push(SharedOfLibrary { stated: Stated::of(&unknown), emissivity_rms, lost });
        }
        Ok(rows)
    }
}

/// The cluster of other maps that has most pixels of one of these, if it is most of them.
fn counterpart(maps: &Maps, other: &Maps, place: usize) -> Option<usize> {
    let own = maps.material.iter().zip(&other.material).filter(|(own, _)| usize::from(**own) == place);
    let (mut counts, mut all) = (std::collections::BTreeMap::<u16, usize>::new(), 0);
    for (_, theirs) in own {
        all += 1;
        if *theirs != NO_MATERIAL {
            *counts.entry(*theirs).or_default() += 1;
        }
    }
    let (best, most) = counts.into_iter().max_by_key(|(_, count)| *count)?;
    (2 * most > all).then_some(usize::from(best))
}

/// An emissivity of which nothing is known.
fn blind(cluster: &mut Cluster, used: &[usize]) {
    used.iter().for_each(|band| cluster.sigma[*band] = cluster.sigma[*band].hypot(BLIND));
    cluster.sigma_mean = cluster.sigma_mean.hypot(BLIND);
}

/// Puts the difference from another emissivity into the deviations; Σ Δe².
fn widened(cluster: &mut Cluster, like: &Cluster, used: &[usize]) -> f64 {
    let off: Vec<f64> = used.iter().map(|band| like.emissivity[*band] - cluster.emissivity[*band]).collect();
    let mean = off.iter().sum::<f64>() / off.len().max(1) as f64;
    for (band, off) in used.iter().zip(&off) {
        cluster.sigma[*band] = cluster.sigma[*band].hypot(*off);
        cluster.sigma_magnitude[*band] = cluster.sigma_magnitude[*band].hypot(mean);
    }
    cluster.sigma_mean = cluster.sigma_mean.hypot(mean);
    off.iter().map(|off| off * off).sum()
}
