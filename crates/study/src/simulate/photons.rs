//! Photons of an experiment, and the counts and noise that a camera makes of them.

use super::SimulationPlan;
use crate::size::logarithmic;
use crate::{Study, Surface, Warning};
use hadar::demand::{self, Reason, Thing};
use hadar::error::{Error, Result, check};
use hadar::fisher::Counting;
use hadar::instrument::{Camera, gamma_per_band};
use hadar::planck;
use hadar::policy;
use hadar::statistics::Statistics;
use hadar_simulate::draws::LARGEST_MEAN;

/// Fewest photons of an experiment, and most experiments of a sweep.
const FEWEST: f64 = 1e-9;
const MOST_EXPERIMENTS: usize = 10_000;

impl Study {
    /// The alternatives that are classes: those named, else the one nearest to the target.
    pub(super) fn rivals(&self, against: &[String]) -> Result<Vec<&Surface>> {
        if let ([], [only]) = (against, self.alternatives.as_slice()) {
            demand::spared(Thing::NearestSearches, Reason::NotAsked, 1);
            return Ok(vec![only]);
        }
        if against.is_empty() {
            let ranked = self.nearest_distances(&self.alternatives.iter().collect::<Vec<_>>())?;
            let nearest = self.alternatives.iter().zip(ranked).min_by(|a, b| a.1.total_cmp(&b.1));
            return Ok(nearest.map(|(surface, _)| surface).into_iter().collect());
        }
        let mut found: Vec<&Surface> = Vec::new();
        for name in against {
            let class = self.classes.iter().position(|answer| answer.alternative.name == *name);
            let of_class = class.and_then(|index| self.alternatives.get(index));
            let surface = self.alternative(name).or(of_class).ok_or_else(|| {
                let names: Vec<&str> =
                    self.alternatives.iter().map(|surface| surface.name.as_str()).collect();
                let found = format!("`{name}` is none of the alternatives");
                Error::malformed(found, format!("choose among {}", names.join(", ")))
            })?;
            if !found.iter().any(|known| known.name == surface.name) {
                found.push(surface);
            }
        }
        Ok(found)
    }

    /// Nearest distances per √photon in shot noise.
    fn nearest_distances(&self, surfaces: &[&Surface]) -> Result<Vec<f64>> {
        let distance =
            |surface: &&Surface| self.nearest(surface, f64::INFINITY).map(|nearest| nearest.distance);
        surfaces.iter().map(distance).collect()
    }

    /// Photons of each experiment.
    pub(super) fn photon_numbers(&self, plan: &SimulationPlan, rivals: &[&Surface]) -> Result<Vec<f64>> {
        let numbers = match (plan.photons.as_slice(), self.counting()) {
            ([], Some(counting)) => vec![counting.counts_per_radiance * self.photon_radiance()],
            ([], None) => vec![self.photons_for(rivals)?],
            (given, _) => given.to_vec(),
        };
        for &photons in &numbers {
            check::positive("number of photons", photons, "")?;
            if !(FEWEST..=LARGEST_MEAN).contains(&photons) {
                let expected = format!("between {FEWEST:e} and {LARGEST_MEAN:e}");
                return Err(Error::out_of_range("number of photons", photons, "", expected));
            }
        }
        Ok(numbers)
    }

    /// Photons at which the nearest of the rivals that differs at all is told apart as required.
    fn photons_for(&self, rivals: &[&Surface]) -> Result<f64> {
        let distances = self.nearest_distances(rivals)?;
        let needed =
            distances.iter().filter_map(|distance| policy::photons_required(self.required, *distance));
        let most = needed.fold(0.0, f64::max);
        if most > 0.0 {
            return Ok(most);
        }
        let names: Vec<&str> = rivals.iter().map(|rival| rival.name.as_str()).collect();
        let found =
            format!("no number of photons distinguishes {} from {}", self.target.name, names.join(", "));
        let instead = "change the scene, name other alternatives with --against, or photons with --photons";
        Err(Error::malformed(found, instead).at(self.scenario.place("target")))
    }

