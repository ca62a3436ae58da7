//! The third module of TES: the least emissivity from how much the emissivities differ.
//!
//! MMD = max β − min β; e_min = a − b·MMD^c, with which e = β·e_min/min β. The relation is fitted to spectra that are known: c by a
//! search, a and b by least squares. The temperature is then that of the band with the largest e, whose own radiance
//! y − (1 − e)X hangs least on e.
//!
//! Source: Gillespie et al., IEEE Trans. Geosci. Remote Sens. 36, 1113 (1998), doi:10.1109/36.700995, section III C.

use hadar::minimum::golden_section;
use hadar::planck;
use hadar_estimate::separation::{Separated, Surface, nem, ratio};

/// Exponents that are looked at.
const EXPONENTS: [f64; 2] = [0.2, 2.0];
/// Rounds of e and T, which change little after the first ones.
const ROUNDS: usize = 5;

/// e_min = a − b·MMD^c.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mmd {
    /// Least emissivity of a grey body.
    pub(crate) a: f64,
    /// Slope.
    pub(crate) b: f64,
    /// Exponent.
    pub(crate) c: f64,
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().filter(|x| x.is_finite()).fold(f64::INFINITY, f64::min)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().filter(|x| x.is_finite()).fold(f64::NEG_INFINITY, f64::max)
}

impl Mmd {
    /// The relation that spectra have.
    #[must_use]
    pub(crate) fn of_spectra(spectra: &[&[f64]]) -> Self {
        let points: Vec<(f64, f64)> = spectra
            .iter()
            .map(|e| {
                let beta = ratio(e);
                (largest(&beta) - least(&beta), least(e))
            })
            .collect();
        let fit = |c: f64| {
            let count = points.len().max(1) as f64;
            let of = |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / count;
            let (x, y) = (of(&|p| p.0.powf(c)), of(&|p| p.1));
            let square = of(&|p| (p.0.powf(c) - x).powi(2));
            let along = of(&|p| (p.0.powf(c) - x) * (p.1 - y));
            let slope = if square > 0.0 { along / square } else { 0.0 };
            let (a, b) = (y - slope * x, -slope);
            (Self { a, b, c }, of(&|p| (p.1 - a + b * p.0.powf(c)).powi(2)))
        };
        let found = golden_section::<std::convert::Infallible>(EXPONENTS, 40, |c| Ok(fit(c).1));
        let [low, high] = found.unwrap_or(EXPONENTS);
        fit(0.5 * (low + high)).0
    }

    fn least_emissivity(&self, mmd: f64) -> f64 {
        (self.a - self.b * mmd.max(0.0).powf(self.c)).clamp(0.01, 1.0)
    }
}

/// Temperature and emissivities by TES: NEM, ratios, and the relation.
#[must_use]
pub(crate) fn mmd(surface: &Surface<'_>, max_emissivity: f64, relation: &Mmd) -> Option<Separated> {
    let mut found = nem(surface, max_emissivity)?;
    for _ in 0..ROUNDS {
        let beta = ratio(&found.emissivity);
        let low = least(&beta);
        if low <= 0.0 {
            return None;
        }
        let scale = relation.least_emissivity(largest(&beta) - low) / low;
        let e: Vec<f64> = beta.iter().map(|beta| (beta * scale).min(1.0)).collect();
        let band = (0..e.len()).filter(|w| e[*w].is_finite()).max_by(|a, b| e[*a].total_cmp(&e[*b]))?;
        let own = surface.radiance[band] - (1.0 - e[band]) * surface.light[band];
        if own <= 0.0 {
            return None;
        }
        let temperature_k = planck::brightness_temperature(surface.wavenumbers_cm1[band], own / e[band]);
        found = Separated::new(temperature_k, surface.emissivity_at(temperature_k));
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Spectra that obey a relation give it back, and a surface that obeys it its temperature.
    #[test]
    fn what_obeys_a_relation_is_found_by_it() {
        let truth = Mmd { a: 0.994, b: 0.687, c: 0.737 };
        let shape = [0.0, 0.3, 1.0, 0.6, 0.1];
        let spectrum = |depth: f64| {
            let beta = ratio(&shape.map(|s| 1.0 - depth * s));
            let scale = truth.least_emissivity(largest(&beta) - least(&beta)) / least(&beta);
            beta.iter().map(|b| b * scale).collect::<Vec<f64>>()
        };
        let spectra: Vec<Vec<f64>> = (1..12).map(|i| spectrum(0.03 * f64::from(i))).collect();
        let found = Mmd::of_spectra(&spectra.iter().map(Vec::as_slice).collect::<Vec<_>>());
        assert!((found.a - truth.a).abs() < 1e-4 && (found.c - truth.c).abs() < 1e-3, "{found:?}");
        let nu = [780.0, 860.0, 950.0, 1060.0, 1190.0];
        let e = spectrum(0.2);
        let light = nu.map(|nu| 0.25 * planck::photon_radiance(nu, 280.0));
        let y: Vec<f64> =
            (0..5).map(|w| e[w] * planck::photon_radiance(nu[w], 300.0) + (1.0 - e[w]) * light[w]).collect();
        let surface = Surface { wavenumbers_cm1: &nu, radiance: &y, light: &light, sigma: &[1e14; 5] };
        let tes = mmd(&surface, 0.99, &truth).unwrap();
        let alone = nem(&surface, 0.99).unwrap();
        assert!((tes.temperature_k - 300.0).abs() < 0.02, "{}", tes.temperature_k);
        assert!((alone.temperature_k - 300.0).abs() > 0.5);
    }
}
