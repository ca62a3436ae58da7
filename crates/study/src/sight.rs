//! What a camera sees of the scene: the bands as they reach it, and the light that is mixed in.
//!
//! The signal of a target at distance z arrives as τ(ν, z) S and is counted with the efficiencies η(ν) of optics and
//! detector: the weights of the bands are multiplied by τ η. Light that tells nothing of the target adds its shot noise:
//!
//! * the air on the path, (1 − τ) B(T_air) (its part of the pixel is all of it);
//! * what is behind a target that fills the share φ of the pixel, (1 − φ) τ S_behind, lit as the target is;
//! * of an object every pixel sees the same, and the blur of the lens, the first dark ring 1.22 λF of its longest wavelength λ, takes
//!   away what is near its edges;
//! * filters in front of the sensor throw its own emission back, R_q B(T_sensor), and emit themselves,
//!   (1 − T_q − R_q) B(T_filter), over all of the detector's spectral range (S8, S9).
//!
//! Source: paper S7–S9 and S11–S12; M. Born, E. Wolf, Principles of Optics, 8.5.2 (the first dark ring).

use super::Study;
use hadar::error::{Error, Result};
use hadar::fisher::Counting;
use hadar::instrument::view::fill;
use hadar::instrument::{Camera, Extent, Light, NoiseSpec, View};
use hadar::planck;
use hadar::policy::caps::longest_wavelength_m;
use hadar::scene::State;
use hadar::spectrum::Bands;

/// The bands as they reach a camera, and what its pixel sees beside the target.
#[derive(Debug, Clone, PartialEq)]
pub struct Sight {
    /// Bands, weighed with what path, optics and detector let through.
    pub bands: Bands,
    /// Everything else on the pixel.
    pub view: View,
}

/// What a camera sees from anywhere along a stretch of distances.
#[derive(Debug, Clone)]
pub(super) struct Along {
    /// Bands as they reach it from the near end, the middle and the far end, and how far they may be off a parabola of ln z.
    pub(super) near: Bands,
    pub(super) middle: Bands,
    pub(super) far: Bands,
    pub(super) sag: Bands,
    /// The least counts per radiance, and the most added variance.
    pub(super) counting: Counting,
}

/// Radius of the first dark ring of a point over λF.
const DARK_RING: f64 = 1.22;

/// Bands as they reach a camera from a distance, and what the path emits at their nodes.
#[derive(Debug, Clone, Copy)]
struct Seen<'s> {
    bands: &'s Bands,
    distance_m: Option<f64>,
    air: &'s [f64],
}

impl Study {
    /// What a pixel of `camera` sees from the scenario's distance.
    #[must_use]
    pub fn view_of(&self, camera: &Camera) -> View {
        let seen = Seen { bands: &self.bands, distance_m: self.scenario.target.distance_m, air: &self.air };
        self.view(camera, [seen; 2])
    }

    /// Whether air changes spectra within bands, so that a distance may be worse than those on either side of it.
    pub(super) fn air_reshapes_bands(&self) -> bool {
        self.atmosphere.is_some() && !self.open_bands.one_node_per_band()
    }

    /// The same scene from another distance.
    ///
    /// # Errors
    /// A distance of which the air's table says nothing.
    pub(super) fn at_distance(&self, distance_m: f64) -> Result<Self> {
        hadar::stop::check();
        let mut study = self.clone();
        study.scenario.target.distance_m = Some(distance_m);
        (study.bands, study.air) = study.received(study.camera.as_ref(), Some(distance_m))?;
        Ok(study)
    }

    /// What `camera` sees from `distance_m`.
    ///
    /// # Errors
    /// A distance of which the air's table says nothing.
    pub fn sight_at(&self, camera: &Camera, distance_m: Option<f64>) -> Result<Sight> {
        let (bands, air) = self.received(Some(camera), distance_m)?;
        let view = self.view_through(camera, &bands, distance_m, &air);
        Ok(Sight { bands, view })
    }

    /// What a pixel of `camera` sees from `distance_m`, through bands and air that were received from there.
    pub(super) fn view_through(
        &self,
        camera: &Camera,
        bands: &Bands,
        distance_m: Option<f64>,
        air: &[f64],
    ) -> View {
        hadar::stop::check();
        self.view(camera, [Seen { bands, distance_m, air }; 2])
    }

