//! Counts drawn about given means.
//!
//! * Poisson: exact at any mean up to [`LARGEST_MEAN`] (products of uniforms below a mean of 12, rejection from a
//!   normal above); a mean of 0 gives 0.
//! * Gaussian: normal of variance N + σ².
//! * negative binomial: Poisson about a mean that is itself gamma distributed with shape m and mean N: the
//!   intensity of thermal light in m modes.
//!
//! Sources: Ahrens and Dieter, ACM Trans. Math. Softw. 8, 163 (1982), doi:10.1145/355993.355997 (Poisson); Marsaglia and
//! Tsang, ACM Trans. Math. Softw. 26, 363 (2000), doi:10.1145/358407.358414 (gamma); generator: Bernstein, 'ChaCha, a
//! variant of Salsa20' (2008).

use crate::error::{Error, Result, check};
use crate::statistics::Statistics;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, Gamma, Normal, Poisson};

/// What random numbers are made with; the seed then says which ones. A test holds the first draws fast.
pub const GENERATOR: &str =
    "ChaCha8 (rand 0.10, seed_from_u64, one stream per block of trials), rand_distr 0.6.0";

/// Largest mean that can be drawn about.
pub const LARGEST_MEAN: f64 = 1e18;

/// The generator of one block of trials.
#[must_use]
pub fn generator(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(stream);
    rng
}

/// A spectrum to draw counts about.
///
/// ```
/// use hadar::simulate::draws::{Draws, generator};
/// use hadar::statistics::Statistics;
/// let draws = Draws::new(&Statistics::Poisson, &[0.0, 1e6])?;
/// let mut counts = [0.0; 2];
/// draws.draw_into(&mut generator(1, 0), &mut counts);
/// assert!(counts[0] == 0.0 && (counts[1] - 1e6).abs() < 6e3);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Draws {
    bands: Vec<Band>,
}

/// One band's law.
#[derive(Debug, Clone, Copy)]
enum Band {
    Dark,
    Poisson(Poisson<f64>),
    Normal(Normal<f64>),
    Bunched(Gamma<f64>),
}

impl Draws {
    /// Counts about `means`, one of each band.
    ///
    /// # Errors
    /// A mean that is negative, not finite or above [`LARGEST_MEAN`]; statistics for another number of bands.
    pub fn new(statistics: &Statistics, means: &[f64]) -> Result<Self> {
        statistics.check_bands(means.len())?;
        let bands = means.iter().enumerate().map(|(band, &mean)| Band::new(statistics, band, mean));
        Ok(Self { bands: bands.collect::<Result<_>>()? })
    }

    /// How many bands a spectrum has.
    #[must_use]
    pub fn bands(&self) -> usize {
        self.bands.len()
    }

    /// Draws one spectrum into `counts`.
    pub fn draw_into(&self, rng: &mut ChaCha8Rng, counts: &mut [f64]) {
        for (count, band) in counts.iter_mut().zip(&self.bands) {
            *count = match band {
                Band::Dark => 0.0,
                Band::Poisson(poisson) => poisson.sample(rng),
                Band::Normal(normal) => normal.sample(rng),
                Band::Bunched(intensity) => {
                    let mean = intensity.sample(rng);
                    match Poisson::new(mean) {
                        Ok(poisson) => poisson.sample(rng),
                        // An intensity that underflowed, or one whose shot noise is below 1e-9 of it.
                        Err(_) => mean.floor(),
                    }
                }
            };
        }
    }
}

