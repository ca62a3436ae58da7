//! What has one value for a whole cube and is not known exactly (`[unknown]`), as amounts of causes.
//!
//! A key becomes one or more amounts: a shape of the sky three of them, so that its rms over the bands is what is stated,
//! σₙ² = s² (2n + 1)/3 for Legendre's polynomial of order n; a temperature one for each light that is a surface. The sky is the one that is named,
//! else the darkest light.

use crate::air::Air;
use crate::heat_cube::sent;
use crate::light_found::{LightFound, air_of_sky};
use crate::model_judged::said;
use hadar::error::{Error, Result};
use hadar::material::{Library, Material};
use hadar::order;
use hadar::spectrum::{Bands, interpolated};
use hadar_estimate::decompose::{Cause, Light, Path, Spectra, Told, Unknown};
use hadar_scenario::Source;
use hadar_scenario::decompose::{AirOfCube, LightSource, SharedUnknown};
use serde::Serialize;
use std::sync::Arc;

/// Parts of a step between two bands in which spectra are read for a shift.
const BETWEEN: usize = 8;
/// A temperature of a light that may be missing where none is found, K.
const MISSING_K: f64 = 293.15;

/// An unknown that is stated, by its name.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stated {
    /// `gain`, `wavelength-shift`, `light-scale`, `light-shape`, `light-path`, `light-temperature`, `light-missing` or `air`.
    pub unknown: &'static str,
    /// Which of the surroundings, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light: Option<usize>,
    /// Order of the polynomial of a shape.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order: Option<usize>,
    /// Deviation that was stated, or that a light was found with.
    pub sigma_stated: f64,
    /// `cm^-1`, `K`, `m`, or nothing for a share.
    pub unit: &'static str,
}

impl Stated {
    pub(super) fn of(one: &Unknown) -> Self {
        let (name, light, _, unit) = said(&one.cause);
        let order = match one.cause {
            Cause::LightShape { order, .. } => Some(order),
            _ => None,
        };
        let unknown = if order.is_some() { "light-shape" } else { name };
        Self { unknown, light, order, sigma_stated: one.sigma, unit }
    }
}

/// Of what it is said.
#[derive(Debug)]
pub(super) struct Of<'a> {
    pub(super) told: &'a Told,
    pub(super) environment: &'a [LightSource],
    /// Which of them is named the sky.
    pub(super) sky: Option<usize>,
    /// Those that were found in the cube.
    pub(super) found: &'a [LightFound],
    pub(super) spectra: &'a Arc<Spectra>,
    pub(super) air: Option<&'a (Air, f64)>,
    pub(super) source: &'a Source,
}

