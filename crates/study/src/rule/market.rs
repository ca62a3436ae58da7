//! Which part of a market meets a rule, where its cameras have shares.

use super::clauses::RuleAnswer;
use crate::condition::Condition;
use hadar_scenario::rule::Verdict;

/// Shares of a market; what is not stated is of no camera of the rule.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
#[non_exhaustive]
pub struct Market {
    /// Of cameras that meet the rule, unconditionally or under conditions that are accepted.
    pub meets: f64,
    /// Of those that meet it under conditions.
    pub meets_if: f64,
    /// Of those that may or may not.
    pub undecided: f64,
    /// Of those that do not.
    pub fails: f64,
    /// Share of the market that belongs to no camera of the rule, 0 to 1.
    pub not_stated: f64,
}

impl RuleAnswer {
    /// Which part of the market meets the rule; `None` where no camera has a share.
    #[must_use]
    pub fn market(&self) -> Option<Market> {
        let shares: Vec<Option<f64>> = self.rule.cameras.iter().map(|camera| camera.share).collect();
        if shares.iter().all(Option::is_none) {
            return None;
        }
        let mut market = Market::default();
        for (camera, share) in self.cameras.iter().zip(&shares) {
            let open = Condition::unaccepted(&camera.conditions, &self.accepted).next().is_some();
            let part = match (camera.verdict, open) {
                (Verdict::Meets, false) => &mut market.meets,
                (Verdict::Meets, true) => &mut market.meets_if,
                (Verdict::Undecided, _) => &mut market.undecided,
                (Verdict::Fails, _) => &mut market.fails,
            };
            *part += share.unwrap_or(0.0);
        }
        let stated: f64 = shares.iter().flatten().sum();
        market.not_stated = (1.0 - stated).max(0.0);
        Some(market)
    }
}
