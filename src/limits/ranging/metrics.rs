//! Standard metrics of a depth map.
//!
//! With predicted depth p and true depth t (m) of the n pixels in use:
//!
//! * Abs_Rel = Σ|t − p|/t /n,   Sq_Rel = Σ(t − p)²/t /n (m: it is divided by t, not t²)
//! * RMSE = √(Σ(t − p)²/n) (m),   RMSE_log = √(Σ(ln t − ln p)²/n), natural logarithms
//! * δ_k = share of the pixels with max(t/p, p/t) < 1.25ᵏ, k = 1, 2, 3
//!
//! Assumptions: every pixel counts the same. A pixel is in use if the mask has it and both depths are finite and
//! above 0; how many are not, and why, is part of the result: metrics of maps with different gaps do not compare.
//!
//! Source: paper, Methods, 'Standard depth metrics'.

use crate::error::{Error, Result};
use crate::sum::Compensated;

/// Metrics of a depth map. With a predicted depth of 2.5 m where 2 m are true:
///
/// ```
/// use hadar::ranging::metrics::DepthMetrics;
/// let metrics = DepthMetrics::of(&[2.5, 1.0, 3.0], &[2.0, 1.0, f64::NAN], None)?;
/// assert_eq!((metrics.used, metrics.excluded.truth), (2, 1));
/// assert_eq!(metrics.abs_rel, 0.125);
/// assert_eq!(metrics.delta, [0.5, 1.0, 1.0]);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct DepthMetrics {
    /// Mean of |t − p|/t.
    pub abs_rel: f64,
    /// Mean of (t − p)²/t, m.
    pub sq_rel_m: f64,
    /// Root of the mean of (t − p)², m.
    pub rmse_m: f64,
    /// Root of the mean of (ln t − ln p)².
    pub rmse_log: f64,
    /// δ₁, δ₂, δ₃: shares of pixels whose depths are within a factor of 1.25, 1.25², 1.25³ of each other.
    pub delta: [f64; 3],
    /// Number of pixels that are compared.
    pub used: usize,
    /// Numbers of pixels that are left out, by reason.
    pub excluded: Excluded,
}

/// Pixels that are not in use; each counts once, for the first reason that applies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[non_exhaustive]
pub struct Excluded {
    /// Left out by the mask.
    pub masked: usize,
    /// True depth not finite, or not above 0.
    pub truth: usize,
    /// Predicted depth not finite, or not above 0.
    pub predicted: usize,
}

impl DepthMetrics {
    /// Metrics of `predicted` depths (m) against true ones (m), pixel by pixel; a `mask` is true where a pixel is to
    /// be used.
    ///
    /// # Errors
    /// Lists of different length, no pixel to use, depths so large that their squares are not numbers.
    pub fn of(predicted: &[f64], truth: &[f64], mask: Option<&[bool]>) -> Result<Self> {
        same_length("predicted depths", predicted.len(), truth.len())?;
        if let Some(mask) = mask {
            same_length("pixels of the mask", mask.len(), truth.len())?;
        }
        let mut sums = Sums::default();
        let mut excluded = Excluded::default();
        for (pixel, (&predicted, &truth)) in predicted.iter().zip(truth).enumerate() {
            if mask.is_some_and(|mask| mask.get(pixel) == Some(&false)) {
                excluded.masked += 1;
            } else if !is_depth(truth) {
                excluded.truth += 1;
            } else if !is_depth(predicted) {
                excluded.predicted += 1;
            } else {
                sums.add(predicted, truth);
            }
        }
        sums.metrics(excluded)
    }
}

#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    relative: Compensated,
    squared_relative: Compensated,
    squared: Compensated,
    squared_log: Compensated,
    within: [usize; 3],
    used: usize,
}

impl Sums {
    fn add(&mut self, predicted: f64, truth: f64) {
        let error = truth - predicted;
        let relative = error / predicted;
        // ln(t/p) of nearly equal depths, without the rounding of either logarithm.
        let log = if relative.abs() < 0.5 {
            libm::log1p(relative)
        } else {
            libm::log(truth) - libm::log(predicted)
        };
        self.relative.add(error.abs() / truth);
        self.squared_relative.add(error * (error / truth));
        self.squared.add(error * error);
        self.squared_log.add(log * log);
        let factor = (truth / predicted).max(predicted / truth);
        for (within, limit) in self.within.iter_mut().zip([1.25, 1.5625, 1.953_125]) {
            *within += usize::from(factor < limit);
        }
        self.used += 1;
    }

    fn metrics(self, excluded: Excluded) -> Result<DepthMetrics> {
        if self.used == 0 {
            let Excluded { masked, truth, predicted } = excluded;
            return Err(Error::malformed(
                format!(
                    "no pixel is left to compare: {masked} masked, {truth} without a true depth, \
                     {predicted} without a predicted one"
                ),
                "give depths in m, finite and above 0, where the mask is true",
            ));
        }
        let count = self.used as f64;
        let mean = |sum: Compensated| sum.value() / count;
        let metrics = DepthMetrics {
            abs_rel: mean(self.relative),
            sq_rel_m: mean(self.squared_relative),
            rmse_m: mean(self.squared).sqrt(),
            rmse_log: mean(self.squared_log).sqrt(),
            delta: self.within.map(|within| within as f64 / count),
            used: self.used,
            excluded,
        };
        let DepthMetrics { abs_rel, sq_rel_m, rmse_m, rmse_log, .. } = metrics;
        if [abs_rel, sq_rel_m, rmse_m, rmse_log].iter().all(|metric| metric.is_finite()) {
            return Ok(metrics);
        }
        Err(Error::malformed(
            "the depths are so far apart that their errors are not numbers",
            "give depths in m",
        ))
    }
}