impl Of<'_> {
    /// What is unknown, as amounts of causes.
    pub(super) fn unknowns(&self, stated: &SharedUnknown) -> Result<Vec<Unknown>> {
        let told = self.told;
        let mut all = Vec::new();
        let mut add = |cause: Cause, sigma: f64| all.push(Unknown { cause, sigma });
        let lacks = |key: &str, found: &str| Err(self.lacks(key, found));
        if let Some(sigma) = stated.gain {
            add(Cause::Gain, sigma);
        }
        if let Some(sigma) = stated.wavelength_shift_cm1 {
            add(Cause::WavelengthShift(self.spectra.clone()), sigma);
        }
        self.of_sky(stated, &mut add)?;
        let ground =
            |one: &LightFound| one.temperature_sigma_k.map(|sigma| (one.light, one.temperature_k, sigma));
        let grounds = self.found.iter().filter_map(ground);
        let surfaces = self.environment.iter().enumerate().filter_map(|(light, source)| match source {
            LightSource::Surface { temperature_k, .. } => Some((light, *temperature_k)),
            _ => None,
        });
        let warm = surfaces.map(|(light, temperature_k)| (light, temperature_k, None));
        let warm =
            warm.chain(grounds.map(|(light, temperature_k, sigma)| (light, temperature_k, Some(sigma))));
        let warm: Vec<_> = warm.collect();
        if stated.light_temperature_k.is_some() && warm.is_empty() {
            return lacks("unknown.light_temperature", "surroundings without temperature");
        }
        for (light, temperature_k, found) in warm {
            if let Some(sigma) = stated.light_temperature_k.or(found) {
                add(Cause::LightTemperature { light, temperature_k }, sigma);
            }
        }
        for one in self.found.iter().filter(|one| one.temperature_sigma_k.is_some()) {
            shape(one.light, one.shape_sigma, &mut add);
        }
        if let Some(sigma) = stated.missing_light {
            add(Cause::LightMissing { temperature_k: hottest_k(self.environment) }, sigma);
        }
        if let Some((sigma, (air, distance_m))) = stated.air_m.zip(self.air) {
            let (_, depth_per_m) = air.table.optical_depth_and_growth(told.bands.nodes_cm1(), *distance_m)?;
            add(Cause::Air { depth_per_m, temperature_k: air.temperature_k }, sigma);
        }
        Ok(all)
    }

    fn lacks(&self, key: &str, found: &str) -> Error {
        let error = Error::malformed(found, "write an [[environment]] that it is said of, or leave it out");
        error.at(self.source.place(key))
    }

    /// What is unknown of the sky: as stated, else as it was found.
    fn of_sky(&self, stated: &SharedUnknown, add: &mut impl FnMut(Cause, f64)) -> Result<()> {
        let told = self.told;
        let signal = |light: &Light| match light {
            Light::Radiance(radiance) => told.bands.weigh(radiance),
            Light::Counts(counts) => {
                counts.iter().zip(&told.counts_per_radiance).map(|(n, k)| n / k).collect()
            }
        };
        let strength = |light: &Light| -> f64 {
            signal(light).iter().zip(&told.counts_per_radiance).map(|(s, k)| s * k).sum()
        };
        let is_sky = |one: &&LightFound| one.path_sigma.is_some();
        let all =
            [("sky_scale", stated.sky_scale), ("sky_shape", stated.sky_shape), ("sky_path", stated.sky_path)];
        let asked = all.iter().find(|(_, sigma)| sigma.is_some());
        let lights = told.surroundings.iter().enumerate();
        let darkest = lights.min_by(|a, b| strength(a.1).total_cmp(&strength(b.1)));
        // Where several are found, each has its error.
        let found = self.found.iter().filter(is_sky).map(|one| one.light);
        let mut skies: Vec<usize> = self.sky.into_iter().collect();
        skies.extend(found.filter(|light| Some(*light) != self.sky));
        if skies.is_empty() && asked.is_some() {
            skies.extend(darkest.map(|(sky, _)| sky));
        }
        if let (Some((key, _)), true) = (asked, skies.is_empty()) {
            return Err(self.lacks(&format!("unknown.{key}"), "sky without surroundings"));
        }
        for sky in skies {
            let found = self.found.iter().find(|one| one.light == sky).filter(is_sky);
            if let Some(sigma) = stated.sky_scale.or(found.and_then(|one| one.scale_sigma)) {
                add(Cause::LightScale(sky), sigma);
            }
            if let Some(sigma) = stated.sky_shape.or(found.map(|one| one.shape_sigma)) {
                shape(sky, sigma, add);
            }
            if let Some(sigma) = stated.sky_path.or(found.and_then(|one| one.path_sigma)) {
                let radiances = told.surroundings.get(sky).map_or_else(Vec::new, signal);
                let of = (&told.bands, &told.bad_bands[..]);
                let emissivity = air_of_sky(of, &radiances, found.and_then(|one| one.air_k));
                add(Cause::LightPath { light: sky, emissivity }, sigma);
            }
        }
        Ok(())
    }
}

/// The shape of a light, as three amounts.
fn shape(light: usize, sigma: f64, add: &mut impl FnMut(Cause, f64)) {
    for order in 1..4 {
        add(Cause::LightShape { light, order }, sigma * ((2 * order + 1) as f64 / 3.0).sqrt());
    }
}