    /// What `camera` sees from anywhere along a stretch of distances, m.
    ///
    /// # Errors
    /// Distances of which the air's table says nothing.
    pub(super) fn along(&self, camera: &Camera, [near_m, far_m]: [f64; 2]) -> Result<Along> {
        let from = |z: f64| self.received(Some(camera), Some(z));
        let ((near, near_air), (middle, _), (far, far_air)) =
            (from(near_m)?, from((near_m * far_m).sqrt())?, from(far_m)?);
        let open = camera.received(&self.open_bands);
        let sag = match &self.atmosphere {
            Some(air) => air.table.sag(open.nodes_cm1(), [near_m, far_m])?,
            None => vec![0.0; open.nodes_cm1().len()],
        };
        let ends = [
            Seen { bands: &near, distance_m: Some(near_m), air: &near_air },
            Seen { bands: &far, distance_m: Some(far_m), air: &far_air },
        ];
        let mut counting = camera.counting(&near, &self.view(camera, ends));
        // Étendue × fill rises, then falls.
        let fill = |z: f64| View { fill: self.fill(camera, Some(z)), ..View::at(Some(z)) };
        let kappa = |z: f64| camera.counts_per_radiance(&near, &fill(z));
        // Of an object the fewest pixels: with more of them the sum tells no less.
        let pixels = self.extent(camera, Some(far_m)).pixels();
        counting.counts_per_radiance = pixels * kappa(near_m).min(kappa(far_m));
        let sag = open.transmitted_at_nodes(&sag);
        Ok(Along { near, middle, far, sag, counting })
    }

    /// The bands behind path, optics and detector, and the emission of the path at their nodes (empty for none).
    pub(super) fn received(
        &self,
        camera: Option<&Camera>,
        distance_m: Option<f64>,
    ) -> Result<(Bands, Vec<f64>)> {
        hadar::stop::check();
        let bands =
            camera.map_or_else(|| self.open_bands.clone(), |camera| camera.received(&self.open_bands));
        let (Some(air), Some(distance_m)) = (&self.atmosphere, distance_m) else {
            return Ok((bands, Vec::new()));
        };
        let at_distance = |error: Error| error.at(self.scenario.place("target.distance"));
        let nodes = bands.nodes_cm1();
        let transmittance = air.table.transmittance(nodes, distance_m).map_err(at_distance)?;
        let emission = air.table.path_radiance(nodes, distance_m, air.temperature_k).map_err(at_distance)?;
        Ok((bands.transmitted_at_nodes(&transmittance), emission))
    }

    /// Variance of each band that comes with photons beside the target's own shot noise, by the scenario's camera, counts².
    pub(super) fn var_with_photons(&self) -> Vec<f64> {
        let var = |camera: &Camera| camera.var_with_photons(&self.bands, &self.view_of(camera));
        self.camera.as_ref().map_or_else(|| vec![0.0; self.bands.len()], var)
    }

    /// Refuses what the view leaves open.
    ///
    /// # Errors
    /// A size without a distance or without what is behind; what a camera's tables or range do not cover.
    pub(super) fn check_sight(&self) -> Result<()> {
        let scenario = &self.scenario;
        let refuse = |key: &str, found: &str, instead: &str| {
            Err(Error::malformed(found, instead).at(scenario.place(key)))
        };
        if scenario.is_of_object() && scenario.target.pixels.is_none() && scenario.target.size_m.is_none() {
            let instead = "write size = \"0.5 m\" and distance = \"30 m\" in [target], or pixels = 400";
            return refuse("requirement.of", "the size of the object is not stated", instead);
        }
        if scenario.target.size_m.is_some() {
            if scenario.target.distance_m.is_none() {
                return refuse(
                    "target.size",
                    "a size without a distance",
                    "write distance = \"30 m\" beside it",
                );
            }
            if self.behind.is_none() {
                let instead =
                    "write [background] with temperature = \"15 degC\" (and a material, else a blackbody)";
                return refuse("target.size", "a size, but what is behind the target is not stated", instead);
            }
        } else if self.behind.is_some() {
            let instead = "write size = \"0.5 m\" in [target]; without it the target fills the pixel";
            return refuse("background", "a background, but the target has no size", instead);
        }
        let Some(camera) = &self.camera else { return Ok(()) };
        for curve in &camera.efficiency_curves {
            let place = scenario.place(&format!("camera.{}", curve.name()));
            curve.check_covers(&self.open_bands).map_err(|error| error.at(place))?;
        }
        if let NoiseSpec::Table { wavenumbers_cm1, .. } = &camera.noise {
            let bands = &self.open_bands;
            bands
                .check_within("the noise", wavenumbers_cm1)
                .map_err(|error| error.at(scenario.place("camera.noise_table")))?;
        }
        Ok(())
    }

