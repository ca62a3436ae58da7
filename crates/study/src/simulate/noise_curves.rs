//! Information against photons, with each kind of the camera's noise alone and with all of them.
//!
//! Photons N grow with the exposure. Johnson noise has a variance ∝ t, so γ₀ = σ²/N stays; flicker noise one ∝ t², so
//! γ = γ₁N grows, and no exposure is long enough (paper, Fig. 3b and Fig. S7). Limits are those to the nearest state
//! of the alternative under the noise at hand. Shot noise is there in every curve.

use crate::size::logarithmic;
use crate::{Study, Surface};
use hadar::error::Result;
use hadar::identifiability::detection;
use hadar::instrument::{Camera, gamma_per_band};

/// Statistical distances to one alternative, at photon numbers in rising order.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseCurves {
    /// Nearest distance per √photon without electronic noise.
    pub distance: f64,
    /// N·d₀².
    pub normalised_photons: Vec<f64>,
    /// Name of the noise, γ and statistical distance at each number of photons.
    pub curves: Vec<NoiseCurve>,
}

/// One kind of noise.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseCurve {
    /// What noise.
    pub name: &'static str,
    /// γ of a band.
    pub gamma: Vec<f64>,
    /// Statistical distance to the nearest state.
    pub distance: Vec<f64>,
}

impl NoiseCurve {
    /// Information log₂ 2Φ(d), bits.
    #[must_use]
    pub fn information_bits(&self) -> Vec<f64> {
        self.distance.iter().map(|&d| detection::information_bits(d)).collect()
    }
}

impl Study {
    /// Curves of shot noise alone and, with a noisy camera, of its Johnson noise, its flicker noise and both; at so
    /// many points with N d₀² in `range`.
    ///
    /// # Errors
    /// As [`Study::identify`].
    pub fn noise_curves(&self, alternative: &Surface, range: [f64; 2], points: usize) -> Result<NoiseCurves> {
        let normalised_photons = logarithmic(range, points);
        let mut solver = self.nearest_solver();
        let (own, other) = (&self.target.emissivity, &alternative.emissivity);
        let distance = solver.per_photon(own, other, &self.state, f64::INFINITY)?.distance;
        let roots: Vec<f64> = normalised_photons.iter().map(|n| n.sqrt()).collect();
        let mut curves =
            vec![NoiseCurve { name: "shot noise", gamma: vec![0.0; roots.len()], distance: roots }];
        let camera = self.camera.as_ref().filter(|_| distance > 0.0);
        let noisy = |camera: &&Camera| {
            camera.reading_sigma(&self.bands).is_some_and(|sigma| sigma.iter().any(|&s| s > 0.0))
        };
        if let Some(camera) = camera.filter(noisy) {
            let flicker = camera.flicker_fraction;
            let alone = |share: f64, flicker_fraction: f64| Camera {
                noise: camera.noise_scaled(share.sqrt()),
                flicker_fraction,
                ..camera.clone()
            };
            let signal = self.target_signal();
            for (name, camera) in [
                ("Johnson noise", alone(1.0 - flicker, 0.0)),
                ("flicker noise", alone(flicker, 1.0)),
                ("mixed noise", camera.clone()),
            ] {
                let mut curve = NoiseCurve { name, gamma: Vec::new(), distance: Vec::new() };
                for n in &normalised_photons {
                    let counting = self.counting_with(&camera, n / (distance * distance));
                    curve.gamma.push(gamma_per_band(&counting, &signal));
                    curve.distance.push(solver.with_counting(own, other, &self.state, &counting)?.distance);
                }
                curves.push(curve);
            }
        }
        Ok(NoiseCurves { distance, normalised_photons, curves })
    }
}

#[cfg(test)]
mod tests {
    use crate::Study;
    use hadar::material::Library;
    use hadar_scenario::{Scenario, examples};

    /// At the camera's own photons the curve of all its noise is the distance that `identify` finds by another way; Johnson and
    /// flicker noise have half of its γ each there, and at four times the exposure one and four times as much.
    #[test]
    fn the_curves_meet_the_camera_where_it_is() {
        let study = Study::new(
            &Scenario::from_toml(examples::HUMAN_VS_ROBOT, None).unwrap(),
            &Library::embedded().unwrap(),
        )
        .unwrap();
        let pair = &study.identify().unwrap().pairs[0];
        let photons = study.counting().unwrap().counts_per_radiance * study.photon_radiance();
        let own = photons * pair.distance_nearest.powi(2);
        let found = study.noise_curves(&study.alternatives()[0], [own, 4.0 * own], 2).unwrap();
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
        let [shot, johnson, flicker, mixed] = found.curves.as_slice() else { panic!("four curves") };
        near(shot.distance[0], own.sqrt());
        near(mixed.distance[0], pair.statistical_distance.unwrap());
        near(johnson.gamma[0], 0.5 * mixed.gamma[0]);
        near(flicker.gamma[0], 0.5 * mixed.gamma[0]);
        near(johnson.gamma[1], johnson.gamma[0]);
        near(flicker.gamma[1], 4.0 * flicker.gamma[0]);
    }
}
