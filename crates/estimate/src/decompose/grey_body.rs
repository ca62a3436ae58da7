//! What a thermal camera says that knows nothing: the temperature of the blackbody that sends as much in all bands together.
//!
//! Σ_w n_w = Σ_w κ_w ∫ B(T) dν over band w, solved for T (K); n_w counts, κ_w counts for each unit of band signal. A real camera asks for
//! an emissivity; 1 is taken, since none is known before the material is. Temperatures are those of any body, whatever the range of the
//! targets is.
//!
//! Source: paper, Methods 'HADAR thermography', where the emissivity is a default.

use super::pixel::{Pixel, flag};
use super::setting::Setting;
use hadar::planck;
use hadar::root::crossing;
use hadar::spectrum::Bands;

/// Temperatures that are looked at, K.
const RANGE_K: [f64; 2] = [10.0, 1e5];

/// All bands that count as one.
pub(super) struct GreyBody<'a> {
    bands: &'a Bands,
    /// κ of the bands that count, 0 of the others.
    counts_per_radiance: Vec<f64>,
}

impl<'a> GreyBody<'a> {
    pub(super) fn new(setting: &Setting<'a>, used: &[usize]) -> Self {
        let mut counts_per_radiance = vec![0.0; setting.bands.len()];
        for &band in used {
            counts_per_radiance[band] = setting.counts_per_radiance[band];
        }
        Self { bands: setting.bands, counts_per_radiance }
    }

    /// The temperature of a pixel alone; none where less is sent than by any body.
    pub(super) fn pixel(&self, counts: &[f64]) -> Pixel {
        let temperature_k = self.temperature_k(hadar::sum::sum(counts));
        Pixel {
            temperature_k: temperature_k.unwrap_or(f64::NAN),
            posterior: f64::NAN,
            flags: if temperature_k.is_some() { 0 } else { flag::TEMPERATURE_UNKNOWN },
            ..Pixel::SKIPPED
        }
    }

    fn temperature_k(&self, total: f64) -> Option<f64> {
        let wanted = (total > 0.0).then(|| libm::log(total))?;
        // ln ΣB is nearly a straight line over −1/T: a few steps suffice.
        let off = |inverse: f64| Ok(libm::log(self.blackbody(-1.0 / inverse)) - wanted);
        let [low, high] = RANGE_K;
        crossing(-1.0 / low, -1.0 / high, off).ok().map(|inverse| -1.0 / inverse)
    }

    /// Counts of a blackbody in all bands.
    fn blackbody(&self, temperature_k: f64) -> f64 {
        let nodes = self.bands.nodes_cm1();
        let mut radiance = vec![0.0; nodes.len()];
        planck::photon_radiance_into(nodes, temperature_k, &mut radiance);
        hadar::sum::dot(&self.bands.weigh(&radiance), &self.counts_per_radiance)
    }
}
