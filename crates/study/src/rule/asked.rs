//! What can be asked of a rule.

use hadar::demand::Skipping;
use hadar_scenario::Date;

/// What is asked of a rule.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RuleAsked {
    /// How much of an answer.
    pub extent: Extent,
    /// Whether proofs may spare work.
    pub skipping: Skipping,
    /// Whether clauses that hardly differ may share their worst scenes: margins then are within a thousandth of what each alone finds.
    pub nearly_alike: bool,
    /// Seed of the scenes that are drawn for the share no camera can do.
    pub seed: u64,
    /// The day that is asked about.
    pub on: Option<Date>,
    /// Codes of conditions that are accepted ([`crate::Condition::code`]).
    pub accepted: Vec<String>,
}

/// How much of an answer is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Extent {
    /// All of it.
    #[default]
    Everything,
    /// Verdicts and margins, without the share that no camera can do.
    Margins,
    /// Only which cameras meet it: a camera that fails is left at the first scene that shows it.
    Verdicts,
}
