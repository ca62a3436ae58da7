//! A library made out of a heat cube: files looked up, emissivities, and what they are worth where the truth is known.

mod results;
mod shared;

pub use results::{ClusterRow, LibraryFound, SharedOfLibrary, TruthOfClusters};

use super::Warning;
use super::decompose::Truth;
use super::heat_cube::{Measured, Said};
use crate::air::Air;
use crate::budget::Takes;
use crate::shared_unknown::air_of_cube;
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar_estimate::decompose::{NO_MATERIAL, Path, Setting};
use hadar_estimate::separation::{Asked, COUNT, library_from_cube};
use hadar_scenario::LibraryScenario;

/// Share of χ²/ν above 1 up to which a cluster counts as one material.
const MISFIT: f64 = 0.05;
/// A mean emissivity that is known less well than this is hardly told.
const HARDLY: f64 = 0.05;

/// The scenario with everything it names looked up and checked.
#[derive(Debug)]
pub struct LibraryStudy {
    scenario: LibraryScenario,
    measured: Measured,
    /// The air before the camera with the length of its path, m, and what it does at the nodes.
    air: Option<(Air, f64)>,
    path: Option<Path>,
    truth: Option<Truth>,
}

impl LibraryStudy {
    /// What it takes at least.
    #[must_use]
    pub fn takes(&self) -> Takes {
        let shape = self.measured.cube.shape();
        Takes::of_samples([shape.rows(), shape.columns(), shape.bands()])
    }

    /// Looks up everything that `scenario` names, materials of the surroundings in `library`, and opens its cube.
    ///
    /// # Errors
    /// A cube and bands that do not agree, files that cannot be used, more clusters than pixels; with file, line and key.
    pub fn new(scenario: &LibraryScenario, library: &Library) -> Result<Self> {
        let said = Said {
            cube: &scenario.cube,
            bands: scenario.bands.as_ref(),
            camera: scenario.camera.as_ref(),
            environment: &scenario.environment,
            source: &scenario.source,
            temperature_k: scenario.unknown.temperature_k,
            gain: false,
        };
        let measured = said.measured(library)?;
        let shape = measured.cube.shape();
        let (pixels, [_, most]) = (shape.rows() * shape.columns(), scenario.clusters.count);
        if most > pixels {
            let found = format!("{most} clusters of {pixels} pixels");
            let error = Error::malformed(found, "ask for fewer clusters than pixels");
            return Err(said.at("clusters.count")(error));
        }
        let truth = scenario.truth.as_ref().map(|spec| {
            Truth::open(spec, shape, measured.lights.len(), usize::from(NO_MATERIAL))
                .map_err(|(key, error)| said.at(&key)(error))
        });
        let at_nodes = (measured.bands.nodes_cm1(), &measured.lights[..]);
        let (air, path) = air_of_cube(scenario.atmosphere.as_ref(), at_nodes, &scenario.source)?.unzip();
        Ok(Self { scenario: scenario.clone(), truth: truth.transpose()?, measured, air, path })
    }