impl Band {
    fn new(statistics: &Statistics, band: usize, mean: f64) -> Result<Self> {
        check::non_negative("mean counts of a band", mean, "counts")?;
        let refused = || Error::out_of_range("mean counts of a band", mean, "counts", "at most 1e18");
        if mean > LARGEST_MEAN {
            return Err(refused());
        }
        match statistics {
            Statistics::Gaussian { .. } => {
                let sigma = statistics.variance(band, mean).sqrt();
                Normal::new(mean, sigma).map(Self::Normal).map_err(|_| refused())
            }
            _ if mean == 0.0 => Ok(Self::Dark),
            Statistics::Poisson => Poisson::new(mean).map(Self::Poisson).map_err(|_| refused()),
            Statistics::NegativeBinomial { modes } => {
                let m = modes.get(band).copied().unwrap_or(f64::INFINITY);
                Gamma::new(m, mean / m).map(Self::Bunched).map_err(|_| refused())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::function::gamma::ln_gamma;

    const TRIALS: usize = 40_000;

    /// Counts of one band, drawn `TRIALS` times.
    fn sample(statistics: &Statistics, mean: f64) -> Vec<f64> {
        let draws = Draws::new(statistics, &[mean]).unwrap();
        let mut rng = generator(3, mean.to_bits());
        let mut count = [0.0];
        let draw = |_| {
            draws.draw_into(&mut rng, &mut count);
            count[0]
        };
        (0..TRIALS).map(draw).collect()
    }

    /// Largest distance between the counts' distribution and the exact one, times √trials; P(D > 1.95) = 1e-3
    /// by Kolmogorov, and less for a discrete law.
    fn kolmogorov(mut counts: Vec<f64>, below: &dyn Fn(f64) -> f64, at_or_below: &dyn Fn(f64) -> f64) -> f64 {
        counts.sort_by(f64::total_cmp);
        let n = counts.len() as f64;
        let (mut largest, mut start): (f64, usize) = (0.0, 0);
        while start < counts.len() {
            let value = counts[start];
            let end = start + counts[start..].iter().take_while(|&&c| c == value).count();
            largest = largest.max((start as f64 / n - below(value)).abs());
            largest = largest.max((end as f64 / n - at_or_below(value)).abs());
            start = end;
        }
        largest * n.sqrt()
    }

    /// Σ P(k) up to each count, from the laws' logarithms.
    fn discrete(counts: Vec<f64>, ln_p: &dyn Fn(f64) -> f64) -> f64 {
        let most = counts.iter().copied().fold(0.0, f64::max) as usize + 1;
        let mut cumulated = vec![0.0; most + 1];
        let mut sum = 0.0;
        for (k, value) in cumulated.iter_mut().enumerate() {
            sum += ln_p(k as f64).exp();
            *value = sum;
        }
        let at = |k: f64| if k < 0.0 { 0.0 } else { cumulated[k as usize] };
        kolmogorov(counts, &|k| at(k - 1.0), &at)
    }

    /// Nine tests, each of which fails by chance with at most 1e-3; the seed is fixed, so none does.
    #[test]
    fn counts_follow_their_laws() {
        for mean in [0.3_f64, 4.0, 11.9, 12.1, 300.0, 2e5] {
            let ln_p = |k: f64| k * mean.ln() - mean - ln_gamma(k + 1.0);
            let distance = discrete(sample(&Statistics::Poisson, mean), &ln_p);
            assert!(distance < 1.95, "Poisson {mean}: {distance}");
        }
        for (mean, m) in [(20.0_f64, 0.7_f64), (500.0, 60.0)] {
            let ln_p = |k: f64| {
                let choose = ln_gamma(k + m) - ln_gamma(m) - ln_gamma(k + 1.0);
                choose + k * (mean / (mean + m)).ln() - m * (mean / m).ln_1p()
            };
            let statistics = Statistics::negative_binomial(vec![m]).unwrap();
            let distance = discrete(sample(&statistics, mean), &ln_p);
            assert!(distance < 1.95, "negative binomial {mean} {m}: {distance}");
        }
        let statistics = Statistics::gaussian(vec![75.0]).unwrap();
        let exact = |n: f64| crate::identifiability::detection::probability((n - 25.0) / 10.0);
        let distance = kolmogorov(sample(&statistics, 25.0), &exact, &exact);
        assert!(distance < 1.95, "Gaussian: {distance}");
    }

    /// Where no exact distribution is at hand: mean and variance within 4.5 of their own deviations (by chance 7e-6
    /// each).
    #[test]
    fn many_photons_have_the_right_mean_and_variance() {
        for mean in [1e9_f64, 1e12, 1e17] {
            let counts = sample(&Statistics::Poisson, mean);
            let n = TRIALS as f64;
            let off: f64 = counts.iter().map(|c| (c - mean) / mean.sqrt()).sum::<f64>() / n;
            let square: f64 = counts.iter().map(|c| (c - mean).powi(2) / mean).sum::<f64>() / n;
            assert!(off.abs() < 4.5 / n.sqrt() && (square - 1.0).abs() < 4.5 * (2.0 / n).sqrt(), "{mean:e}");
        }
    }

    /// A change of any of these changes every published figure of a simulation.
    #[test]
    fn the_first_draws_stay_what_they_are() {
        let first = |statistics: Statistics, means: &[f64]| {
            let mut counts = vec![0.0; means.len()];
            Draws::new(&statistics, means).unwrap().draw_into(&mut generator(20, 7), &mut counts);
            counts
        };
        assert_eq!(
            first(Statistics::Poisson, &[0.5, 9.0, 40.0, 1e6, 1e12]),
            [1.0, 7.0, 37.0, 1_000_922.0, 999_998_480_959.0]
        );
        let bunched = Statistics::negative_binomial(vec![0.5, 30.0]).unwrap();
        assert_eq!(first(bunched, &[9.0, 1e4]), [10.0, 9274.0]);
        let normal = Statistics::gaussian(vec![0.0, 4.0]).unwrap();
        assert_eq!(first(normal, &[9.0, 0.0]), [10.273_173_298_150_024, 0.482_033_611_734_406_23]);
    }

    #[test]
    fn impossible_means_are_refused() {
        for mean in [-1.0, f64::NAN, f64::INFINITY, 2e18] {
            assert!(Draws::new(&Statistics::Poisson, &[mean]).is_err(), "{mean}");
        }
        let statistics = Statistics::negative_binomial(vec![2.0]).unwrap();
        assert!(Draws::new(&statistics, &[1.0, 2.0]).is_err());
        let mut count = [1.0];
        Draws::new(&statistics, &[0.0]).unwrap().draw_into(&mut generator(0, 0), &mut count);
        assert_eq!(count, [0.0]);
    }
}
