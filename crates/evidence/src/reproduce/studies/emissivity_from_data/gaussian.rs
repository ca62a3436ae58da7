//! Temperature and emissivity where the emissivity is drawn from a Gaussian prior.
//!
//! With e = m + A z the radiance of temperature T is normal about m B + (1 − m) X with covariance C = diag(σ²) + D A Aᵀ D, D = B − X.
//! T is where −2 ln of its density, rᵀC⁻¹r + ln det C, is least; then e is the mean of the posterior. Both come from
//! M = 1 + AᵀD diag(σ⁻²) D A = L Lᵀ: rᵀC⁻¹r = Σ r²/σ² − ‖L⁻¹AᵀD r/σ²‖², ln det C = Σ ln σ² + ln det M (Woodbury).
//!
//! With a smooth prior ([`EmissivityPrior::smooth`]) this is what smoothness can tell, with that of other spectra
//! ([`EmissivityPrior::of_spectra`]) what their principal components do.

use hadar::fisher::emissivity::EmissivityPrior;
use hadar::minimum::golden_section;
use hadar::planck;
use hadar_estimate::separation::{Separated, Surface};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Steps between the temperatures that are looked at first, K.
const STEP_K: f64 = 2.0;

/// Temperature of the most probable radiances between two temperatures (K), and the mean emissivities that belong to it; `None` where
/// no temperature has a probability.
#[must_use]
pub(crate) fn gaussian(
    surface: &Surface<'_>,
    prior: &EmissivityPrior,
    range_k: [f64; 2],
) -> Option<Separated> {
    let count = ((range_k[1] - range_k[0]) / STEP_K).ceil().max(2.0) as usize;
    let at = |i: usize| range_k[0] + (range_k[1] - range_k[0]) * i as f64 / count as f64;
    let cost = |t: f64| Look::at(surface, prior, t).map_or(f64::INFINITY, |look| look.cost);
    let first = (0..=count).map(|i| (i, cost(at(i))));
    let (best, least) = first.fold((0, f64::INFINITY), |best, one| if one.1 < best.1 { one } else { best });
    if !least.is_finite() {
        return None;
    }
    let bracket = [at(best.saturating_sub(1)), at((best + 1).min(count))];
    let [low, high] =
        golden_section::<std::convert::Infallible>(bracket, 22, |t| Ok(cost(t))).unwrap_or(bracket);
    let temperature_k = 0.5 * (low + high);
    Some(Separated::new(temperature_k, Look::at(surface, prior, temperature_k)?.emissivity(prior)))
}

/// What one temperature makes of the radiances.
struct Look {
    cost: f64,
    factor: Cholesky<f64, Dyn>,
    /// AᵀD r/σ².
    along: DVector<f64>,
}

impl Look {
    fn at(surface: &Surface<'_>, prior: &EmissivityPrior, temperature_k: f64) -> Option<Self> {
        let bands = surface.wavenumbers_cm1.len();
        let mut black = vec![0.0; bands];
        planck::photon_radiance_into(surface.wavenumbers_cm1, temperature_k, &mut black);
        let (a, mean) = (prior.factor(), prior.mean());
        let mut scaled = DMatrix::zeros(bands, a.ncols());
        let mut rest = DVector::zeros(bands);
        for w in 0..bands {
            let apart = (black[w] - surface.light[w]) / surface.sigma[w];
            for k in 0..a.ncols() {
                scaled[(w, k)] = apart * a[(w, k)];
            }
            rest[w] = (surface.radiance[w] - surface.light[w]) / surface.sigma[w] - mean[w] * apart;
        }
        let mut own = scaled.tr_mul(&scaled);
        (0..a.ncols()).for_each(|k| own[(k, k)] += 1.0);
        let factor = Cholesky::new(own)?;
        let along = scaled.tr_mul(&rest);
        let image = factor.l_dirty().solve_lower_triangular(&along)?;
        let cost = rest.norm_squared() - image.norm_squared()
            + 2.0 * (0..a.ncols()).map(|k| libm::log(factor.l_dirty()[(k, k)])).sum::<f64>();
        Some(Self { cost, factor, along })
    }

    fn emissivity(&self, prior: &EmissivityPrior) -> Vec<f64> {
        prior.at(self.factor.solve(&self.along).as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::fisher::emissivity::{Seen, Separation, Smoothness};
    use hadar::random::generator;
    use hadar_estimate::calibrate::twin::normal;

    /// Emissivities drawn from the prior: the mean square error is that of the posterior, and not below the bound averaged over the
    /// prior. 600 draws know their rms to 3 %: five of these deviations.
    #[test]
    fn the_estimate_reaches_the_bound_averaged_over_the_prior() {
        let nu: Vec<f64> = (0..25).map(|i| 770.0 + 20.0 * f64::from(i)).collect();
        let light: Vec<f64> = nu
            .iter()
            .map(|nu| (0.5 + 0.45 * (nu / 7.0).sin()) * planck::photon_radiance(*nu, 285.0))
            .collect();
        let known = Smoothness { mean: 0.8, magnitude: 0.05, shape: 0.03, correlation_cm1: 60.0 };
        let prior = EmissivityPrior::smooth(&nu, known).unwrap();
        let (mut black, mut slope) = (vec![0.0; 25], vec![0.0; 25]);
        planck::photon_radiance_and_slope_into(&nu, 303.0, &mut black, &mut slope);
        let sigma: Vec<f64> = slope.iter().map(|slope| 0.05 * slope).collect();
        let seen = Seen { blackbody: &black, slope: &slope, light: &light, sigma: &sigma };
        let bound = Separation::averaged(&prior, &seen).unwrap();
        let mut random = generator(11, 0);
        let mut draw = || normal(&mut random);
        let (mut over, mut square, mut error) = (0.0, 0.0, 0.0);
        let draws = 600;
        for _ in 0..draws {
            let e = prior.at(&(0..prior.unknowns()).map(|_| draw()).collect::<Vec<_>>());
            let y: Vec<f64> =
                (0..25).map(|w| e[w] * black[w] + (1.0 - e[w]) * light[w] + sigma[w] * draw()).collect();
            let surface = Surface { wavenumbers_cm1: &nu, radiance: &y, light: &light, sigma: &sigma };
            let found = gaussian(&surface, &prior, [280.0, 330.0]).unwrap();
            let off = found.temperature_k - 303.0;
            let own = Separation::at(&prior, &e, &seen).unwrap();
            over += (off / own.sigma_temperature_k).powi(2);
            square += off * off;
            error += e.iter().zip(&found.emissivity).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / 25.0;
        }
        let of = |sum: f64| (sum / f64::from(draws)).sqrt();
        assert!((of(over) - 1.0).abs() < 0.15, "{}", of(over));
        let ratio = of(square) / bound.sigma_temperature_k;
        assert!((0.86..1.2).contains(&ratio), "{ratio}");
        let ratio = of(error) / bound.emissivity_rms();
        assert!((0.86..1.2).contains(&ratio), "{ratio}");
    }
}