fn is_depth(depth_m: f64) -> bool {
    depth_m.is_finite() && depth_m > 0.0
}

fn same_length(what: &str, found: usize, expected: usize) -> Result<()> {
    if found == expected { Ok(()) } else { Err(Error::Length { what: what.to_owned(), found, expected }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::LN_2;

    fn close(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 4.0 * f64::EPSILON, "{found} {expected}");
    }

    #[test]
    fn closed_forms_of_factors_of_two() {
        // Errors of 1, 2 and 0 m at 2, 2 and 5 m.
        let metrics = DepthMetrics::of(&[1.0, 4.0, 5.0], &[2.0, 2.0, 5.0], None).unwrap();
        close(metrics.abs_rel, (0.5 + 1.0) / 3.0);
        close(metrics.sq_rel_m, (0.5 + 2.0) / 3.0);
        close(metrics.rmse_m, (5.0_f64 / 3.0).sqrt());
        close(metrics.rmse_log, LN_2 * (2.0_f64 / 3.0).sqrt());
        assert_eq!(metrics.delta, [1.0 / 3.0; 3]);
        assert_eq!((metrics.used, metrics.excluded), (3, Excluded::default()));
    }

    #[test]
    fn the_limits_themselves_are_outside_and_count_both_ways() {
        // Exact in binary: factors 1.25, 1.25², 1.25³ and just below, too deep and too near.
        let truth = [64.0; 8];
        let predicted = [80.0, 100.0, 125.0, 79.9, 99.9, 124.9, 51.3, 41.0];
        let metrics = DepthMetrics::of(&predicted, &truth, None).unwrap();
        assert_eq!(metrics.delta, [2.0 / 8.0, 5.0 / 8.0, 7.0 / 8.0]);
    }

    #[test]
    fn unlike_errors_tell_the_divisors_apart() {
        // An error of a tenth everywhere: Abs_Rel 0.1, Sq_Rel 0.01 mean(t), RMSE 0.1 rms(t), RMSE_log ln 1.1.
        let truth = [1.0, 2.0, 3.0, 10.0];
        let metrics = DepthMetrics::of(&truth.map(|t| 1.1 * t), &truth, None).unwrap();
        // 1.1 t is rounded: u/0.1 of the error.
        let near =
            |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 3e-15, "{found} {expected}");
        near(metrics.abs_rel, 0.1);
        near(metrics.sq_rel_m, 0.04);
        near(metrics.rmse_m, 0.1 * (114.0_f64 / 4.0).sqrt());
        near(metrics.rmse_log, 1.1_f64.ln());
    }

    #[test]
    fn the_logarithm_of_nearly_equal_depths_keeps_its_digits() {
        let off = 2.0_f64.powi(-40);
        let metrics = DepthMetrics::of(&[3.0], &[3.0 * (1.0 + off)], None).unwrap();
        close(metrics.rmse_log, off.ln_1p());
    }

    #[test]
    fn every_pixel_left_out_has_one_reason() {
        let (nan, inf) = (f64::NAN, f64::INFINITY);
        let predicted = [nan, 1.0, 1.0, 1.0, nan, 0.0, inf, -1.0, 2.0];
        let truth = [nan, nan, 0.0, -inf, -3.0, 1.0, 1.0, 1.0, 2.0];
        let mut mask = [true; 9];
        mask[0] = false;
        let metrics = DepthMetrics::of(&predicted, &truth, Some(&mask)).unwrap();
        assert_eq!(metrics.excluded, Excluded { masked: 1, truth: 4, predicted: 3 });
        assert_eq!((metrics.used, metrics.abs_rel, metrics.delta), (1, 0.0, [1.0; 3]));
    }

    #[test]
    fn nothing_to_compare_is_no_metric() {
        let message =
            |p: &[f64], t: &[f64], m: Option<&[bool]>| DepthMetrics::of(p, t, m).unwrap_err().to_string();
        assert_eq!(message(&[1.0], &[1.0, 2.0], None), "predicted depths: 1 values where 2 are needed");
        assert_eq!(message(&[1.0], &[1.0], Some(&[])), "pixels of the mask: 0 values where 1 are needed");
        assert!(message(&[], &[], None).starts_with("no pixel is left to compare: 0 masked"));
        let all_out = message(&[1.0, 1.0, 0.0], &[1.0, 0.0, 1.0], Some(&[false, true, true]));
        assert!(all_out.contains("1 masked, 1 without a true depth, 1 without a predicted one"), "{all_out}");
        assert!(message(&[1e200], &[1.0], None).contains("not numbers"));
    }
}
