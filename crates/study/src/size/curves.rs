//! The curves behind the plots: spectra that look alike, information against photons, photons over a map.

use crate::{Study, Surface};
use hadar::error::Result;
use hadar::fisher::Nuisance;
use hadar::identifiability::detection;
use hadar::identifiability::local::LocalSolver;
use hadar::instrument::Camera;
use hadar::parallel;
use hadar::policy;
use hadar::scene::State;
use hadar_scenario::DistanceKind;

/// Half the points of a map along temperature and the points along lighting; fewer of both where the
/// temperatures of the surroundings are unknown, since every nearest state then takes ten times as long.
const MAP: (i32, u32) = (40, 51);
const COARSE_MAP: (i32, u32) = (12, 16);
/// The map reaches this far beyond the temperatures of the scene, K.
const MAP_MARGIN_K: f64 = 15.0;

/// The target and the nearest state of the alternative, as the camera sees them.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectra {
    /// Band centres, cm⁻¹.
    pub wavenumber_cm1: Vec<f64>,
    /// Mean signal of the target in each band, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
    pub target: Vec<f64>,
    /// The same of the nearest state.
    pub nearest: Vec<f64>,
    /// Standard deviation of the target's shot noise in one reading; empty without a camera.
    pub sigma_shot: Vec<f64>,
    /// Standard deviation of shot and electronic noise; empty without a camera.
    pub sigma: Vec<f64>,
    /// The nearest state.
    pub state: State,
}

/// Information against photons.
#[derive(Debug, Clone, PartialEq)]
pub struct InformationCurves {
    /// Photons.
    pub photons: Vec<f64>,
    /// Bits in the shot-noise limit by the nearest distance.
    pub nearest_bits: Vec<f64>,
    /// Bits in the shot-noise limit by the local distance.
    pub local_bits: Vec<f64>,
    /// Bits of the camera as its exposure varies; empty without one.
    pub camera_bits: Vec<f64>,
}

/// Required photons over target temperature and lighting.
#[derive(Debug, Clone, PartialEq)]
pub struct PhotonMap {
    /// Target temperatures, K.
    pub temperatures_k: Vec<f64>,
    /// Lighting factors of the first environment object.
    pub lightings: Vec<f64>,
    /// Photons for the requirement, row-major `[lighting][temperature]`; infinite where none suffice.
    pub photons: Vec<f64>,
    /// Temperature of the first environment object, K: with lighting 1 the equilibrium singularity.
    pub equilibrium_k: f64,
}

impl Study {
    /// The alternative of a name.
    #[must_use]
    pub fn alternative(&self, name: &str) -> Option<&Surface> {
        self.alternatives.iter().find(|surface| surface.name == name)
    }

