//! How long an answer may take.

use crate::size_limit::Command;
use std::time::Duration;

/// Time for an answer, where no other limit is given.
const ANSWER: Duration = Duration::from_secs(60);
/// The same for a search of cameras.
const FIND: Duration = Duration::from_secs(120);
/// The same for an answer about a rule: every camera before every clause, in all scenes.
const RULE: Duration = Duration::from_secs(240);

/// How long an answer at a path may take where no other limit is given, and who gives those that take longer.
pub(crate) fn longest(path: &str) -> (Duration, Command) {
    match path {
        "/find" => (FIND, Command::Find),
        path if path.starts_with("/rule") => (RULE, Command::Rule),
        _ => (ANSWER, Command::Size),
    }
}
