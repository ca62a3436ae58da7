//! Over which bands of a scenario the spectra are integrated, and how well.
//!
//! Ranges and filters always are; bands of a grid or of rows where a spectrum in them (of target, alternatives, surroundings,
//! background, air or the camera's efficiency) has rows nearer to each other than the band is wide; the others are sampled at their
//! centres, as in the paper. `integrate = true` and `false` decide it for all bands of a grid or of rows.
//!
//! Integrands are the signals e B(T) and e B(T) + (1 − e) εₖ B(Tₖ) of every surface, in the target's state and at a temperature
//! below all that are stated, where Planck's law is steepest, times what air and camera let through. Signals of other states are mixtures
//! of the same and smoother. A relative error η of every signal moves a distance d₀ per √photon by no more than 2η.

use super::air::Air;
use hadar::demand::{Reason, Thing, Work};
use hadar::error::Result;
use hadar::instrument::{Camera, EfficiencyCurve};
use hadar::material::Material;
use hadar::planck;
use hadar::spectrum::{Band, Bands};
use hadar_scenario::{BandSource, Scenario};
use std::borrow::Cow;

/// Rows are nearer than the band is wide below this share of its width: an even grid of wavelengths is uneven in wavenumber.
const NEARER: f64 = 0.95;
/// Share of the tolerance that integrals are made to: distances are differences of them.
const SHARE: f64 = 1e-2;
/// Colder than this, and than this share of the coldest that is stated, nothing is looked at, K.
const COLD_K: f64 = 250.0;
const COLDER: f64 = 0.8;

/// The spectra of a scenario before they are sampled.
pub(super) struct Spectra<'a> {
    /// All that target and alternatives may be of.
    pub(super) surfaces: &'a [&'a Material],
    /// One per environment object; a blackbody where `None`.
    pub(super) environment: &'a [Option<Cow<'a, Material>>],
    /// Temperature and material of what is behind the target.
    pub(super) behind: Option<(f64, Option<&'a Material>)>,
    pub(super) air: Option<&'a Air>,
    pub(super) camera: Option<&'a Camera>,
}

/// How the bands of a scenario integrate its spectra.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Integration {
    /// Bound on the relative error of a signal of a band that is integrated.
    pub(super) relative_error: f64,
    /// Width of the widest band that is sampled at its centre, cm⁻¹.
    pub(super) sampled_cm1: Option<f64>,
}

impl Integration {
    /// Relative error of a distance per √photon, for the error of the integrals.
    pub(super) fn share_of(self, distance_per_photon: f64) -> f64 {
        if distance_per_photon > 0.0 { 2.0 * self.relative_error / distance_per_photon } else { 0.0 }
    }
}

/// All that integrals over bands depend on, but what says where an error is.
#[derive(Debug, PartialEq)]
pub(super) struct Integrand {
    temperatures_k: Vec<f64>,
    /// Whether integrals are asked for, or refused.
    asked: Option<bool>,
    tolerance: f64,
    bands: Bands,
    surfaces: Vec<Material>,
    environment: Vec<Option<Material>>,
    behind: Option<(f64, Option<Material>)>,
    air: Option<(Air, Option<f64>)>,
    curves: Vec<EfficiencyCurve>,
}

/// Bands with nodes that integrate the spectra of a scenario where they must, how well, and what that took.
pub(super) type Integrals = (Bands, Integration, Work);