    fn setting(&self) -> Setting<'_> {
        let (measured, scenario) = (&self.measured, &self.scenario);
        Setting {
            bands: &measured.bands,
            library: &[],
            surroundings: &measured.lights,
            counts_per_radiance: &measured.counts_per_radiance,
            var_added: &measured.var_added,
            units_per_count: measured.units_per_count,
            temperature_k: scenario.unknown.temperature_k,
            lighting_total: scenario.unknown.lighting_total,
            gain: false,
            bad_bands: &measured.bad_bands,
            path: self.path.as_ref(),
            light_besides: &[],
        }
    }

    /// The library; `done` is told how many rows of the cube are finished, of how many.
    ///
    /// # Errors
    /// Counts that are negative, a cube that cannot be read, more clusters than pixels that have an emissivity.
    pub fn library(
        &self,
        library: &Library,
        seed: u64,
        done: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<LibraryFound> {
        let (measured, scenario) = (&self.measured, &self.scenario);
        let clusters = scenario.clusters;
        let asked = Asked {
            count: clusters.count,
            max_emissivity: clusters.max_emissivity,
            prior: scenario.emissivity,
            seed,
        };
        let rows = measured.cube.shape().rows();
        let finished = std::sync::atomic::AtomicUsize::new(0);
        let progress = |more: usize| {
            done(finished.fetch_add(more, std::sync::atomic::Ordering::Relaxed) + more, rows);
        };
        let error = |error: Error| match &error {
            Error::At { place, .. } if place.path.is_some() => error,
            // What is asked for is wrong, or what the cube holds.
            Error::At { place, source } if place.key.as_deref() == Some(COUNT) => {
                source.as_ref().clone().at(scenario.source.place(COUNT))
            }
            _ => error.in_file(&scenario.cube.data),
        };
        let mut found =
            library_from_cube(&self.setting(), &asked, &measured.cube, &progress).map_err(error)?;
        let again = |setting: &Setting<'_>| {
            library_from_cube(setting, &asked, &measured.cube, &|_| ()).map_err(error)
        };
        let shared = self.with_shared(library, &mut found, &again)?;
        found.maps.leave_out_unknown_lighting(scenario.unknown.lighting_total);
        let truth = self.truth.as_ref().map(|truth| Ok(results::against(&truth.all()?, &found.maps)));
        let truth = truth.transpose()?;
        let mut warnings = measured.warnings.clone();
        if clusters.count == [1, 1] {
            warnings.push(Warning::OneCluster);
        }
        let asked_for = found.tried.iter().find(|one| one.left == found.clusters.len());
        let asked_for = asked_for.map_or(clusters.count[1], |one| one.count);
        if found.clusters.len() < asked_for {
            warnings.push(Warning::ClustersWithoutPixels { left: found.clusters.len(), asked: asked_for });
        }
        if !found.settled {
            warnings.push(Warning::ClustersNotSettled { rounds: found.rounds });
        }
        let bands = measured.bands.len().saturating_sub(measured.bad_bands.len());
        let misfits: Vec<usize> = found
            .clusters
            .iter()
            .enumerate()
            .filter(|(_, one)| {
                // χ²/ν of as many readings scatters by √(2/ν).
                let scatter = (2.0 / (one.fitted * bands).max(1) as f64).sqrt();
                one.chi_square_reduced > 1.0 + MISFIT.max(6.0 * scatter)
            })
            .map(|(i, _)| i)
            .collect();
        if !misfits.is_empty() {
            let chi_squares = misfits.iter().map(|i| found.clusters[*i].chi_square_reduced);
            warnings.push(Warning::ClusterDoesNotFit {
                chi_square: chi_squares.fold(0.0, f64::max),
                clusters: misfits.iter().map(|i| results::name(*i)).collect(),
            });
        }
        if measured.lights.len() > 1 && scenario.unknown.lighting_total.is_none() {
            warnings.push(Warning::MirrorNotExcluded { surroundings: measured.lights.len() });
        }
        if found.without_nem > 0 {
            warnings.push(Warning::NoRelativeEmissivity { pixels: found.without_nem, of: found.drawn });
        }
        let hardly: Vec<(String, f64)> = found
            .clusters
            .iter()
            .enumerate()
            .filter(|(_, one)| one.sigma_mean > HARDLY)
            .map(|(i, one)| (results::name(i), one.sigma_mean))
            .collect();
        if !hardly.is_empty() {
            warnings.push(Warning::MagnitudeHardlyTold {
                sigma: hardly.iter().map(|one| one.1).fold(0.0, f64::max),
                clusters: hardly.into_iter().map(|one| one.0).collect(),
            });
        }
        Ok(results::summary(scenario, measured, found, truth, shared, (misfits, warnings)))
    }
}
