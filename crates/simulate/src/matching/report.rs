//! Bias, spread, outliers and failures of matches, beside the bound.
//!
//! Of every window: errors d̂ − d of the trials that gave a disparity, with and without outliers (off by more than
//! a pixel); the error without noise, which is systematic; and the ratio of variance to the bound's, with its
//! interval and verdict (`efficiency`). The bound is for unbiased estimates that always come: with failures,
//! or with outliers that the range of the search cuts off, a ratio is of those that came.

use super::trials::{Centre, Matches};
use super::{Failure, Match};
use crate::efficiency::{Criteria, Efficiency, Errors, ParameterEfficiency, Verdict};
use crate::sequential::Interval;
use hadar::error::{Error, Result};
use hadar::fisher::precision::JointBound;

/// Off by more than this, pixels, a match is an outlier.
pub const OUTLIER: f64 = 1.0;

/// One window.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CentreReport {
    /// Position of the middle of the window, with its true disparity.
    pub centre: Centre,
    /// Error without noise, pixels: systematic. `None` where there is no match even so.
    pub systematic: Option<f64>,
    /// Number of trials at this window.
    pub trials: usize,
    /// Trials without a disparity, in the order of [`Failure::ALL`].
    pub failures: [usize; 3],
    /// Trials with one that is off by more than [`OUTLIER`].
    pub outliers: usize,
    /// Share of trials that are either, and its interval (Wilson).
    pub lost: f64,
    /// Confidence interval of the share of lost trials, 0 to 1.
    pub lost_interval: Interval,
    /// All disparities found; `None` for fewer than two.
    pub errors: Option<Errors>,
    /// Errors of the trials that found a disparity, without outliers.
    pub inliers: Option<Errors>,
    /// Quartiles of the error of all found, pixels.
    pub quartiles: Option<[f64; 3]>,
    /// All found compared with the bound, if one was given.
    pub efficiency: Option<ParameterEfficiency>,
    /// Those without outliers compared with it.
    pub efficiency_inliers: Option<ParameterEfficiency>,
}

/// All windows.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct LineReport {
    /// One report for each window.
    pub centres: Vec<CentreReport>,
    /// Root mean square error of all disparities found, pixels; `None` without any.
    pub rmse: Option<f64>,
    /// Root mean square error of all windows without outliers, pixels.
    pub rmse_inliers: Option<f64>,
    /// Root mean square of the errors without noise.
    pub rms_systematic: Option<f64>,
    /// Root mean square of the bound, if given.
    pub rms_bound: Option<f64>,
    /// Mean ratio of variance to the bound's (outliers included), over the windows that have one.
    pub mean_ratio: Option<f64>,
    /// Windows whose variance (outliers included) is said to reach, exceed, be below the bound, be biased, be
    /// undecided.
    pub verdicts: [usize; 5],
    /// Share of trials that failed or are outliers.
    pub lost: f64,
}

/// In the order of [`LineReport::verdicts`].
pub const VERDICTS: [Verdict; 5] =
    [Verdict::Reaches, Verdict::Exceeds, Verdict::Below, Verdict::Biased, Verdict::Undecided];

