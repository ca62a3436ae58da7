//! What the samples of a cube are in counts.
//!
//! Of counts by photon radiance k, a band of width Δν has k/Δν for each of ∫L dν; of radiances (in any unit, a band at its centre) a count is so small that
//! the stated noise alone counts, u = min σ²/(10⁶ max L_E), and σ²/u² is its variance. A camera counts by its own figures.
//!
//! Units: photons s⁻¹ m⁻² sr⁻¹ for radiances; u in the unit of the cube.

use super::said::Said;
use hadar::error::{Error, Result};
use hadar::instrument::{Camera, View};
use hadar::radiance_unit::RadianceUnit;
use hadar::spectrum::Bands;
use hadar::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S};
use hadar_scenario::decompose::CubeUnit;

/// Counts that stand for a squared deviation of a stated noise: so many that shot noise adds nothing to it.
const PER_VARIANCE: f64 = 1e6;

/// What the samples of a cube are in counts.
pub(super) struct Scale {
    pub(super) counts_per_radiance: Vec<f64>,
    pub(super) var_added: Vec<f64>,
    pub(super) units_per_count: f64,
}

impl Said<'_> {
    /// What a sample is. `added` is the variance of its noise in the unit of the cube, `most` what can be sent in each band.
    pub(super) fn scale(
        &self,
        (bands, bad_bands): (&Bands, &[usize]),
        centres_cm1: &[f64],
        added: &[f64],
        most: &[f64],
        of_samples: Option<RadianceUnit>,
        camera: Option<&Camera>,
    ) -> Result<Scale> {
        let widths = bands.widths_cm1();
        Ok(match &self.cube.unit {
            CubeUnit::CountsPerPhotonRadiance(counts) => Scale {
                counts_per_radiance: widths.iter().map(|width| counts / width).collect(),
                var_added: added.to_vec(),
                units_per_count: 1.0,
            },
            CubeUnit::Radiance { .. } | CubeUnit::BrightnessTemperature { .. } => {
                let own = match &self.cube.unit {
                    CubeUnit::Radiance { unit, .. } => *unit,
                    _ => RadianceUnit::PER_WAVENUMBER,
                };
                let unit = of_samples.unwrap_or(own);
                // A variance so much larger than that of the photons that the noise alone counts.
                // What is left out is worth nothing, whether it is a band of the file or not.
                let used = |(band, value): (usize, f64)| (!bad_bands.contains(&band)).then_some(value);
                let least = added.iter().copied().enumerate().filter_map(used).fold(f64::INFINITY, f64::min);
                let joules =
                    |nu: &f64| PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * nu / unit.watts_per_cm1(*nu);
                let of_bands = || centres_cm1.iter().zip(&widths);
                // Of what surfaces and lights can send, not of what the cube holds: no sample changes what another one is worth.
                let largest = of_bands().zip(most).map(|((nu, width), sum)| joules(nu) * sum / width);
                let largest = largest.enumerate().filter_map(used).fold(least.sqrt(), f64::max);
                let units_per_count = least / (PER_VARIANCE * largest);
                Scale {
                    counts_per_radiance: of_bands()
                        .map(|(nu, width)| joules(nu) / (units_per_count * width))
                        .collect(),
                    var_added: added.iter().map(|var| var / units_per_count / units_per_count).collect(),
                    units_per_count,
                }
            }
            CubeUnit::Camera => {
                let Some(camera) = camera else {
                    let missing = Error::malformed("the table is missing", "write [camera]");
                    return Err(self.at("camera")(missing));
                };
                let counting = camera.counting(bands, &View::default());
                Scale {
                    counts_per_radiance: vec![counting.counts_per_radiance; bands.len()],
                    var_added: added.iter().enumerate().map(|(w, var)| counting.var_added(w) + var).collect(),
                    units_per_count: 1.0,
                }
            }
        })
    }
}

/// Bands that are left out need no noise of their own: they take the largest of the others.
pub(super) fn noise_of_left_out(var_added: &mut [f64], bad_bands: &[usize]) -> Result<()> {
    let unknown = |(band, var): (usize, &f64)| (var.is_nan() && !bad_bands.contains(&band)).then_some(band);
    if let Some(band) = var_added.iter().enumerate().find_map(unknown) {
        let found = format!("no row for band {band} (in rising wavenumber), which has readings");
        return Err(Error::malformed(found, "give its noise, or name the band in cube.bad_bands"));
    }
    let most = var_added.iter().copied().fold(0.0, f64::max);
    var_added.iter_mut().filter(|var| var.is_nan()).for_each(|var| *var = most);
    Ok(())
}
