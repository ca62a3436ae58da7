//! Temperatures that vary over a surface.
//!
//! T(r) = T + σ n(r/size)/n_rms, n smooth noise in [−1, 1]. What the surface emits is e B(ν, T(r)); between the lowest and the highest
//! temperature it is Σⱼ Lⱼ(T(r)) e B(ν, Tⱼ) with Lagrange's polynomials of a few Chebyshev nodes Tⱼ, so that a pixel stays a sum of few
//! spectra. With six nodes and ±30 K about 300 K that errs by 2e-6 of B at 1250 cm⁻¹, and by the sixth power less of smaller ranges.

use super::noise;
use super::vector::Vector;
use hadar::error::{Error, Result, check};

/// Temperatures between which emission is interpolated.
pub(super) const NODES: usize = 6;
/// Furthest from the middle, K.
const WIDEST_K: f64 = 30.0;
/// Points along a side over which the mean emission is taken.
const SIDE: u32 = 24;

/// How a temperature varies over a surface.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Uneven {
    /// Root mean square of the temperature about its mean, K.
    pub sigma_k: f64,
    /// Size of what is warmer or cooler, m.
    pub size_m: f64,
    /// Seed that determines the pattern of the temperature.
    pub seed: u32,
}

impl Uneven {
    /// The furthest from the mean, K.
    fn reach_k(&self) -> f64 {
        self.sigma_k / noise::VALUE_RMS
    }

    pub(super) fn check(&self, mean_k: f64) -> Result<()> {
        check::positive("size of warmer patches", self.size_m, "m")?;
        check::non_negative("deviation of the temperature", self.sigma_k, "K")?;
        if self.reach_k() > WIDEST_K {
            let most = format!("at most {:.0} K", WIDEST_K * noise::VALUE_RMS);
            return Err(Error::out_of_range("deviation of the temperature", self.sigma_k, "K", most));
        }
        check::positive("lowest temperature", mean_k - self.reach_k(), "K").map(drop)
    }

    /// Temperature at a point, K.
    #[inline]
    pub(super) fn temperature_at(&self, mean_k: f64, point: Vector) -> f64 {
        mean_k + self.reach_k() * noise::value(point.map(|x| x / self.size_m), self.seed)
    }

    /// Temperatures whose emission is mixed, K.
    pub(super) fn nodes_k(&self, mean_k: f64) -> [f64; NODES] {
        chebyshev().map(|u| mean_k + self.reach_k() * u)
    }

    /// Shares Lⱼ of their emission at a temperature.
    #[inline]
    pub(super) fn weights(&self, mean_k: f64, temperature_k: f64) -> [f64; NODES] {
        let (nodes, u) = (chebyshev(), (temperature_k - mean_k) / self.reach_k());
        nodes.map(|own| {
            nodes.iter().filter(|node| **node != own).map(|node| (u - node) / (own - node)).product()
        })
    }

    /// The shares in what all of the surface emits.
    pub(super) fn mean_weights(&self, mean_k: f64) -> [f64; NODES] {
        let mut sum = [0.0; NODES];
        for i in 0..SIDE * SIDE * SIDE {
            let at = [i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE].map(|i| f64::from(i) * 0.731 * self.size_m);
            let weights = self.weights(mean_k, self.temperature_at(mean_k, at));
            sum.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight / f64::from(SIDE.pow(3)));
        }
        sum
    }
}

/// Nodes of Chebyshev's polynomial in [−1, 1].
fn chebyshev() -> [f64; NODES] {
    const HALF: [f64; NODES / 2] =
        [0.965_925_826_289_068_3, std::f64::consts::FRAC_1_SQRT_2, 0.258_819_045_102_520_7];
    [-HALF[0], -HALF[1], -HALF[2], HALF[2], HALF[1], HALF[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::planck::photon_radiance;

    fn uneven(sigma_k: f64) -> Uneven {
        Uneven { sigma_k, size_m: 0.3, seed: 4 }
    }

    #[test]
    fn emission_between_the_nodes_is_planck_s() {
        for (sigma_k, tolerance) in [(12.0, 3e-6), (3.0, 1e-9)] {
            let surface = uneven(sigma_k);
            let reach = sigma_k / noise::VALUE_RMS;
            for i in 0..=40 {
                let kelvin = 300.0 + reach * (f64::from(i) / 20.0 - 1.0);
                let mixed: f64 = surface
                    .nodes_k(300.0)
                    .iter()
                    .zip(surface.weights(300.0, kelvin))
                    .map(|(node, weight)| weight * photon_radiance(1250.0, *node))
                    .sum();
                assert!((mixed / photon_radiance(1250.0, kelvin) - 1.0).abs() < tolerance, "{kelvin}");
            }
        }
    }

    #[test]
    fn temperatures_have_the_deviation_they_are_asked_for() {
        let surface = uneven(2.0);
        let n = 40_000;
        let (mut sum, mut square, mut furthest) = (0.0, 0.0, 0.0_f64);
        for i in 0..n {
            let at = [f64::from(i % 200) * 0.237, f64::from(i / 200) * 0.219, 0.41 * f64::from(i)];
            let off = surface.temperature_at(300.0, at) - 300.0;
            (sum, square) = (sum + off, square + off * off);
            furthest = furthest.max(off.abs());
        }
        let (mean, sigma) = (sum / f64::from(n), (square / f64::from(n)).sqrt());
        // Neighbours are alike: some 20 000 of them count, 4 standard errors.
        assert!(mean.abs() < 0.06 && (sigma / 2.0 - 1.0).abs() < 0.02, "{mean} {sigma}");
        assert!(furthest <= 2.0 / noise::VALUE_RMS);
        // In the mean over all of it the second order remains: ½ B″ σ².
        let b = |kelvin| photon_radiance(1000.0, kelvin);
        let mean: f64 = surface
            .nodes_k(300.0)
            .iter()
            .zip(surface.mean_weights(300.0))
            .map(|(node, weight)| weight * b(*node))
            .sum();
        let second = 0.5 * (b(301.0) - 2.0 * b(300.0) + b(299.0)) * 4.0;
        let first = (b(301.0) - b(299.0)) / 2.0;
        // The mean of the noise over the lattice is off by up to 0.02 of its deviation.
        assert!((mean - b(300.0) - second).abs() < 0.04 * first, "{}", (mean - b(300.0)) / second);
    }

    #[test]
    fn impossible_variations_are_errors() {
        for (sigma_k, size_m) in [(-1.0, 0.1), (13.0, 0.1), (f64::NAN, 0.1), (1.0, 0.0)] {
            assert!(Uneven { sigma_k, size_m, seed: 0 }.check(300.0).is_err(), "{sigma_k} {size_m}");
        }
        assert!(Uneven { sigma_k: 5.0, size_m: 0.1, seed: 0 }.check(10.0).is_err());
    }
}
