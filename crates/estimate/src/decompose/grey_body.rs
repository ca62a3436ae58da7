//! What a thermal camera says that knows nothing: the temperature of the blackbody that sends as much in all bands together.
//!
//! Σ_w n_w/κ_w = Σ_w ∫ B(T) dν over band w, solved for T (K); n_w counts, κ_w counts for each unit of band signal: photons are added up,
//! in whatever unit the cube has them. A real camera asks for an emissivity; 1 is taken, since none is known before the material is.
//! Temperatures are those of any body, and flagged where they are not within the range of the targets. Where a band has less than nothing
//! beyond its noise, or nothing where a hundredth of that blackbody would be seen, there is no temperature.
//!
//! Source: paper, Methods 'HADAR thermography', where the emissivity is a default.

use super::pixel::{Pixel, flag};
use super::setting::Setting;
use hadar::error::Result;
use hadar::planck::{self, Tabulated};
use hadar::spectrum::Bands;

/// Temperatures that are looked at, K.
const RANGE_K: [f64; 2] = [10.0, 1e5];
/// Deviations of the noise beyond which a band is below 0, or a share of the blackbody that any surface sends is seen.
const SEEN: f64 = 5.0;
const LEAST_SHARE: f64 = 1e-2;

/// All bands that count as one.
pub(super) struct GreyBody<'a> {
    bands: &'a Bands,
    /// Bands that count, with κ and the electronic noise of each, counts².
    used: Vec<(usize, f64, f64)>,
    /// What all of them together have of a blackbody.
    together: Tabulated,
    /// Where the temperature of a target may be, K.
    range_k: [f64; 2],
}

impl<'a> GreyBody<'a> {
    pub(super) fn new(setting: &Setting<'a>, used: &[usize]) -> Result<Self> {
        let var = |band: usize| setting.var_added.get(band).copied().unwrap_or(0.0);
        let nodes = setting.bands.nodes_cm1();
        let (mut radiance, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        let together = Tabulated::new(RANGE_K, |t| {
            planck::photon_radiance_and_slope_into(nodes, t, &mut radiance, &mut slope);
            let sum = |at_nodes: &[f64]| {
                let signal = setting.bands.weigh(at_nodes);
                hadar::sum::sum(&used.iter().map(|band| signal[*band]).collect::<Vec<_>>())
            };
            vec![[sum(&radiance), sum(&slope)]]
        })?;
        let used = used.iter().map(|&band| (band, setting.counts_per_radiance[band], var(band))).collect();
        Ok(Self { bands: setting.bands, used, together, range_k: setting.temperature_k })
    }

    /// The temperature of a pixel alone; none where less is sent than by any body.
    pub(super) fn pixel(&self, counts: &[f64]) -> Pixel {
        let total = self.used.iter().zip(counts).map(|((_, kappa, _), n)| n / kappa);
        let temperature_k = self.together.temperature_k(0, hadar::sum::sum(&total.collect::<Vec<_>>()));
        let temperature_k = temperature_k.filter(|t| self.is_a_body(counts, *t));
        let [low, high] = self.range_k;
        Pixel {
            temperature_k: temperature_k.unwrap_or(f64::NAN),
            posterior: f64::NAN,
            flags: match temperature_k {
                None => flag::TEMPERATURE_UNKNOWN,
                Some(t) if !(low..=high).contains(&t) => flag::TEMPERATURE_AT_LIMIT,
                Some(_) => 0,
            },
            ..Pixel::SKIPPED
        }
    }

    /// Whether every band may be a body's beside that blackbody.
    fn is_a_body(&self, counts: &[f64], temperature_k: f64) -> bool {
        // Only what is dark must be looked at.
        if counts.iter().all(|n| *n > 0.0) {
            return true;
        }
        let blackbody = self.blackbody(temperature_k);
        self.used.iter().zip(counts).all(|((band, kappa, var), n)| {
            let least = LEAST_SHARE * kappa * blackbody[*band];
            *n > 0.0 || (-n <= SEEN * var.sqrt() && least <= SEEN * (least + var).sqrt())
        })
    }

    /// Band signals of a blackbody.
    fn blackbody(&self, temperature_k: f64) -> Vec<f64> {
        let nodes = self.bands.nodes_cm1();
        let mut radiance = vec![0.0; nodes.len()];
        planck::photon_radiance_into(nodes, temperature_k, &mut radiance);
        self.bands.weigh(&radiance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grey body of emissivity 0.7 in photons, counts of uneven efficiency and watts: one temperature, that of the sum written out.
    #[test]
    fn the_unit_of_a_cube_does_not_change_its_temperature() {
        let bands = Bands::uniform(750.0, 1250.0, 100.0).unwrap();
        let sent: Vec<f64> = bands.weigh(
            &bands.nodes_cm1().iter().map(|nu| 0.7 * planck::photon_radiance(*nu, 300.0)).collect::<Vec<_>>(),
        );
        let pixel = |kappa: &[f64], var: &[f64], factor: &[f64]| {
            let setting = Setting {
                bands: &bands,
                library: &[],
                surroundings: &[],
                counts_per_radiance: kappa,
                var_added: var,
                units_per_count: 1.0,
                temperature_k: [250.0, 290.0],
                lighting_total: None,
                gain: false,
                bad_bands: &[],
                path: None,
                light_besides: &[],
            };
            let counts: Vec<f64> =
                sent.iter().zip(kappa).zip(factor).map(|((s, k), factor)| s * k * factor).collect();
            GreyBody::new(&setting, &[0, 1, 2, 3, 4, 5]).unwrap().pixel(&counts)
        };
        let watts: Vec<f64> = bands.bands().iter().map(|band| 2e-23 * band.center_cm1).collect();
        let one = [1.0; 6];
        let found = [[1e-15; 6].to_vec(), vec![1e-15, 3e-16, 1e-15, 5e-15, 1e-15, 2e-15], watts]
            .map(|kappa| pixel(&kappa, &[], &one).temperature_k);
        let total: f64 = sent.iter().sum();
        let at = |t: f64| {
            let all = bands.nodes_cm1().iter().map(|nu| 100.0 * planck::photon_radiance(*nu, t));
            all.sum::<f64>() / total
        };
        for t in found {
            assert!((at(t) - 1.0).abs() < 1e-9, "{t}");
        }
        // 283 K is within the range of the targets; all of it, 300 K, is not.
        assert_eq!(pixel(&[1e-15; 6], &[], &one).flags, 0);
        assert_eq!(pixel(&[1e-15; 6], &[], &[1.0 / 0.7; 6]).flags, flag::TEMPERATURE_AT_LIMIT);
        // A band that is dark, or below 0 beyond its noise, is no body's; few counts may be none.
        let dark = [1.0, 1.0, 0.0, 1.0, 1.0, 1.0];
        let below = [1.0, 1.0, -1e-3, 1.0, 1.0, 1.0];
        assert_eq!(pixel(&[1e-15; 6], &[], &dark).flags, flag::TEMPERATURE_UNKNOWN);
        assert_eq!(pixel(&[1e-15; 6], &[], &below).flags, flag::TEMPERATURE_UNKNOWN);
        let few = 10.0 / total;
        assert_eq!(pixel(&[few; 6], &[], &dark).flags & flag::TEMPERATURE_UNKNOWN, 0);
        assert_eq!(pixel(&[few; 6], &[1.0; 6], &below).flags & flag::TEMPERATURE_UNKNOWN, 0);
    }
}
