//! A setting that owns what it tells, and the same with a cause put into it.
//!
//! What [`super::cause`] does to first order is done here as it is: spectra are read at shifted wavenumbers, a blackbody at another
//! temperature, air of another length by Lambert's law.

use super::cause::Cause;
use super::setting::{Light, Path, Setting};
use hadar::error::{Error, Result};
use hadar::planck::photon_radiance_into;
use hadar::spectrum::Bands;

/// A [`Setting`] of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// The bands of the cube.
    pub bands: Bands,
    /// Emissivities of the library at the nodes of the bands.
    pub library: Vec<Vec<f64>>,
    /// Spectra of the surroundings.
    pub surroundings: Vec<Light>,
    /// Counts for each unit of band signal, of each band, m² sr s.
    pub counts_per_radiance: Vec<f64>,
    /// Variance of electronic noise of each band, counts².
    pub var_added: Vec<f64>,
    /// What one count is in the unit of the cube's samples.
    pub units_per_count: f64,
    /// Temperatures that a target may have, K.
    pub temperature_k: [f64; 2],
    /// ΣVₖ where it is known.
    pub lighting_total: Option<f64>,
    /// Whether the scale of the counts of each pixel is unknown.
    pub gain: bool,
    /// Bands that are left out.
    pub bad_bands: Vec<usize>,
    /// The air before the camera.
    pub path: Option<Path>,
    /// Light that all surfaces scatter besides; empty for none.
    pub light_besides: Vec<f64>,
}

impl Told {
    /// What a setting tells.
    #[must_use]
    pub fn of(setting: &Setting<'_>) -> Self {
        Self {
            bands: setting.bands.clone(),
            library: setting.library.to_vec(),
            surroundings: setting.surroundings.to_vec(),
            counts_per_radiance: setting.counts_per_radiance.to_vec(),
            var_added: setting.var_added.to_vec(),
            units_per_count: setting.units_per_count,
            temperature_k: setting.temperature_k,
            lighting_total: setting.lighting_total,
            gain: setting.gain,
            bad_bands: setting.bad_bands.to_vec(),
            path: setting.path.cloned(),
            light_besides: setting.light_besides.to_vec(),
        }
    }