    /// What a pixel sees from one distance, given twice; of two, a view with no less noise than from any distance between: étendue
    /// and light of the path grow with distance, what target and background send and the share that the target fills fall.
    fn view(&self, camera: &Camera, [near, far]: [Seen<'_>; 2]) -> View {
        let mut view = View::at(far.distance_m);
        view.extent = self.extent(camera, far.distance_m);
        view.fill = self.fill(camera, near.distance_m);
        if !far.air.is_empty() {
            let open = camera.received(&self.open_bands);
            view.open_widths_cm1 = open.widths_cm1();
            if near.distance_m != far.distance_m {
                // Of noise stated as radiance it is the quotient of these and the bands' own, at most that of the far ones.
                let widths = near.bands.widths_cm1().into_iter().zip(far.bands.widths_cm1());
                view.open_widths_cm1
                    .iter_mut()
                    .zip(widths)
                    .for_each(|(open, (near, far))| *open *= near / far);
            }
            // Its own transmittance is in what it sends, so only the camera's weights apply.
            view.light.push(Light { label: "light from the path", radiance: open.weigh(far.air) });
        }
        let beside = 1.0 - self.fill(camera, far.distance_m);
        if let Some(behind) = self.behind.as_ref().filter(|_| beside > 0.0) {
            let state = State { temperature_k: behind.temperature_k, ..self.state.clone() };
            let signal = near.bands.weigh(&self.surroundings.signal(&behind.surface.emissivity, &state));
            let radiance = signal.iter().map(|s| s * beside).collect();
            view.light.push(Light { label: "light from behind the target", radiance });
        }
        for (label, radiance) in filter_light(camera, near.bands) {
            view.light.push(Light { label, radiance });
        }
        view.signal = near.bands.weigh(&self.surroundings.signal(&self.target.emissivity, &self.state));
        if camera.photon_bunching {
            view.occupancy = camera.counts_per_mode(&self.open_bands, &view);
        }
        view
    }

    /// Pixels of the target whose counts are added up: one, but of an object those that it fills.
    pub(super) fn extent(&self, camera: &Camera, distance_m: Option<f64>) -> Extent {
        let target = &self.scenario.target;
        if !self.scenario.is_of_object() {
            return Extent::ONE;
        }
        let of_size = |(size_m, distance_m)| {
            let ring_m = DARK_RING * longest_wavelength_m(&self.open_bands) * camera.f_number;
            Extent::inside(size_m, camera.footprint_m(distance_m), ring_m / camera.pixel_m)
        };
        // There are no more than the camera has. Its rows are not known: fewer than half of its columns they seldom are.
        let across = camera.pixels.map_or(f64::INFINITY, f64::from);
        match target.pixels {
            Some(filled) => filled.extent().within([across; 2]),
            None => target.size_m.zip(distance_m).map_or(Extent::ONE, of_size).within([0.5 * across, across]),
        }
    }

    /// Share of the pixel that the target fills.
    pub(super) fn fill(&self, camera: &Camera, distance_m: Option<f64>) -> f64 {
        let size = self.scenario.target.size_m.zip(distance_m);
        size.map_or(1.0, |(size, distance)| fill(size, camera.pixel_m, camera.focal_length_m, distance))
    }
}

/// What sensor and filters send onto the sensor, photons s⁻¹ m⁻² sr⁻¹ in each band.
fn filter_light(camera: &Camera, bands: &Bands) -> Vec<(&'static str, Vec<f64>)> {
    let Some(sensor_k) = camera.sensor_temperature_k else { return Vec::new() };
    let filter_k = camera.filter_temperature_k.unwrap_or(sensor_k);
    let range = camera.spectral_range_cm1;
    let counted = |nu: f64| camera.efficiency_curves.iter().map(|curve| curve.at(nu)).product::<f64>();
    let radiance = |nu: f64, temperature_k: f64| {
        let mut value = [0.0];
        planck::photon_radiance_into(&[nu], temperature_k, &mut value);
        value[0] * counted(nu)
    };
    let rows = camera.efficiency_curves.iter().flat_map(|curve| curve.wavenumbers_cm1());
    let kinks: Vec<f64> = rows.copied().collect();
    let thrown_back = bands.over_filters(range, &kinks, |nu, _, r| r * radiance(nu, sensor_k));
    let emitted =
        bands.over_filters(range, &kinks, |nu, t, r| (1.0 - t - r).max(0.0) * radiance(nu, filter_k));
    let lines = [("sensor emission thrown back by filters", thrown_back), ("emission of filters", emitted)];
    lines.into_iter().filter_map(|(label, light)| light.map(|light| (label, light))).collect()
}
