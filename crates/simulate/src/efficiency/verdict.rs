//! What is concluded from the intervals of variance and bias, and how sure it must be.

use super::Interval;
use hadar::error::{Error, Result, check};

/// When an estimator is said to reach its bound.
///
/// ```
/// use hadar_simulate::efficiency::Criteria;
/// let criteria = Criteria::default();
/// assert_eq!((criteria.level, criteria.margin, criteria.bias_share), (0.95, 1.1, 0.2));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Criteria {
    /// Confidence level of all intervals, in (0, 1).
    pub level: f64,
    /// Verdicts given together: each is at 1 − (1 − level)/together, so that all are right with probability `level`.
    pub together: usize,
    /// The interval of the ratio of variances must end below this.
    pub margin: f64,
    /// The interval of the bias must lie within ± this share of the bound's deviation; 0.2 adds 4 % to the square of
    /// the error.
    pub bias_share: f64,
}

impl Default for Criteria {
    fn default() -> Self {
        Self { level: 0.95, together: 1, margin: 1.1, bias_share: 0.2 }
    }
}

impl Criteria {
    pub(super) fn check(&self) -> Result<()> {
        if !(self.level > 0.0 && self.level < 1.0) {
            return Err(Error::out_of_range("confidence level", self.level, "", "above 0 and below 1"));
        }
        check::positive("verdicts given together", self.together as f64, "")?;
        if !(self.margin > 1.0 && self.margin.is_finite()) {
            return Err(Error::out_of_range("margin of the ratio of variances", self.margin, "", "above 1"));
        }
        check::positive("share of the deviation that bias may have", self.bias_share, "").map(drop)
    }

    pub(super) fn level_of_verdicts(&self) -> f64 {
        1.0 - (1.0 - self.level) / self.together as f64
    }
}

hadar::named! {
    /// What the estimates say of the bound.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Verdict {
        /// Variance within the margin above the bound and no bias to speak of.
        Reaches = "reaches the bound",
        /// Variance surely above the bound.
        Exceeds = "exceeds the bound",
        /// Variance surely below the bound: a biased estimator, parameters held within a range, or a wrong bound.
        Below = "below the bound",
        /// Variance as the bound, but a bias surely beyond its share of the deviation.
        Biased = "biased",
        /// Too few estimates to say.
        Undecided = "undecided",
    }
    /// In words.
    text
}

impl Verdict {
    /// From the interval of the ratio of variances, and that of the bias over the deviation of the bound.
    pub(super) fn of(ratio: Interval, bias: Interval, criteria: &Criteria) -> Self {
        let share = criteria.bias_share;
        if ratio.high < 1.0 {
            Self::Below
        } else if ratio.low > 1.0 {
            Self::Exceeds
        } else if bias.low > share || bias.high < -share {
            Self::Biased
        } else if ratio.high <= criteria.margin && bias.low >= -share && bias.high <= share {
            Self::Reaches
        } else {
            Self::Undecided
        }
    }
}
