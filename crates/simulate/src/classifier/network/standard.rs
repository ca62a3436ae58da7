//! Spectra standardised by mean and deviation of every band.

use super::real::Real;
use crate::spectra::LabelledSpectra;
use hadar::error::{Result, check};

/// Mean of every band and the reciprocal of its deviation.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Standard {
    pub(super) means: Vec<f64>,
    /// 0 for a band without scatter.
    pub(super) scales: Vec<f64>,
}

impl Standard {
    /// From the spectra's own scatter.
    pub(super) fn new(spectra: &LabelledSpectra) -> Result<Self> {
        let n = spectra.len() as f64;
        let mut means = vec![0.0; spectra.bands()];
        for (counts, _) in spectra.iter() {
            means.iter_mut().zip(counts).for_each(|(mean, count)| *mean += count / n);
        }
        let mut variances = vec![0.0; spectra.bands()];
        for (counts, _) in spectra.iter() {
            for ((variance, mean), count) in variances.iter_mut().zip(&means).zip(counts) {
                *variance += (count - mean).powi(2) / n;
            }
        }
        let scale = |(band, variance): (usize, &f64)| {
            let mut counts = spectra.counts().iter().skip(band).step_by(spectra.bands());
            let first = counts.next();
            // The mean's rounding would leave a scatter that is none.
            if counts.all(|count| Some(count) == first) {
                return Ok(0.0);
            }
            let variance = check::positive("variance of a band", *variance, "")?;
            check::positive("reciprocal deviation of a band", 1.0 / variance.sqrt(), "")
        };
        let scales = variances.iter().enumerate().map(scale).collect::<Result<_>>()?;
        Ok(Self { means, scales })
    }

    pub(super) fn apply<'a, T: Real>(&'a self, counts: &'a [f64]) -> impl Iterator<Item = T> + 'a {
        let each = counts.iter().zip(&self.means).zip(&self.scales);
        each.map(|((count, mean), scale)| T::of((count - mean) * scale))
    }
}