impl Matches {
    /// The report, beside the deviations `sigma_bound` (pixels) of each window's disparity; NaN or infinity
    /// stands for a window that has no bound, an empty list for none at all.
    ///
    /// # Errors
    /// Bounds that are not as many as windows, criteria that are none.
    ///
    /// ```
    /// use hadar_simulate::efficiency::Criteria;
    /// use hadar_simulate::matching::{Failure, trials::{Centre, Matches}};
    /// let centres = vec![Centre { row: 2, column: 2, disparity: 5.0 }];
    /// let trials = vec![Ok(5.1), Ok(4.9), Ok(9.0), Err(Failure::RangeEnd)];
    /// let report = Matches { centres, noise_free: vec![Ok(5.02)], trials }.report(&[], &Criteria::default())?;
    /// let centre = &report.centres[0];
    /// assert!((centre.systematic.unwrap() - 0.02).abs() < 1e-12);
    /// assert_eq!((centre.outliers, centre.failures, centre.lost), (1, [0, 1, 0], 0.5));
    /// assert!((centre.inliers.unwrap().rmse - 0.1).abs() < 1e-12);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn report(&self, sigma_bound: &[f64], criteria: &Criteria) -> Result<LineReport> {
        if !sigma_bound.is_empty() && sigma_bound.len() != self.centres.len() {
            return Err(Error::Length {
                what: "bounds of the windows".into(),
                found: sigma_bound.len(),
                expected: self.centres.len(),
            });
        }
        let mut centres = Vec::with_capacity(self.centres.len());
        for (number, centre) in self.centres.iter().enumerate() {
            let free = self.noise_free.get(number).copied();
            let sigma = sigma_bound.get(number).copied().filter(|sigma| sigma.is_finite() && *sigma > 0.0);
            centres.push(CentreReport::of(*centre, free, self.of(number).collect(), sigma, criteria)?);
        }
        let bounds: Vec<f64> = sigma_bound.iter().copied().filter(|sigma| sigma.is_finite()).collect();
        let found = |report: &CentreReport| report.efficiency.map(|efficiency| efficiency.ratio);
        let ratios: Vec<f64> = centres.iter().filter_map(found).collect();
        let verdicts = VERDICTS.map(|verdict| {
            let given = centres.iter().filter_map(|report| report.efficiency);
            given.filter(|efficiency| efficiency.verdict == verdict).count()
        });
        let trials: usize = centres.iter().map(|report| report.trials).sum();
        let lost: f64 = centres.iter().map(|report| report.lost * report.trials as f64).sum();
        let systematic: Vec<f64> = centres.iter().filter_map(|report| report.systematic).collect();
        Ok(LineReport {
            rmse: pooled(centres.iter().filter_map(|report| report.errors)),
            rmse_inliers: pooled(centres.iter().filter_map(|report| report.inliers)),
            rms_systematic: rms(&systematic),
            rms_bound: rms(&bounds),
            mean_ratio: (!ratios.is_empty()).then(|| hadar::sum::sum(&ratios) / ratios.len() as f64),
            verdicts,
            lost: if trials > 0 { lost / trials as f64 } else { 0.0 },
            centres,
        })
    }
}

impl CentreReport {
    fn of(
        centre: Centre,
        free: Option<Match>,
        trials: Vec<Match>,
        sigma: Option<f64>,
        criteria: &Criteria,
    ) -> Result<Self> {
        let truth = centre.disparity;
        let mut found: Vec<f64> = trials.iter().filter_map(|found| found.ok()).collect();
        let near: Vec<f64> = found.iter().copied().filter(|d| (d - truth).abs() <= OUTLIER).collect();
        let failures =
            Failure::ALL.map(|failure| trials.iter().filter(|found| **found == Err(failure)).count());
        let outliers = found.len() - near.len();
        let lost = (outliers + failures.iter().sum::<usize>()) as f64;
        let errors = |list: &[f64]| match list.len() {
            0 | 1 => Ok(None),
            _ => Errors::of(list, truth, criteria.level).map(Some),
        };
        let efficiency = |list: &[f64]| match sigma {
            Some(sigma) if list.len() > 1 => {
                let report = Efficiency::of(list, &[truth], &JointBound::from_sigma(sigma)?, criteria)?;
                Ok::<_, Error>(report.parameters.first().copied())
            }
            _ => Ok(None),
        };
        let (errors_found, errors_near) = (errors(&found)?, errors(&near)?);
        let (efficiency_found, efficiency_near) = (efficiency(&found)?, efficiency(&near)?);
        found.sort_by(f64::total_cmp);
        Ok(Self {
            centre,
            systematic: free.and_then(|free| free.ok()).map(|free| free - truth),
            trials: trials.len(),
            failures,
            outliers,
            lost: lost / trials.len().max(1) as f64,
            lost_interval: Interval::wilson(lost, trials.len() as u64, criteria.level),
            errors: errors_found,
            inliers: errors_near,
            quartiles: quartiles(&found).map(|of| of.map(|d| d - truth)),
            efficiency: efficiency_found,
            efficiency_inliers: efficiency_near,
        })
    }
}

/// Of sorted values, between them linearly.
fn quartiles(sorted: &[f64]) -> Option<[f64; 3]> {
    let last = sorted.len().checked_sub(1)?;
    let [mut of, quarters] = [[0.0; 3], [0.25, 0.5, 0.75]];
    for (to, share) in of.iter_mut().zip(quarters) {
        let at = share * last as f64;
        let low = sorted.get(at.floor() as usize)?;
        let high = sorted.get(at.ceil() as usize)?;
        *to = low + (at - at.floor()) * (high - low);
    }
    Some(of)
}

fn rms(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| (hadar::sum::dot(values, values) / values.len() as f64).sqrt())
}

/// Root mean square over all estimates.
fn pooled(errors: impl Iterator<Item = Errors>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for errors in errors {
        let n = errors.estimates as f64;
        sum += n * errors.rmse * errors.rmse;
        count += n;
    }
    (count > 0.0).then(|| (sum / count).sqrt())
}