    /// The setting.
    #[must_use]
    pub fn setting(&self) -> Setting<'_> {
        Setting {
            bands: &self.bands,
            library: &self.library,
            surroundings: &self.surroundings,
            counts_per_radiance: &self.counts_per_radiance,
            var_added: &self.var_added,
            units_per_count: self.units_per_count,
            temperature_k: self.temperature_k,
            lighting_total: self.lighting_total,
            gain: self.gain,
            bad_bands: &self.bad_bands,
            path: self.path.as_ref(),
            light_besides: &self.light_besides,
        }
    }

    /// The same where a cause is by an amount otherwise than told.
    ///
    /// # Errors
    /// An amount with which the setting is impossible: a gain of 0, a light below 0, a temperature of 0 K.
    pub fn with(&self, cause: &Cause, amount: f64) -> Result<Self> {
        let mut told = self.clone();
        let factor = 1.0 + amount;
        let is_possible = amount.is_finite() && (factor > 0.0 || !cause.is_share());
        if !is_possible {
            return Err(impossible(cause, amount));
        }
        let nodes = self.bands.nodes_cm1();
        match cause {
            Cause::Gain => told.counts_per_radiance.iter_mut().for_each(|k| *k *= factor),
            Cause::Band(band) => {
                told.counts_per_radiance.iter_mut().skip(*band).take(1).for_each(|k| *k *= factor)
            }
            Cause::WavelengthShift(spectra) => {
                told.bands = self.bands.shifted(amount)?;
                let nodes = told.bands.nodes_cm1();
                told.library = spectra.library.iter().map(|e| spectra.at(e, nodes)).collect();
                let lights = told.surroundings.iter_mut().zip(&spectra.surroundings);
                for (light, values) in lights {
                    if let Light::Radiance(radiance) = light {
                        *radiance = spectra.at(values, nodes);
                    }
                }
                told.path = spectra.path.as_ref().map(|path| Path {
                    transmittance: spectra.at(&path.transmittance, nodes),
                    radiance: spectra.at(&path.radiance, nodes),
                });
            }
            Cause::LightScale(light) => told.light(*light, |_| factor),
            Cause::LightShape { light, order } => {
                let shape = legendre(*order, nodes);
                told.light(*light, |i| 1.0 + amount * shape[i]);
            }
            Cause::LightPath { light, emissivity } => {
                told.light(*light, |i| emissivity.get(i).map_or(1.0, |e| longer(*e, factor)));
            }
            Cause::LightTemperature { light, temperature_k } => {
                let other_k = temperature_k + amount;
                if other_k <= 0.0 {
                    return Err(impossible(cause, amount));
                }
                let [mut own, mut other] = [vec![0.0; nodes.len()], vec![0.0; nodes.len()]];
                photon_radiance_into(nodes, *temperature_k, &mut own);
                photon_radiance_into(nodes, other_k, &mut other);
                told.light(*light, |i| if own[i] > 0.0 { other[i] / own[i] } else { 1.0 });
            }
            Cause::LightingTotal => {
                told.lighting_total = self.lighting_total.map(|total| (total + amount).clamp(0.0, 1.0))
            }
            Cause::LightMissing { temperature_k } => {
                let mut radiance = vec![0.0; nodes.len()];
                photon_radiance_into(nodes, *temperature_k, &mut radiance);
                told.light_besides.resize(nodes.len(), 0.0);
                let each = told.light_besides.iter_mut().zip(&radiance);
                each.for_each(|(s, b)| *s = amount.mul_add(*b, *s));
            }
            Cause::Air { depth_per_m, temperature_k } => {
                let mut radiance = vec![0.0; nodes.len()];
                photon_radiance_into(nodes, *temperature_k, &mut radiance);
                let before =
                    || Path { transmittance: vec![1.0; nodes.len()], radiance: vec![0.0; nodes.len()] };
                let mut path = told.path.take().unwrap_or_else(before);
                for i in 0..nodes.len() {
                    let share = (-depth_per_m[i] * amount).exp();
                    path.transmittance[i] = (path.transmittance[i] * share).min(1.0);
                    path.radiance[i] = (radiance[i] + share * (path.radiance[i] - radiance[i])).max(0.0);
                }
                told.path = Some(path);
            }
        }
        Ok(told)
    }

    /// The same with noise of so many times the deviation: counts that are as much fewer as their variance is larger.
    #[must_use]
    pub fn with_noise(mut self, factor: f64) -> Self {
        let var = factor * factor;
        self.units_per_count *= var;
        let kappa = self.counts_per_radiance.iter_mut().chain(&mut self.var_added);
        kappa.for_each(|one| *one /= var);
        for light in &mut self.surroundings {
            if let Light::Counts(counts) = light {
                counts.iter_mut().for_each(|n| *n /= var);
            }
        }
        self
    }

    /// A light with a factor at each node.
    fn light(&mut self, light: usize, factor: impl Fn(usize) -> f64) {
        let factors: Vec<f64> = (0..self.bands.nodes_cm1().len()).map(|i| factor(i).max(0.0)).collect();
        match self.surroundings.get_mut(light) {
            Some(Light::Radiance(radiance)) => radiance.iter_mut().zip(&factors).for_each(|(s, x)| *s *= x),
            // Of bands, not of nodes.
            Some(Light::Counts(counts)) => {
                let means = self.bands.weigh(&factors);
                let each = counts.iter_mut().zip(means.iter().zip(self.bands.widths_cm1()));
                each.for_each(|(n, (sum, width))| *n *= sum / width);
            }
            None => {}
        }
    }
}

fn impossible(cause: &Cause, amount: f64) -> Error {
    Error::malformed(
        format!("{cause:?} by {amount}, with which nothing can be seen"),
        "state a smaller deviation",
    )
}

/// By what share air of emissivity ε sends more over a path so many times as long.
fn longer(emissivity: f64, times: f64) -> f64 {
    -libm::expm1(times * libm::log1p(-emissivity)) / emissivity
}

/// Slope of [`longer`] along the length, at 1.
pub(super) fn longer_slope(emissivity: f64) -> f64 {
    -(1.0 - emissivity) * libm::log1p(-emissivity) / emissivity
}

/// Legendre's polynomial of an order from 0 to 3 over the range of some wavenumbers.
pub(super) fn legendre(order: usize, nu: &[f64]) -> Vec<f64> {
    let low = nu.iter().copied().fold(f64::INFINITY, f64::min);
    let high = nu.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let half = 0.5 * (high - low);
    let at = |nu: &f64| if half > 0.0 { (nu - low) / half - 1.0 } else { 0.0 };
    nu.iter()
        .map(at)
        .map(|x| match order {
            0 => 1.0,
            1 => x,
            2 => 1.5 * x * x - 0.5,
            _ => x * (2.5 * x * x - 1.5),
        })
        .collect()
}