/// Temperature of the warmest light that has one, K.
pub(super) fn hottest_k(environment: &[LightSource]) -> f64 {
    let warm = environment.iter().filter_map(|source| match source {
        LightSource::Surface { temperature_k, .. } => Some(*temperature_k),
        _ => None,
    });
    warm.reduce(f64::max).unwrap_or(MISSING_K)
}

/// The air that is said of a cube, with the length of its path, m, and what it does at the nodes; refused beside lights that were counted behind it.
pub(super) fn air_of_cube(
    spec: Option<&AirOfCube>,
    (nodes, lights): (&[f64], &[Light]),
    source: &Source,
) -> Result<Option<((Air, f64), Path)>> {
    let at = |key: &str| {
        let (place, key) = (source.place(key), key.to_owned());
        move |error: Error| match &error {
            Error::At { place, .. } if place.path.is_some() => error.for_key(key.clone()),
            _ => error.at(place.clone()),
        }
    };
    let Some(spec) = spec else { return Ok(None) };
    let air = (Air::looked_up(&spec.air, source)?, spec.distance_m);
    let path = path(&air, nodes).map_err(at("atmosphere"))?;
    if let Some(counted) = lights.iter().position(|light| matches!(light, Light::Counts(_))) {
        let found = "rows or pixels of the cube as a light, and air before the camera";
        let instead = "give the light as a spectrum or a temperature, or leave [atmosphere] out";
        return Err(at(&format!("environment[{counted}]"))(Error::malformed(found, instead)));
    }
    Ok(Some((air, path)))
}

/// The air at the nodes.
pub(super) fn path((air, distance_m): &(Air, f64), nodes: &[f64]) -> Result<Path> {
    Ok(Path {
        transmittance: air.table.transmittance(nodes, *distance_m)?,
        radiance: air.table.path_radiance(nodes, *distance_m, air.temperature_k)?,
    })
}

/// All spectra on a finer grid, a band wider at both ends where they reach so far; else they go on as they end.
pub(super) fn spectra(
    (bands, emissivities, lights): (&Bands, &[Vec<f64>], &[Light]),
    (materials, environment, library): (&[&Material], &[LightSource], &Library),
    air: Option<&(Air, f64)>,
) -> Spectra {
    let nodes = bands.nodes_cm1();
    let widest = bands.widths_cm1().into_iter().fold(0.0, f64::max);
    let parts = if bands.one_node_per_band() { BETWEEN } else { 1 };
    let grid_cm1 = Spectra::grid(nodes, parts, widest);
    let (low, high) = bands.range_cm1();
    let inside: Vec<f64> = grid_cm1.iter().map(|nu| nu.clamp(low, high)).collect();
    let on_grid = |read: &dyn Fn(&[f64]) -> Option<Vec<f64>>, at_nodes: &[f64]| {
        read(&grid_cm1).or_else(|| read(&inside)).unwrap_or_else(|| {
            let mut rows: Vec<(f64, f64)> = nodes.iter().copied().zip(at_nodes.iter().copied()).collect();
            order::ascending(&mut rows, |row| row.0);
            let (xs, ys): (Vec<f64>, Vec<f64>) = rows.into_iter().unzip();
            inside.iter().map(|nu| interpolated(&xs, &ys, *nu)).collect()
        })
    };
    let each = materials.iter().zip(emissivities);
    let surroundings = environment.iter().zip(lights).map(|(source, light)| match light {
        Light::Radiance(radiance) => on_grid(&|nodes| sent(source, nodes, library).ok().flatten(), radiance),
        Light::Counts(_) => Vec::new(),
    });
    let between = air.and_then(|air| path(air, &grid_cm1).or_else(|_| path(air, &inside)).ok());
    Spectra {
        library: each.map(|(one, e)| on_grid(&|nodes| one.emissivity(nodes).ok(), e)).collect(),
        surroundings: surroundings.collect(),
        path: between,
        grid_cm1,
    }
}
