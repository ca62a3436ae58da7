//! A fixed number of photons, N, each in band w with probability p_w on its own: normalised spectra.
//!
//! Band after band takes Binomial(what is left, p_w/Σ_{v≥w} p_v) of what is left. Sums of the probabilities run from
//! the last band to the first, so that the rest is never a difference, and the smaller of p and 1 − p of every
//! binomial is known to its last digits; the last band with any probability takes the remainder. Counts of a band are
//! Binomial(N, p_w); two have covariance −N p_v p_w.
//!
//! Binomials: inversion where the rarer outcome is expected fewer than 10 times, else rejection (rand_distr). That
//! crate's own inversion takes (1 − p)^N from the rounded 1 − p, which for 10¹⁵ trials is wrong by up to a quarter;
//! here it is e^{N ln(1 − p)}. Sources: Devroye, 'Non-Uniform Random Variate Generation' (1986), chapters X.4 and XI.1;
//! Kachitvichyanukul and Schmeiser, Commun. ACM 31, 216 (1988), doi:10.1145/42372.42381.

use hadar::error::{Error, Result, check};
use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Binomial, Distribution};

/// Most photons: 2⁵³.
pub const MOST: u64 = 1 << 53;
/// Rarer outcomes expected fewer times than this are counted by inversion.
const FEW: f64 = 10.0;

/// The law of a spectrum of a fixed number of photons.
///
/// ```
/// use hadar_simulate::draws::{generator, multinomial::Multinomial};
/// let law = Multinomial::new(1000, &[1.0, 0.0, 3.0])?;
/// let mut counts = [0.0; 3];
/// law.draw_into(&mut generator(1, 0), &mut counts);
/// assert!(counts.iter().sum::<f64>() == 1000.0 && counts[1] == 0.0);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Multinomial {
    total: u64,
    /// Shares p and 1 − p of every band of what it and those after it have.
    shares: Vec<(f64, f64)>,
}

impl Multinomial {
    /// `total` photons over bands of probabilities proportional to `weights`.
    ///
    /// # Errors
    /// More than [`MOST`] photons; a weight that is negative or not finite; no weight above 0; a sum that overflows.
    pub fn new(total: u64, weights: &[f64]) -> Result<Self> {
        if total > MOST {
            return Err(Error::out_of_range("photons of a spectrum", total as f64, "", "at most 2^53"));
        }
        for &weight in weights {
            check::non_negative("probability of a band", weight, "")?;
        }
        let mut rest = 0.0;
        let mut shares: Vec<(f64, f64)> = weights
            .iter()
            .rev()
            .map(|&weight| {
                let after = rest;
                rest += weight;
                if rest > 0.0 { (weight / rest, after / rest) } else { (0.0, 1.0) }
            })
            .collect();
        check::positive("sum of the probabilities", rest, "")?;
        shares.reverse();
        Ok(Self { total, shares })
    }

    /// Draws one spectrum into `counts`.
    pub fn draw_into(&self, rng: &mut ChaCha8Rng, counts: &mut [f64]) {
        let mut left = self.total;
        for (count, &(p, q)) in counts.iter_mut().zip(&self.shares) {
            let taken = binomial(rng, left, p, q);
            *count = taken as f64;
            left -= taken;
        }
    }
}

/// Successes of `trials`, of probability p = 1 − q; both are given, so that the smaller is known well.
fn binomial(rng: &mut ChaCha8Rng, trials: u64, p: f64, q: f64) -> u64 {
    let rarer = p.min(q);
    let of_rarer = if trials == 0 || rarer == 0.0 {
        0
    } else if trials as f64 * rarer < FEW {
        inversion(rng, trials, rarer)
    } else {
        // `rarer` is a probability, so that there is no error to fall back from.
        Binomial::new(trials, rarer).map_or(0, |law| law.sample(rng))
    };
    if p <= q { of_rarer } else { trials - of_rarer }
}

/// The number whose distribution function first reaches a uniform.
fn inversion(rng: &mut ChaCha8Rng, trials: u64, p: f64) -> u64 {
    let n = trials as f64;
    let odds = p / (1.0 - p);
    loop {
        let mut u: f64 = rng.random();
        let mut mass = (n * (-p).ln_1p()).exp();
        let mut k = 0.0;
        // Nothing is left of the masses 33 deviations above the mean; a u that got there by rounding is drawn anew.
        while k <= 120.0_f64.min(n) {
            if u < mass {
                return k as u64;
            }
            u -= mass;
            k += 1.0;
            mass *= (n - k + 1.0) / k * odds;
        }
    }
}

#[cfg(test)]
mod tests;
