//! Lines on stderr. Where nobody can take them (a full disk, a closed end) the answer is still given.

use std::io::Write as _;

/// Says a line, if anybody listens.
pub(super) fn say(text: &str) {
    drop(writeln!(std::io::stderr(), "{text}"));
}
