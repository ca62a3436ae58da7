//! Stereo beside the air: the same camera twice, a window of the target matched.
//!
//! Every pixel of the window differs from its neighbour by the share q (root mean square) of the target's own light τS as it arrives: the
//! information of the window's position is J = n Σ_w (q κ τS)²/(N + σ²) pixel⁻², n its pixels, and the depth error that of the stereo
//! bound ([`hadar::ranging::depth`]) with the Airy pattern of the lens. Light of the path has no texture, and its noise.

use super::AirRangingStudy;
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::ranging::air::AirState;
use hadar::ranging::depth::{Image, StereoGeometry, WindowInformation};
use hadar::ranging::psf::PointSpread;
use hadar_scenario::air_ranging::AirStereo;

impl AirRangingStudy {
    /// Least depth error of the stereo pair, m; infinite where nothing is seen of the texture.
    pub(super) fn stereo_sigma_m(
        &self,
        spec: &AirStereo,
        state: &AirState,
        counting: &Counting,
    ) -> Result<f64> {
        let place = |key: &str| self.scenario.place(key);
        let camera = &self.camera;
        let geometry = StereoGeometry::new(spec.baseline_m, camera.focal_length_m, camera.pixel_m)
            .map_err(|error| error.at(place("stereo")))?;
        let scene = self.scene()?;
        let nodes = self.bands.nodes_cm1();
        let all = scene.evaluate(scene.emissivity, state, &[], &[], false)?.signal;
        let path = self.bands.weigh(&scene.air.path_radiance(nodes, state.distance_m, state.air_k)?);
        let kappa = counting.counts_per_radiance;
        let pixels = (spec.window[0] * spec.window[1]) as f64;
        let (mut information, mut photons, mut var, mut centroid) = (0.0, 0.0, 0.0, 0.0);
        for (w, ((all, path), band)) in all.iter().zip(&path).zip(self.bands.bands()).enumerate() {
            let (counts, own, added) = (kappa * all, kappa * (all - path).max(0.0), counting.var_added(w));
            if counts + added > 0.0 {
                information += pixels * (spec.texture * own).powi(2) / (counts + added);
            }
            photons += pixels * counts;
            var += pixels * added;
            centroid += pixels * counts * band.center_cm1;
        }
        let window = WindowInformation::new(information, photons, var)?;
        let spread = PointSpread::airy(camera.f_number, centroid / photons)?;
        let image = Image::Ideal { var_diffraction_m2: spread.var_m2() };
        Ok(geometry.depth_bound(state.distance_m, [window; 2], image)?.sigma_z_m)
    }
}