impl Spectra<'_> {
    /// What their integrals over bands of a scenario depend on.
    pub(super) fn integrand(&self, scenario: &Scenario, asked: Option<bool>, bands: &Bands) -> Integrand {
        let around = scenario.environment.iter().map(|object| object.temperature_k);
        let owned = |material: &Cow<'_, Material>| material.as_ref().clone();
        Integrand {
            temperatures_k: std::iter::once(scenario.target.temperature_k).chain(around).collect(),
            asked,
            tolerance: scenario.bands.tolerance,
            bands: bands.clone(),
            surfaces: self.surfaces.iter().copied().cloned().collect(),
            environment: self.environment.iter().map(|material| material.as_ref().map(owned)).collect(),
            behind: self.behind.map(|(temperature_k, material)| (temperature_k, material.cloned())),
            air: self.air.map(|air| (air.clone(), scenario.target.distance_m)),
            curves: self.camera.map(|camera| camera.efficiency_curves.clone()).unwrap_or_default(),
        }
    }

    fn materials(&self) -> impl Iterator<Item = &Material> {
        let around = self.environment.iter().flatten().map(AsRef::as_ref);
        self.surfaces.iter().copied().chain(around).chain(self.behind.and_then(|(_, material)| material))
    }

    /// Rows of each spectrum between two wavenumbers, ascending.
    fn rows(&self, low_cm1: f64, high_cm1: f64) -> Vec<Vec<f64>> {
        let within = |rows: &[f64]| -> Vec<f64> {
            rows.iter().copied().filter(|nu| (low_cm1..high_cm1).contains(nu)).collect()
        };
        let of_materials = self.materials().map(|material| material.breakpoints_cm1(low_cm1, high_cm1));
        let of_air = self.air.map(|air| within(air.table.wavenumbers_cm1()));
        let curves = self.camera.iter().flat_map(|camera| &camera.efficiency_curves);
        of_materials.chain(of_air).chain(curves.map(|curve| within(curve.wavenumbers_cm1()))).collect()
    }

    /// Whether all spectra are known over all of a band.
    fn cover(&self, band: &Band) -> bool {
        hadar::stop::check();
        let air = self.air.map_or((0.0, f64::INFINITY), |air| air.table.range_cm1());
        air.0 <= band.low_cm1
            && band.high_cm1 <= air.1
            && self.materials().all(|material| material.emissivity(&[band.low_cm1, band.high_cm1]).is_ok())
    }

    /// The signals that are integrated, at some nodes.
    fn signals(&self, scenario: &Scenario, nodes: &[f64]) -> Result<Vec<Vec<f64>>> {
        hadar::stop::check();
        let emission = |temperature_k: f64| {
            let mut radiance = vec![0.0; nodes.len()];
            planck::photon_radiance_into(nodes, temperature_k, &mut radiance);
            radiance
        };
        let around = scenario.environment.iter().map(|object| object.temperature_k);
        let stated = around.chain([scenario.target.temperature_k]).chain(self.behind.map(|behind| behind.0));
        let cold = emission(COLDER * stated.fold(COLD_K, f64::min));
        let own = emission(scenario.target.temperature_k);
        let mut through = vec![1.0; nodes.len()];
        for curve in self.camera.iter().flat_map(|camera| &camera.efficiency_curves) {
            through.iter_mut().zip(nodes).for_each(|(share, nu)| *share *= curve.at(*nu));
        }
        let mut found = Vec::new();
        if let Some((air, distance_m)) = self.air.zip(scenario.target.distance_m) {
            // What the table says nothing of is refused elsewhere.
            let nothing = || vec![0.0; nodes.len()];
            let tau = air.table.transmittance(nodes, distance_m).unwrap_or_else(|_| nothing());
            let path = air.table.path_radiance(nodes, distance_m, air.temperature_k);
            let path = path.unwrap_or_else(|_| nothing());
            found.push(path.iter().zip(&through).map(|(path, share)| path * share).collect());
            through.iter_mut().zip(tau).for_each(|(share, tau)| *share *= tau);
        }
        let mut lights = Vec::new();
        for (object, material) in scenario.environment.iter().zip(self.environment) {
            let mut light = emission(object.temperature_k);
            if let Some(material) = material {
                light.iter_mut().zip(material.emissivity(nodes)?).for_each(|(light, e)| *light *= e);
            }
            lights.push(light);
        }
        let mut surface = |material: Option<&Material>, own: &[f64]| -> Result<()> {
            let emissivity = match material {
                Some(material) => material.emissivity(nodes)?,
                None => vec![1.0; nodes.len()],
            };
            let at = |j: usize, emitted: &[f64], light: f64| {
                through[j] * emissivity[j].mul_add(emitted[j], (1.0 - emissivity[j]) * light)
            };
            found.push((0..nodes.len()).map(|j| at(j, own, 0.0)).collect());
            found.push((0..nodes.len()).map(|j| at(j, &cold, 0.0)).collect());
            found.extend(
                lights.iter().map(|light| (0..nodes.len()).map(|j| at(j, &cold, light[j])).collect()),
            );
            Ok(())
        };
        self.surfaces.iter().try_for_each(|material| surface(Some(material), &own))?;
        if let Some((temperature_k, material)) = self.behind {
            surface(material, &emission(temperature_k))?;
        }
        Ok(found)
    }
}

