//! Trials of the likelihood-ratio test between two known states, without their spectra.
//!
//! [`RatioDraws`] gives values of Λ = ln(q/p) themselves, by the cheapest way that is exact: the inverse of the
//! distribution function of [`hadar::identifiability::ratio`], where it is smooth (to 10⁻⁶ of probability); photon by
//! photon, the number of them Poisson about ΣN and each from band w with probability N_w/ΣN, where photons are few;
//! else counts of every band. That is as good as drawing every band of every spectrum, and up to hundreds of times as
//! fast. Values come in blocks with a stream of random numbers each.

use super::draws::{Draws, generator};
use hadar::error::Result;
use hadar::identifiability::ratio::{RatioDistribution, RatioLaw, State};
use hadar::statistics::Statistics;
use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use rand_distr::weighted::WeightedAliasIndex;
use rand_distr::{Distribution, Poisson};
use rayon::prelude::*;

/// Values of Λ that share a stream of random numbers.
pub const VALUES: usize = 4096;
/// Draws of a photon cost as much as the counts of this many bands.
const PHOTONS_PER_BAND: f64 = 2.0;

/// Draws of Λ = ln(q/p) while one of the two states is true.
///
/// ```
/// use hadar::identifiability::ratio::State;
/// use hadar_simulate::ratio::RatioDraws;
/// use hadar::statistics::Statistics;
/// let (p, q) = ([100.0; 60], [103.0; 60]);
/// let draws = RatioDraws::new(&p, &q, &Statistics::Poisson, State::First)?;
/// let right = draws.values(1, 0, 10_000).iter().filter(|ratio| **ratio < 0.0).count();
/// // Distance ½·2·√60·(√103 − √100) = 1.154: Φ = 0.876.
/// assert!((right as f64 - 8757.0).abs() < 165.0);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct RatioDraws {
    method: Method,
}

#[derive(Debug, Clone)]
enum Method {
    /// Distribution where Λ is finite, the chance that it is not, and what it is then.
    Table { table: RatioDistribution, certain: f64, infinite: f64 },
    /// Number of photons (none if it is dark), bands, Λ of each and of none.
    Photons {
        count: Option<Poisson<f64>>,
        bands: Option<WeightedAliasIndex<f64>>,
        steps: Vec<f64>,
        none: f64,
    },
    /// Counts of every band, and a term of each.
    Bands { draws: Draws, terms: Vec<Term> },
}

/// Λ of n counts of a band: a + b(n − N) + c(n − N)²; Λ of any counts of a band that is dark in one state only.
#[derive(Debug, Clone, Copy)]
enum Term {
    Square { mean: f64, constant: f64, linear: f64, square: f64 },
    Dark { none: f64, some: f64 },
}

impl RatioDraws {
    /// Draws with `truth` of two states with mean counts `means` (p) and `others` (q).
    ///
    /// # Errors
    /// As [`RatioLaw::new`] and [`Draws::new`].
    pub fn new(means: &[f64], others: &[f64], statistics: &Statistics, truth: State) -> Result<Self> {
        let law = RatioLaw::new(means, others, statistics)?;
        let of_truth = if truth == State::First { means } else { others };
        let draws = Draws::new(statistics, of_truth)?;
        if let Some(table) = law.distribution(truth) {
            let infinite = if truth == State::First { f64::NEG_INFINITY } else { f64::INFINITY };
            let certain = law.certain(truth);
            return Ok(Self { method: Method::Table { table, certain, infinite } });
        }
        let total: f64 = of_truth.iter().sum();
        let pairs = means.iter().zip(others);
        if *statistics == Statistics::Poisson && total < PHOTONS_PER_BAND * means.len() as f64 {
            let steps = pairs.clone().map(|(a, b)| if a == b { 0.0 } else { (b / a).ln() }).collect();
            let none = -hadar::sum::sum(&pairs.map(|(a, b)| b - a).collect::<Vec<_>>());
            // No photons, and weights that are none, in the dark.
            let count = Poisson::new(total).ok();
            let bands = WeightedAliasIndex::new(of_truth.to_vec()).ok();
            return Ok(Self { method: Method::Photons { count, bands, steps, none } });
        }
        let terms = pairs.enumerate().map(|(band, (&a, &b))| Term::new(statistics, band, a, b, truth));
        let terms = terms.collect();
        Ok(Self { method: Method::Bands { draws, terms } })
    }

