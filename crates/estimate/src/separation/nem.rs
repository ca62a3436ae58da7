//! Normalised emissivity method, and ratios: the first two modules of TES.
//!
//! NEM: the emissivity e_w = (y_w − X_w)/(B_w(T) − X_w) of the true temperature is largest ε_max in some band. Gillespie's iteration
//! (subtract (1 − e)X, take the hottest brightness temperature at ε_max, find e again) ends where max e = ε_max. That T is computed at
//! once: every band has a temperature T_w at which its own e is ε_max, B_w(T_w) = X_w + (y_w − X_w)/ε_max; the surface has the
//! highest of them where it sends more than it is lit by, the lowest where it sends less.
//!
//! RATIO: β_w = e_w/mean(e), which an error of T changes little.
//!
//! Only bands that differ from their light by [`TELLING`] deviations have a say in T. A pixel where none does is in equilibrium with
//! what is around it, one whose bands are on both sides of it so that some e leaves [0, 1] by more than its error has no T: both
//! are declared.
//!
//! Source: Gillespie et al., IEEE Trans. Geosci. Remote Sens. 36, 1113 (1998), doi:10.1109/36.700995, sections III A and B.

use hadar::planck;

/// Deviations by which a band must differ from its light to tell a temperature.
const TELLING: f64 = 5.0;
/// Deviations by which an emissivity may leave [0, 1].
const BEYOND: f64 = 5.0;

/// What is seen of a surface, one value for each band; radiances in photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
#[derive(Debug, Clone, Copy)]
pub struct Surface<'a> {
    /// Wavenumbers, cm⁻¹.
    pub wavenumbers_cm1: &'a [f64],
    /// y, what it sends.
    pub radiance: &'a [f64],
    /// X, what it is lit by.
    pub light: &'a [f64],
    /// σ, deviations of y.
    pub sigma: &'a [f64],
}

/// A temperature and the emissivities that belong to it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Separated {
    /// K.
    pub temperature_k: f64,
    /// One for each band; NaN where a band is in equilibrium with its light.
    pub emissivity: Vec<f64>,
}

impl Separated {
    /// Temperature in K and emissivities, as another method finds them.
    #[must_use]
    pub fn new(temperature_k: f64, emissivity: Vec<f64>) -> Self {
        Self { temperature_k, emissivity }
    }
}

impl Surface<'_> {
    /// The emissivities that belong to a temperature.
    #[must_use]
    pub fn emissivity_at(&self, temperature_k: f64) -> Vec<f64> {
        let mut black = vec![0.0; self.wavenumbers_cm1.len()];
        planck::photon_radiance_into(self.wavenumbers_cm1, temperature_k, &mut black);
        let each = black.iter().zip(self.radiance.iter().zip(self.light));
        each.map(|(b, (y, x))| if b == x { f64::NAN } else { (y - x) / (b - x) }).collect()
    }

    /// Σ of (y − X)/σ over the bands that tell, and whether there are any.
    fn contrast(&self) -> Option<f64> {
        let each = self.radiance.iter().zip(self.light.iter().zip(self.sigma));
        let telling = each.map(|(y, (x, sigma))| (y - x) / sigma).filter(|off| off.abs() > TELLING);
        telling.fold(None, |sum: Option<f64>, off| Some(sum.unwrap_or(0.0) + off))
    }
}

/// Temperature and emissivities of a surface whose largest emissivity is `max_emissivity`; `None` where that is impossible, or where
/// it sends what it is lit by.
///
/// ```
/// use hadar::planck::photon_radiance;
/// use hadar_estimate::separation::{Surface, nem};
/// let nu = [800.0, 1000.0, 1200.0];
/// let (light, e) = (nu.map(|nu| 0.3 * photon_radiance(nu, 280.0)), [0.97, 0.90, 0.96]);
/// let y: Vec<f64> = (0..3).map(|w| e[w] * photon_radiance(nu[w], 305.0) + (1.0 - e[w]) * light[w]).collect();
/// let surface = Surface { wavenumbers_cm1: &nu, radiance: &y, light: &light, sigma: &[1e15; 3] };
/// let found = nem(&surface, 0.97).unwrap();
/// assert!((found.temperature_k - 305.0).abs() < 1e-9 && (found.emissivity[1] - 0.90).abs() < 1e-12);
/// ```
#[must_use]
pub fn nem(surface: &Surface<'_>, max_emissivity: f64) -> Option<Separated> {
    let sends_more = surface.contrast()? > 0.0;
    let mut best: Option<f64> = None;
    for (w, nu) in surface.wavenumbers_cm1.iter().enumerate() {
        let (y, x) = (surface.radiance[w], surface.light[w]);
        let off = (y - x) / surface.sigma[w];
        if (off > 0.0) != sends_more || off.abs() <= TELLING {
            continue;
        }
        let black = x + (y - x) / max_emissivity;
        if black <= 0.0 {
            return None;
        }
        let own = planck::brightness_temperature(*nu, black);
        best = Some(best.map_or(own, |best| if sends_more { best.max(own) } else { best.min(own) }));
    }
    let temperature_k = best.filter(|t| t.is_finite() && *t > 0.0)?;
    let emissivity = surface.emissivity_at(temperature_k);
    let mut black = vec![0.0; emissivity.len()];
    planck::photon_radiance_into(surface.wavenumbers_cm1, temperature_k, &mut black);
    let possible = emissivity.iter().enumerate().all(|(w, e)| {
        let error = BEYOND * surface.sigma[w] / (black[w] - surface.light[w]).abs();
        e.is_nan() || (*e >= -error && *e <= 1.0 + error)
    });
    possible.then_some(Separated { temperature_k, emissivity })
}

