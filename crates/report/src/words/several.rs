//! Several scenarios asked the same, in words.

/// A verdict that hangs on something, which the answer itself says.
pub(crate) const YES_IF: &str = "yes, if";

/// A verdict that what is known does not settle.
pub(crate) const UNDECIDED: &str = "undecided";

/// The verdict of a rule that does not hold on the day.
pub(crate) const NOT_IN_FORCE: &str = "no, not in force";

/// What the 'yes' of a scenario rests on, by all of its codes.
pub(crate) fn only_if(scenario: &str, codes: &str) -> String {
    format!("{scenario}: yes only if {codes}")
}

/// Below a table in which some rows have no answer.
pub(crate) fn unanswered(failed: usize, all: usize) -> String {
    format!("{failed} of {all} scenarios without an answer.")
}