/// Whether the integrals of a scenario are asked for, or refused.
pub(super) fn asked(scenario: &Scenario, source: &BandSource) -> Option<bool> {
    let always = matches!(source, BandSource::Ranges(_) | BandSource::Filters(_));
    scenario.bands.integrate.filter(|_| !always).or(always.then_some(true))
}

/// The integrals of a scenario over its bands.
pub(super) fn integrated(
    scenario: &Scenario,
    asked: Option<bool>,
    bands: &Bands,
    spectra: &Spectra<'_>,
) -> Result<Integrals> {
    let low = bands.bands().iter().map(|band| band.low_cm1).fold(f64::INFINITY, f64::min);
    let high = bands.bands().iter().map(|band| band.high_cm1).fold(0.0, f64::max);
    let widest = bands.bands().iter().map(|band| band.high_cm1 - band.low_cm1).fold(0.0, f64::max);
    let rows = match asked {
        Some(false) => Vec::new(),
        _ => spectra.rows(low - widest, high + widest),
    };
    let known = bands.range_cm1();
    let which: Vec<bool> = bands
        .bands()
        .iter()
        .map(|band| {
            asked.unwrap_or_else(|| {
                // Between the centres all spectra are known.
                let inside = known.0 <= band.low_cm1 && band.high_cm1 <= known.1;
                rows.iter().any(|rows| has_nearer(rows, band)) && (inside || spectra.cover(band))
            })
        })
        .collect();
    let count = which.iter().filter(|integrated| **integrated).count();
    let mut work = Work::default();
    work.compute(Thing::BandIntegrals, count as u64);
    let reason = if asked.is_none() { Reason::NoNearerRows } else { Reason::NotAsked };
    work.spare(Thing::BandIntegrals, reason, (which.len() - count) as u64);
    let sampled = bands.bands().iter().zip(&which).filter(|(_, integrated)| !**integrated);
    let sampled_cm1 = sampled.map(|(band, _)| band.high_cm1 - band.low_cm1).max_by(f64::total_cmp);
    if count == 0 {
        return Ok((bands.clone(), Integration { relative_error: 0.0, sampled_cm1 }, work));
    }
    let tolerance = SHARE * scenario.bands.tolerance;
    let found = bands
        .integrated_where(&which, &rows.concat(), tolerance, |nodes| spectra.signals(scenario, nodes))
        .map_err(|error| error.at(scenario.place("bands")))?;
    Ok((found.bands, Integration { relative_error: found.relative_error, sampled_cm1 }, work))
}

/// Whether two rows in or beside a band are nearer to each other than it is wide.
fn has_nearer(rows: &[f64], band: &Band) -> bool {
    let from = rows.partition_point(|row| *row <= band.low_cm1).saturating_sub(1);
    let to = (rows.partition_point(|row| *row < band.high_cm1) + 1).min(rows.len());
    let most = NEARER * (band.high_cm1 - band.low_cm1);
    rows.get(from..to).unwrap_or_default().windows(2).any(|pair| pair[1] - pair[0] < most)
}