    /// One value of Λ: −∞ or ∞ if the counts cannot come from the other state.
    #[must_use]
    pub fn draw(&self, rng: &mut ChaCha8Rng, counts: &mut Vec<f64>) -> f64 {
        match &self.method {
            Method::Table { table, certain, infinite } => {
                if *certain > 0.0 && rng.random::<f64>() < *certain {
                    return *infinite;
                }
                table.quantile(rng.random())
            }
            Method::Photons { count, bands, steps, none } => {
                let (Some(count), Some(bands)) = (count, bands) else { return *none };
                let photons = count.sample(rng) as u64;
                (0..photons).fold(*none, |sum, _| sum + steps.get(bands.sample(rng)).copied().unwrap_or(0.0))
            }
            Method::Bands { draws, terms } => {
                counts.resize(draws.bands(), 0.0);
                draws.draw_into(rng, counts);
                terms.iter().zip(counts.iter()).map(|(term, &n)| term.at(n)).sum()
            }
        }
    }

    /// `trials` values of Λ; block k of [`VALUES`] has the stream `stream` + k.
    #[must_use]
    pub fn values(&self, seed: u64, stream: u64, trials: usize) -> Vec<f64> {
        let mut values = vec![0.0; trials];
        values.par_chunks_mut(VALUES).enumerate().for_each(|(block, values)| {
            hadar::stop::check();
            let mut rng = generator(seed, stream.wrapping_add(block as u64));
            let mut counts = Vec::new();
            values.iter_mut().for_each(|value| *value = self.draw(&mut rng, &mut counts));
        });
        values
    }
}

impl Term {
    fn new(statistics: &Statistics, band: usize, p: f64, q: f64, truth: State) -> Self {
        let mean = if truth == State::First { p } else { q };
        let ln = |n: f64, of: f64| statistics.log_likelihood(band, n, of);
        if p == q {
            return Self::Square { mean, constant: 0.0, linear: 0.0, square: 0.0 };
        }
        match statistics {
            Statistics::Gaussian { .. } => {
                let (v, w) = (statistics.variance(band, p), statistics.variance(band, q));
                let (off, other_off) = (mean - p, mean - q);
                Self::Square {
                    mean,
                    constant: 0.5 * (off * off / v - other_off * other_off / w - ((q - p) / v).ln_1p()),
                    linear: off / v - other_off / w,
                    square: 0.5 * (q - p) / v / w,
                }
            }
            _ if p == 0.0 || q == 0.0 => {
                let some = if p == 0.0 { f64::INFINITY } else { f64::NEG_INFINITY };
                Self::Dark { none: ln(0.0, q) - ln(0.0, p), some }
            }
            Statistics::Poisson => {
                let step = ((q - p) / p).ln_1p();
                Self::Square { mean, constant: mean * step - (q - p), linear: step, square: 0.0 }
            }
            Statistics::NegativeBinomial { modes } => {
                let m = modes.get(band).copied().unwrap_or(f64::INFINITY);
                let dark = ((q - p) / (m + p)).ln_1p();
                let step = ((q - p) / p).ln_1p() - dark;
                Self::Square { mean, constant: mean * step - m * dark, linear: step, square: 0.0 }
            }
        }
    }

    fn at(&self, n: f64) -> f64 {
        match *self {
            Self::Square { mean, constant, linear, square } => {
                let off = n - mean;
                constant + off * (linear + off * square)
            }
            Self::Dark { none, some } => {
                if n > 0.0 {
                    some
                } else {
                    none
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
