//! How the information on a pair is spread over the bands.
//!
//! Share of band w in d²: u_w r_w²/Σ u r² with r the residual at the fitted c. Left out, it costs more than its
//! share, as the others must fit the nuisances without it: d² falls by ¼u_w r_w²/(1 − h_w), h_w the leverage of the
//! band on the nuisances (the updating formula of least squares; Cook and Weisberg, *Residuals and Influence in
//! Regression*, Chapman and Hall (1982), section 2.2).

use super::pair::{Pair, residual};
use super::scores::{Scores, same_length};
use crate::error::Result;
use crate::fisher::Counting;

/// How the information on a pair is spread over the bands.
#[derive(Debug, Clone, PartialEq)]
pub struct Information {
    /// Statistical distance in all bands (per √photon without a camera).
    pub distance: f64,
    /// Share of each band in d²; the sum is 1 less the share of priors, or all are 0 where the distance is 0.
    pub share: Vec<f64>,
    /// Share of d² that is lost when the band alone is left out.
    pub lost_without: Vec<f64>,
}

impl Scores {
    /// What each band tells of the pair at the target's own state.
    ///
    /// ```
    /// use hadar::identifiability::selection::Scores;
    /// // A line in the second band over a continuum of unknown level, which the other two measure.
    /// let level = vec![vec![1.0; 3]];
    /// let information =
    ///     Scores::from_columns(level, vec![0.0, 3.0, 0.0], vec![1.0; 3], vec![0.0; 3])?.information();
    /// // Residual (−1, 2, −1): shares 1/6, 4/6, 1/6.
    /// assert!((information.share[1] - 4.0 / 6.0).abs() < 1e-14);
    /// assert!((information.lost_without[1] - 1.0).abs() < 1e-14);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    #[must_use]
    pub fn information(&self) -> Information {
        let pair = Pair::new(self);
        let (share, lost_without) = shares(&pair);
        Information { distance: pair.whole() * self.required, share, lost_without }
    }
}

/// Share of each band in the separation of two given spectra, ‖√(N + σ²) − √(N′ + σ²)‖²: for the nearest state
/// of the alternative, what its signals are told apart by. `signal` and `other` are band signals (photons s⁻¹ m⁻²
/// sr⁻¹); without `counting` the noise is shot noise alone. All are 0 where the two are the same.
///
/// # Errors
/// Spectra of different length.
pub fn shares_between(signal: &[f64], other: &[f64], counting: Option<&Counting>) -> Result<Vec<f64>> {
    same_length("band signals of the alternative", other.len(), signal.len())?;
    let squares: Vec<f64> = signal
        .iter()
        .zip(other)
        .enumerate()
        .map(|(w, (s, t))| {
            let extra = counting.map_or(0.0, |c| c.var_added(w) / c.counts_per_radiance);
            let below = (s + extra).sqrt() + (t + extra).sqrt();
            if below > 0.0 { ((s - t) / below).powi(2) } else { 0.0 }
        })
        .collect();
    Ok(normalised(squares))
}

/// Shares of the bands in d², and what of d² is lost without each.
fn shares(pair: &Pair) -> (Vec<f64>, Vec<f64>) {
    let width = pair.width();
    let squares: Vec<f64> = pair.rows().chunks(width).map(|row| residual(row, &[]).powi(2)).collect();
    let prior = pair.prior_cost(&[]);
    let whole = crate::sum::sum(&squares) + prior;
    let lost = pair.rows().chunks(width).zip(&squares).map(|(row, square)| {
        let leverage: f64 = row[..width - 1].iter().map(|q| q * q).sum();
        let rest = (1.0 - leverage).max(f64::EPSILON);
        if whole > 0.0 { (square / rest / whole).min(1.0) } else { 0.0 }
    });
    let lost = lost.collect();
    let mut with_prior = squares;
    with_prior.push(prior);
    let mut share = normalised(with_prior);
    share.pop();
    (share, lost)
}

/// Divides by the sum, where there is one.
pub(super) fn normalised(mut values: Vec<f64>) -> Vec<f64> {
    let total = crate::sum::sum(&values);
    values.iter_mut().for_each(|value| *value = if total > 0.0 { *value / total } else { 0.0 });
    values
}
