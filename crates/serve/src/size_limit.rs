//! What is larger than a page computes: some seconds of work. Larger questions are for the command.

use crate::guard::Refusal;
use hadar::error::{Error, Result};
use hadar_study::Study;
use hyper::StatusCode;

/// Bands times alternatives.
const MOST_SPECTRAL_VALUES: usize = 100_000;
/// Objects of the surroundings: the search over their lighting grows steeply with them.
const MOST_SURROUNDINGS: usize = 8;
/// Cameras times clauses of a rule.
const MOST_LINES: usize = 100;

/// Who answers what is too large, by what it is called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Command {
    Size,
    Rule,
    Find,
}

impl Command {
    /// What is said of a question that takes too long.
    pub(crate) const fn takes_too_long(self) -> Refusal {
        let said = match self {
            Self::Size => {
                "this question takes longer than a page waits; ask `hadar size` with the scenario of this page, or start `hadar serve` \
                 with a longer --time-limit"
            }
            Self::Find => {
                "this search takes longer than a page waits; run `hadar find` with a question of fewer cameras, or start `hadar serve` with \
                 a longer --time-limit"
            }
            Self::Rule => {
                "this rule takes longer than a page waits; ask `hadar rule` with the rule of this page, or start `hadar serve` with a \
                 longer --time-limit"
            }
        };
        Refusal(StatusCode::SERVICE_UNAVAILABLE, said)
    }

    /// What to do instead of a question that is too large.
    const fn instead(self) -> &'static str {
        match self {
            Self::Size => "take fewer, or ask `hadar size` with the scenario of this page",
            Self::Find => "take fewer, or run `hadar find` with a question of your own",
            Self::Rule => "take fewer, or ask `hadar rule` with the rule of this page",
        }
    }
}

fn refused(found: String, by: Command) -> Error {
    Error::malformed(found, by.instead())
}

/// Refuses too many objects of the surroundings.
pub(crate) fn surroundings(count: usize, by: Command) -> Result<()> {
    if count <= MOST_SURROUNDINGS {
        return Ok(());
    }
    Err(refused(format!("{count} objects of the surroundings are more than this page computes"), by))
}

/// Refuses too many bands of too many alternatives.
pub(crate) fn bands(study: &Study, by: Command) -> Result<()> {
    let (bands, alternatives) = (study.bands().len(), study.alternatives().len());
    if bands.saturating_mul(alternatives) <= MOST_SPECTRAL_VALUES {
        return Ok(());
    }
    Err(refused(format!("{bands} bands of {alternatives} alternatives are more than this page computes"), by))
}

/// Refuses too many cameras before too many clauses.
pub(crate) fn lines(cameras: usize, clauses: usize) -> Result<()> {
    if cameras.saturating_mul(clauses) <= MOST_LINES {
        return Ok(());
    }
    let found = format!("{cameras} cameras before {clauses} clauses are more than this page computes");
    Err(refused(found, Command::Rule))
}