    /// Photons at which N d₀² has `experiments` values spread evenly in the logarithm over `normalised`, d₀ the
    /// nearest distance in shot noise to the nearest of the alternatives `against` (of all where empty); N d₀²/(1 + γ)
    /// with the camera's noise, γ that of its own exposure.
    ///
    /// # Errors
    /// An unknown alternative; one that no number of photons tells from the target.
    pub fn sweep(
        &self,
        normalised: [f64; 2],
        experiments: usize,
        against: &[String],
        camera_noise: bool,
    ) -> Result<Vec<f64>> {
        if experiments == 0 || experiments > MOST_EXPERIMENTS {
            let expected = format!("1 to {MOST_EXPERIMENTS}");
            return Err(Error::out_of_range("experiments of a sweep", experiments as f64, "", expected));
        }
        let rivals = self.rivals(against)?;
        let distances = self.nearest_distances(&rivals)?;
        let least = distances.into_iter().fold(f64::INFINITY, f64::min);
        if !(least > 0.0 && least.is_finite()) {
            let found = format!(
                "no number of photons distinguishes {} from the nearest alternative",
                self.target.name
            );
            return Err(Error::malformed(
                found,
                "name another with --against, or --photons instead of a sweep",
            ));
        }
        let gamma = match self.counting().filter(|_| camera_noise) {
            Some(counting) => gamma_per_band(&counting, &self.target_signal()),
            None => 0.0,
        };
        let per_photon = least * least / (1.0 + gamma);
        let photons = logarithmic(normalised, experiments).into_iter().map(|n| n / per_photon);
        Ok(photons.map(|photons| photons.min(LARGEST_MEAN)).collect())
    }

    /// What spoils the image of the scenario's camera, were it exposed for so many photons.
    pub(super) fn image_warnings_at(&self, photons: f64) -> Vec<Warning> {
        let Some(own) = self.camera_result(self.photon_radiance()) else { return Vec::new() };
        let exposed = |camera: &Camera| Camera {
            exposure_s: camera.exposure_s * (photons / own.photons),
            ..camera.clone()
        };
        let study = Self { camera: self.camera.as_ref().map(exposed), ..self.clone() };
        let result = study.camera_result(self.photon_radiance());
        result.map_or_else(Vec::new, |result| study.image_warnings(&result))
    }

    /// Counts and noise when the target sends so many photons: the exposure is made as long as that takes.
    pub(crate) fn counting_at(&self, photons: f64, camera_noise: bool) -> Counting {
        let counts_per_radiance = photons / self.photon_radiance();
        let silent = Counting { counts_per_radiance, var_added: Vec::new() };
        match self.camera.as_ref().filter(|_| camera_noise) {
            Some(camera) => self.counting_with(camera, photons),
            None => silent,
        }
    }

    /// The same with the noise of `camera`.
    pub(crate) fn counting_with(&self, camera: &Camera, photons: f64) -> Counting {
        let counts_per_radiance = photons / self.photon_radiance();
        let second = Camera { exposure_s: 1.0, frames: 1, ..camera.clone() };
        let exposure_s = counts_per_radiance / self.counting_of(&second).counts_per_radiance;
        Counting { counts_per_radiance, ..self.counting_of(&Camera { exposure_s, ..second }) }
    }

    /// The law of thermal light that is bunched in the modes of each band. What is lost on the way is lost at random: it
    /// leaves the number of modes as it is.
    pub(crate) fn bunched(&self, counts_per_radiance: f64) -> Result<Statistics> {
        let efficiency =
            self.camera.as_ref().map_or(1.0, |camera| camera.optics_efficiency * camera.quantum_efficiency);
        let nodes = self.open_bands.nodes_cm1();
        let density: Vec<f64> = nodes.iter().map(|&nu| planck::mode_density(nu)).collect();
        let per_density = counts_per_radiance / efficiency;
        let modes = self.open_bands.weigh(&density).iter().map(|m| per_density * m).collect();
        Statistics::negative_binomial(modes)
    }
}

/// The seed of the experiment with so many photons: experiments of one simulation share no random numbers, and each is
/// the same alone and among others. Nine digits seed: the last bits of a distance, of which a sweep makes its numbers,
/// change no draw. (Odd constant: 2⁶⁴ over the golden ratio, which spreads neighbouring values.)
pub(super) fn seed_of(seed: u64, photons: f64) -> u64 {
    let rounded: f64 = format!("{photons:.8e}").parse().unwrap_or(photons);
    seed.wrapping_add(rounded.to_bits().wrapping_mul(0x9E37_79B9_7F4A_7C15))
}

#[cfg(test)]
mod tests {
    use super::seed_of;

    #[test]
    fn the_last_bits_of_a_number_of_photons_seed_nothing_and_its_digits_do() {
        for photons in [1.0, 5.12e7, 1.234_567_89e9, 9.876_543_211_234_5e5, 1e-3 / 3.0] {
            let seed = seed_of(7, photons);
            assert_eq!(seed, seed_of(7, f64::next_up(photons)), "{photons}");
            assert_eq!(seed, seed_of(7, f64::next_down(photons)), "{photons}");
            assert_ne!(seed, seed_of(7, photons * (1.0 + 1e-8)), "{photons}");
            assert_ne!(seed, seed_of(8, photons), "{photons}");
        }
        // What a person writes seeds as it always did.
        assert_eq!(seed_of(0, 51_200_000.0), 51_200_000.0_f64.to_bits().wrapping_mul(0x9E37_79B9_7F4A_7C15));
    }
}
