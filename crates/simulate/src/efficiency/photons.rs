//! How many of the photons a classifier makes use of.
//!
//! The best decision between two classes is right with probability Φ(d), d ∝ √N in shot noise: one that is right with
//! probability P does as well as the best does with the share η = (Φ⁻¹(P)/d)² of the photons. Its interval is that of
//! P, by Wilson, sent through the same function, which rises.
//!
//! Assumption: d² grows with the photons, as it does where their own noise dominates.

use super::Interval;
use hadar::error::{Error, Result, check};
use hadar::identifiability::detection;

/// A classifier's accuracy as a share of photons used.
///
/// ```
/// use hadar_simulate::efficiency::PhotonShare;
/// // Right in 84.13 % of the cases, where the best would be in 97.72 %: a quarter of the photons would do.
/// let found = PhotonShare::of(8413.0, 10_000, 2.0, 0.95)?;
/// assert!((found.share.unwrap_or(0.0) - 0.25).abs() < 1e-4);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct PhotonShare {
    /// Share of decisions that are right, 0 to 1.
    pub accuracy: f64,
    /// Confidence interval of the accuracy, 0 to 1.
    pub accuracy_interval: Interval,
    /// What the best decision reaches, Φ(d).
    pub accuracy_limit: f64,
    /// η; 0 for no better than guessing, `None` if every decision was right, which says nothing from above.
    pub share: Option<f64>,
    /// Lower end of its interval.
    pub share_low: f64,
    /// Upper end of it; `None` if there is none.
    pub share_high: Option<f64>,
    /// Whether the accuracy is surely above its limit, which no classifier's is: d is too small, or not of the same
    /// task.
    pub above_limit: bool,
}

impl PhotonShare {
    /// From the right ones of `trials` decisions between two equally likely classes (ties may count as half), where
    /// the statistical distance is `distance`; interval at `level`.
    ///
    /// # Errors
    /// No trials, more correct decisions than trials, a distance that is not positive, a level outside (0, 1).
    pub fn of(right: f64, trials: u64, distance: f64, level: f64) -> Result<Self> {
        check::positive("statistical distance", distance, "")?;
        if !(level > 0.0 && level < 1.0) {
            return Err(Error::out_of_range("confidence level", level, "", "above 0 and below 1"));
        }
        let n = check::positive("number of decisions", trials as f64, "")?;
        if !(0.0..=n).contains(&right) {
            let expected = format!("between 0 and the {trials} made");
            return Err(Error::out_of_range("number of correct decisions", right, "", expected));
        }
        let interval = Interval::wilson(right, trials, level);
        let share = |p: f64| -> Result<Option<f64>> {
            if p <= 0.5 {
                return Ok(Some(0.0));
            }
            if p >= 1.0 {
                return Ok(None);
            }
            Ok(Some((detection::distance_for_probability(p)? / distance).powi(2)))
        };
        // Wilson's lower end is below 1 for any finite number of trials.
        let low = share(interval.low)?.unwrap_or(0.0);
        Ok(Self {
            accuracy: right / n,
            accuracy_interval: interval,
            accuracy_limit: detection::probability(distance),
            share: share(right / n)?,
            share_low: low,
            share_high: share(interval.high)?,
            above_limit: low > 1.0,
        })
    }
}
