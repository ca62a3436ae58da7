//! The temperature at which the emissivity is smoothest.
//!
//! A wrong temperature puts the lines of the scattered light into e(T) = (y − X)/(B(T) − X). The roughness Σ (e_w − mean of the
//! three around)² over the bands is least where they are gone. Each is taken in units of its noise, σ/(B − X), so that a band without
//! contrast does not count and a high temperature, which makes all emissivities small, is none the smoother for it.
//!
//! Sources: Borel, Int. Geosci. Remote Sens. Symp. 1998, 546 (ISSTES); Borel, Proc. SPIE 5425, 165 (2004) (ARTEMISS); as maximum
//! likelihood of second differences with the noise of each.

use hadar::minimum::golden_section;
use hadar::planck;
use hadar_estimate::separation::{Separated, Surface};

/// Steps between the temperatures that are looked at first, K.
const STEP_K: f64 = 0.5;

/// Temperature and emissivities where the latter are smoothest, between two temperatures (K).
#[must_use]
pub(crate) fn smoothest(surface: &Surface<'_>, range_k: [f64; 2]) -> Separated {
    let count = ((range_k[1] - range_k[0]) / STEP_K).ceil().max(2.0) as usize;
    let at = |i: usize| range_k[0] + (range_k[1] - range_k[0]) * i as f64 / count as f64;
    let first = (0..=count).map(|i| (i, roughness(surface, at(i))));
    let best = first.fold((0, f64::INFINITY), |best, one| if one.1 < best.1 { one } else { best }).0;
    let bracket = [at(best.saturating_sub(1)), at((best + 1).min(count))];
    let found = golden_section::<std::convert::Infallible>(bracket, 30, |t| Ok(roughness(surface, t)));
    let [low, high] = found.unwrap_or(bracket);
    let temperature_k = 0.5 * (low + high);
    Separated::new(temperature_k, surface.emissivity_at(temperature_k))
}

/// Sum over the bands of the squares of second differences, in units of their noise.
fn roughness(surface: &Surface<'_>, temperature_k: f64) -> f64 {
    let mut black = vec![0.0; surface.wavenumbers_cm1.len()];
    planck::photon_radiance_into(surface.wavenumbers_cm1, temperature_k, &mut black);
    // e and its variance.
    let each: Vec<(f64, f64)> = (0..black.len())
        .map(|w| {
            let apart = black[w] - surface.light[w];
            ((surface.radiance[w] - surface.light[w]) / apart, (surface.sigma[w] / apart).powi(2))
        })
        .collect();
    let mut sum = 0.0;
    for three in each.windows(3) {
        let [(a, va), (b, vb), (c, vc)] = [three[0], three[1], three[2]];
        let off = b - (a + b + c) / 3.0;
        let weight = 1.0 / (va + 4.0 * vb + vc);
        if weight.is_finite() && off.is_finite() {
            sum += weight * off * off;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines in the light and a smooth emissivity: the temperature comes back, but for what is left of the emissivity's own shape.
    #[test]
    fn lines_tell_the_temperature() {
        let nu: Vec<f64> = (0..97).map(|i| 770.0 + 5.0 * f64::from(i)).collect();
        let light: Vec<f64> = nu
            .iter()
            .map(|nu| (0.4 + 0.3 * (nu / 4.0).sin()) * planck::photon_radiance(*nu, 280.0))
            .collect();
        let e: Vec<f64> = nu.iter().map(|nu| 0.93 + 0.04 * (nu / 120.0).sin()).collect();
        let y: Vec<f64> =
            (0..97).map(|w| e[w] * planck::photon_radiance(nu[w], 301.3) + (1.0 - e[w]) * light[w]).collect();
        let surface = Surface { wavenumbers_cm1: &nu, radiance: &y, light: &light, sigma: &vec![1e14; 97] };
        let found = smoothest(&surface, [270.0, 330.0]);
        assert!((found.temperature_k - 301.3).abs() < 0.05, "{}", found.temperature_k);
        assert!(found.emissivity.iter().zip(&e).all(|(a, b)| (a - b).abs() < 2e-3));
    }
}