/// β: emissivities over their mean; bands without one stay NaN.
#[must_use]
pub fn ratio(emissivity: &[f64]) -> Vec<f64> {
    let known = || emissivity.iter().filter(|e| e.is_finite());
    let mean = known().sum::<f64>() / known().count() as f64;
    emissivity.iter().map(|e| e / mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const NU: [f64; 5] = [780.0, 860.0, 950.0, 1060.0, 1190.0];

    fn sent(e: &[f64; 5], temperature_k: f64, light: &[f64; 5]) -> [f64; 5] {
        let mut y = [0.0; 5];
        for w in 0..5 {
            y[w] = e[w] * planck::photon_radiance(NU[w], temperature_k) + (1.0 - e[w]) * light[w];
        }
        y
    }

    fn surface<'a>(y: &'a [f64; 5], light: &'a [f64; 5]) -> Surface<'a> {
        Surface { wavenumbers_cm1: &NU, radiance: y, light, sigma: &[1e14; 5] }
    }

    /// Gillespie's iteration as he has it ends where this begins.
    #[test]
    fn the_end_of_the_iteration_is_found_at_once() {
        let light = NU.map(|nu| 0.4 * planck::photon_radiance(nu, 285.0));
        let y = sent(&[0.93, 0.84, 0.70, 0.90, 0.95], 312.0, &light);
        let found = nem(&surface(&y, &light), 0.99).unwrap();
        let mut e = [0.99; 5];
        let mut t = 0.0;
        for _ in 0..200 {
            let own: Vec<f64> = (0..5).map(|w| y[w] - (1.0 - e[w]) * light[w]).collect();
            t = (0..5).map(|w| planck::brightness_temperature(NU[w], own[w] / 0.99)).fold(0.0, f64::max);
            for w in 0..5 {
                e[w] = own[w] / planck::photon_radiance(NU[w], t);
            }
        }
        assert!((found.temperature_k - t).abs() < 1e-6, "{} {t}", found.temperature_k);
        assert!(found.emissivity.iter().zip(e).all(|(a, b)| (a - b).abs() < 1e-8));
        assert!((found.emissivity.iter().copied().fold(0.0, f64::max) - 0.99).abs() < 1e-12);
    }

    /// A grey body at ε_max, warmer than its surroundings or colder, has its own temperature and emissivity.
    #[test]
    fn a_grey_body_at_the_largest_emissivity_is_exact() {
        let light = NU.map(|nu| 0.9 * planck::photon_radiance(nu, 290.0));
        for t in [240.0, 270.0, 300.0, 340.0] {
            let y = sent(&[0.98; 5], t, &light);
            let found = nem(&surface(&y, &light), 0.98).unwrap();
            assert!((found.temperature_k - t).abs() < 1e-9, "{t}");
            assert!(found.emissivity.iter().all(|e| (e - 0.98).abs() < 1e-9));
        }
        // What is lit as it sends is declared.
        let y = sent(&[0.98; 5], 300.0, &NU.map(|nu| planck::photon_radiance(nu, 300.0)));
        assert!(nem(&surface(&y, &NU.map(|nu| planck::photon_radiance(nu, 300.0))), 0.98).is_none());
    }

    /// β hardly changes where a wrong ε_max shifts the temperature: by less than a tenth of what the emissivity does.
    #[test]
    fn ratios_do_not_hang_on_the_temperature() {
        let light = [0.0; 5];
        let e = [0.93, 0.84, 0.70, 0.90, 0.95];
        let y = sent(&e, 305.0, &light);
        let (truth, off) = (ratio(&e), nem(&surface(&y, &light), 0.99).unwrap());
        let scale = off.emissivity[4] / e[4] - 1.0;
        assert!(scale > 0.04 && (off.temperature_k - 305.0).abs() > 1.5);
        for (a, b) in ratio(&off.emissivity).iter().zip(&truth) {
            assert!((a / b - 1.0).abs() < 0.4 * scale, "{a} {b}");
        }
        let mean = truth.iter().sum::<f64>() / 5.0;
        assert!((mean - 1.0).abs() < 1e-15);
    }
}
