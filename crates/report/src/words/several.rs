//! Several scenarios asked the same, in words.

/// Below a table in which some rows have no answer.
pub(crate) fn unanswered(failed: usize, all: usize) -> String {
    format!("{failed} of {all} scenarios without an answer.")
}