    /// The spectra of the target and of the nearest state of `alternative`.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn spectra(&self, alternative: &Surface) -> Result<Spectra> {
        let nearest = self.nearest_solver().per_photon(
            &self.target.emissivity,
            &alternative.emissivity,
            &self.state,
            f64::INFINITY,
        )?;
        let widths = self.bands.widths_cm1();
        let per_cm1 = |signal: &[f64]| signal.iter().zip(&widths).map(|(s, w)| s / w).collect::<Vec<f64>>();
        let target = self.target_signal();
        let other = self.bands.weigh(&self.surroundings.signal(&alternative.emissivity, &nearest.state));
        let deviation = |electronic: bool| -> Vec<f64> {
            let Some(counting) = self.counting() else { return Vec::new() };
            let counts = counting.counts_per_radiance;
            let sigma = target.iter().enumerate().map(|(w, signal)| {
                let noise = if electronic { counting.var_added(w) } else { 0.0 };
                (counts * signal + noise).sqrt() / counts
            });
            per_cm1(&sigma.collect::<Vec<f64>>())
        };
        Ok(Spectra {
            wavenumber_cm1: self.bands.bands().iter().map(|band| band.center_cm1).collect(),
            target: per_cm1(&target),
            nearest: per_cm1(&other),
            sigma_shot: deviation(false),
            sigma: deviation(true),
            state: nearest.state,
        })
    }

    /// Information on `alternative` against so many numbers of photons: shot-noise limits, and the camera as its exposure varies.
    ///
    /// # Errors
    /// As [`Study::identify`].
    pub fn information_curves(
        &self,
        alternative: &Surface,
        distance_nearest: f64,
        distance_local: f64,
        points: usize,
    ) -> Result<InformationCurves> {
        let radiance = self.photon_radiance();
        let own = self.counting().map(|counting| counting.counts_per_radiance * radiance);
        let least = [distance_nearest, distance_local]
            .into_iter()
            .filter_map(|distance| policy::photons_required(self.required, distance))
            .fold(f64::INFINITY, f64::min);
        let most = [distance_nearest, distance_local]
            .into_iter()
            .filter_map(|distance| policy::photons_required(self.required, distance))
            .fold(0.0, f64::max);
        // From next to nothing to next to certainty, and the camera.
        let least = if least.is_finite() { least } else { own.unwrap_or(1e6) };
        let low = (1e-2 * least).min(own.map_or(f64::INFINITY, |own| 0.3 * own));
        let high = most.max(least).max(own.map_or(0.0, |own| 0.3 * own)) * 10.0;
        let photons = logarithmic([low, high], points);
        let shot = |distance: f64| -> Vec<f64> {
            photons.iter().map(|n| detection::information_bits(n.sqrt() * distance)).collect()
        };
        let camera_bits = match &self.camera {
            Some(camera) => self.camera_bits(camera, alternative, &photons)?,
            None => Vec::new(),
        };
        Ok(InformationCurves {
            nearest_bits: shot(distance_nearest),
            local_bits: shot(distance_local),
            camera_bits,
            photons,
        })
    }

    fn camera_bits(&self, camera: &Camera, alternative: &Surface, photons: &[f64]) -> Result<Vec<f64>> {
        let kind = self.scenario.requirement.by;
        parallel::booked(photons.len(), |i| {
            let counting = self.counting_with(camera, photons[i]);
            self.statistical_distance(kind, alternative, &counting).map(detection::information_bits)
        })
    }

    /// Photons that the requirement takes against `alternative`, over target temperature and lighting of
    /// the first environment object. `None` without environment objects.
    ///
    /// # Errors
    /// As [`Study::identify`].
    pub fn photon_map(&self, alternative: &Surface) -> Result<Option<PhotonMap>> {
        let Some(&equilibrium_k) = self.state.environment_k.first() else { return Ok(None) };
        let coarse = self.is_unknown(Nuisance::EnvironmentTemperature);
        let (half, count) = if coarse { COARSE_MAP } else { MAP };
        let temperatures_k = map_temperatures(equilibrium_k, self.state.temperature_k, half);
        let others: f64 = self.state.lighting.iter().skip(1).sum();
        let top = 1.0 - others;
        let lightings: Vec<f64> = (0..count).map(|i| top * f64::from(i) / f64::from(count - 1)).collect();
        let kind = self.scenario.requirement.by;
        let distances = self.map_distances(kind, alternative, &temperatures_k, &lightings)?;
        let mut photons = vec![f64::INFINITY; distances.len()];
        for (i, row) in distances.chunks(lightings.len()).enumerate() {
            for (j, &distance) in row.iter().enumerate() {
                if let Some(needed) = policy::photons_required(self.required, distance) {
                    photons[j * temperatures_k.len() + i] = needed;
                }
            }
        }
        Ok(Some(PhotonMap { temperatures_k, lightings, photons, equilibrium_k }))
    }

    /// Distances per √photon, temperature after temperature, lighting of the first environment object within.
    fn map_distances(
        &self,
        kind: DistanceKind,
        alternative: &Surface,
        temperatures_k: &[f64],
        lightings: &[f64],
    ) -> Result<Vec<f64>> {
        let (own, other) = (&self.target.emissivity, &alternative.emissivity);
        let states = |temperature_k: f64| {
            lightings.iter().map(move |&lighting| {
                let mut state = State { temperature_k, ..self.state.clone() };
                state.lighting.iter_mut().take(1).for_each(|first| *first = lighting);
                state
            })
        };
        let solver = || self.nearest_solver();
        let tangent = || {
            let unknowns = match kind {
                DistanceKind::LocalUnknownGain => self.unknowns.with(Nuisance::Gain),
                _ => self.unknowns.clone(),
            };
            LocalSolver::new(&self.bands, &self.surroundings, unknowns)
        };
        let rows: Result<Vec<Vec<f64>>> = match kind {
            DistanceKind::Nearest => parallel::try_map_with(temperatures_k.len(), solver, |solver, i| {
                let found = |state| Ok(solver.per_photon(own, other, &state, f64::INFINITY)?.distance);
                states(temperatures_k[i]).map(found).collect()
            }),
            _ => parallel::try_map_with(temperatures_k.len(), tangent, |solver, i| {
                let found = |state| Ok(solver.per_photon(own, other, &state, f64::INFINITY)?.distance);
                states(temperatures_k[i]).map(found).collect()
            }),
        };
        rows.map(|rows| rows.concat())
    }
}

/// So many values from the first to the second, evenly spread in the logarithm.
pub(crate) fn logarithmic([low, high]: [f64; 2], points: usize) -> Vec<f64> {
    let last = points.saturating_sub(1).max(1) as f64;
    (0..points).map(|i| (low.ln() + (high / low).ln() * i as f64 / last).exp()).collect()
}

/// Temperatures around those of the scene, one of them exactly that of the environment.
fn map_temperatures(equilibrium_k: f64, target_k: f64, half: i32) -> Vec<f64> {
    let reach = (target_k - equilibrium_k).abs() + MAP_MARGIN_K;
    let step = reach.min(0.9 * equilibrium_k) / f64::from(half);
    (-half..=half).map(|i| f64::from(i).mul_add(step, equilibrium_k)).collect()
}
