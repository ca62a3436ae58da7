//! Counts drawn about given means.
//!
//! * Poisson: exact at any mean up to [`LARGEST_MEAN`] (products of uniforms below a mean of 12, rejection from a
//!   normal above); a mean of 0 gives 0.
//! * Gaussian: normal of variance N + σ².
//! * negative binomial: Poisson about a mean that is itself gamma distributed with shape m and mean N: the
//!   intensity of thermal light in m modes;
//! * any of the first and the last with electronic noise: exact counts plus a normal reading error of variance σ².
//!
//! [`multinomial`]: a fixed number of photons over the bands; [`gaussian`]: how far the Gaussian law is from that of photons.
//!
//! Counts are doubles: whole numbers up to 2⁵³ ([`LARGEST_EXACT`]), beyond which only multiples of 2, 4, … are met.
//!
//! Sources: Ahrens and Dieter, ACM Trans. Math. Softw. 8, 163 (1982), doi:10.1145/355993.355997 (Poisson); Marsaglia
//! and Tsang, ACM Trans. Math. Softw. 26, 363 (2000), doi:10.1145/358407.358414 (gamma); generator: Bernstein,
//! 'ChaCha, a variant of Salsa20' (2008).

pub mod gaussian;
pub mod multinomial;

pub use hadar::random::{GENERATOR, generator};

use self::multinomial::Multinomial;
use hadar::error::{Error, Result, check};
use hadar::statistics::Statistics;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, Gamma, Normal, Poisson};

/// Largest mean that can be drawn about.
pub const LARGEST_MEAN: f64 = 1e18;

/// Largest mean about which every whole number is a double: 2⁵³.
pub const LARGEST_EXACT: f64 = 9_007_199_254_740_992.0;

/// Streams set aside for the spectra or trials of one class.
pub(crate) const STREAMS: u64 = 1 << 40;

/// A spectrum to draw counts about.
///
/// ```
/// use hadar_simulate::draws::{Draws, generator};
/// use hadar::statistics::Statistics;
/// let draws = Draws::new(&Statistics::Poisson, &[0.0, 1e6])?;
/// let mut counts = [0.0; 2];
/// draws.draw_into(&mut generator(1, 0), &mut counts);
/// assert!(counts[0] == 0.0 && (counts[1] - 1e6).abs() < 6e3);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Draws {
    bands: usize,
    photons: Photons,
    /// Added to exact counts; empty without electronic noise.
    readings: Vec<Reading>,
}

/// Electronic noise of one band's reading.
#[derive(Debug, Clone, Copy)]
struct Reading {
    var: f64,
    noise: Normal<f64>,
}

/// The law of the photons.
#[derive(Debug, Clone)]
enum Photons {
    /// Each band on its own.
    Bands(Vec<Band>),
    /// A fixed number over all bands.
    Total(Multinomial),
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
        let photons = Photons::Bands(bands.collect::<Result<_>>()?);
        Ok(Self { bands: means.len(), photons, readings: Vec::new() })
    }

    /// A fixed number of photons, `total` rounded to a whole one, over bands of probabilities proportional to `weights`.
    ///
    /// # Errors
    /// A number of photons that is negative, no number or above 2⁵³; weights as in [`Multinomial::new`].
    pub fn fixed_total(total: f64, weights: &[f64]) -> Result<Self> {
        check::non_negative("photons of a spectrum", total, "")?;
        if total > LARGEST_EXACT {
            return Err(Error::out_of_range("photons of a spectrum", total, "", "at most 2^53"));
        }
        let photons = Photons::Total(Multinomial::new(total.round() as u64, weights)?);
        Ok(Self { bands: weights.len(), photons, readings: Vec::new() })
    }

    /// Adds to the counts of every band a normal reading error of variance `var_added`, counts², independent in
    /// every reading; noise of several calls adds up. Readings may be negative, and are no whole numbers.
    ///
    /// ```
    /// use hadar_simulate::draws::{Draws, generator};
    /// use hadar::statistics::Statistics;
    /// let draws = Draws::new(&Statistics::Poisson, &[9.0])?.with_electronic_noise(&[100.0])?;
    /// let mut reading = [0.0];
    /// draws.draw_into(&mut generator(1, 0), &mut reading);
    /// assert!(reading[0] != reading[0].round());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    ///
    /// # Errors
    /// A variance that is negative or not finite; another number of bands; Gaussian counts, which have it already.
    pub fn with_electronic_noise(mut self, var_added: &[f64]) -> Result<Self> {
        let is_normal = |band: &Band| matches!(band, Band::Normal(_));
        if matches!(&self.photons, Photons::Bands(bands) if bands.iter().any(is_normal)) {
            return Err(Error::malformed(
                "electronic noise is added to Gaussian counts, whose variance has it already",
                "draw Poisson or negative binomial counts, or give it to the Gaussian law alone",
            ));
        }
        if var_added.len() != self.bands {
            return Err(Error::Length {
                what: "variances of electronic noise".into(),
                found: var_added.len(),
                expected: self.bands,
            });
        }
        let mut readings = Vec::with_capacity(var_added.len());
        for (band, &more) in var_added.iter().enumerate() {
            check::non_negative("variance of electronic noise", more, "counts^2")?;
            let var = more + self.readings.get(band).map_or(0.0, |reading| reading.var);
            let noise = Normal::new(0.0, var.sqrt()).map_err(|_| {
                Error::out_of_range("variance of electronic noise", var, "counts^2", "a finite number")
            })?;
            readings.push(Reading { var, noise });
        }
        self.readings = readings;
        Ok(self)
    }

    /// How many bands a spectrum has.
    #[must_use]
    pub fn bands(&self) -> usize {
        self.bands
    }

    /// Draws one spectrum into `counts`.
    pub fn draw_into(&self, rng: &mut ChaCha8Rng, counts: &mut [f64]) {
        match &self.photons {
            Photons::Bands(bands) => {
                counts.iter_mut().zip(bands).for_each(|(count, band)| *count = band.draw(rng));
            }
            Photons::Total(multinomial) => multinomial.draw_into(rng, counts),
        }
        for (count, reading) in counts.iter_mut().zip(&self.readings) {
            *count += reading.noise.sample(rng);
        }
    }
}

impl Band {
    fn draw(&self, rng: &mut ChaCha8Rng) -> f64 {
        match self {
            Self::Dark => 0.0,
            Self::Poisson(poisson) => poisson.sample(rng),
            Self::Normal(normal) => normal.sample(rng),
            Self::Bunched(intensity) => {
                let mean = intensity.sample(rng);
                match Poisson::new(mean) {
                    Ok(poisson) => poisson.sample(rng),
                    // An intensity that underflowed, or one whose shot noise is below 1e-9 of it.
                    Err(_) => mean.floor(),
                }
            }
        }
    }

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
mod tests;
