//! A sweep: what was asked, what is there of its rows, which columns matter.

use super::gathered::Gathered;
use hadar_study::sweep::Question;

/// A sweep with what is there of its rows.
#[derive(Debug)]
pub struct Swept {
    /// What was asked of every row.
    pub question: Question,
    /// The columns: `row`, what was varied, `status`, `message`, then those of the answers.
    pub gathered: Gathered,
    /// Columns of answers that were chosen, in their order; all where empty.
    pub chosen: Vec<String>,
    /// Rows of earlier runs or of other shards.
    pub kept: usize,
    /// How many of those were computed again and found the same.
    pub recomputed: usize,
}

impl Swept {
    /// Columns that are told of and drawn: those that were chosen, else what the question is about.
    pub(crate) fn drawn(&self) -> Vec<&str> {
        if !self.chosen.is_empty() {
            return self.gathered.names(&self.chosen).unwrap_or_default();
        }
        let is_there = |name: &&str| {
            self.gathered.values(name).is_some_and(|cells| cells.iter().any(|cell| cell.number().is_some()))
        };
        let headline = self.question.headline().iter().copied().find(is_there);
        let met = self.gathered.values("verdict.met").map(|_| "verdict.met");
        headline.into_iter().chain(met).collect()
    }
}
