//! What is said of a report that was made again.

use super::Say;
use crate::verify::{Difference, EnvelopeFault, Verified};
use hadar::words;
use std::fmt::Write as _;

/// Differences of which the text tells.
const TOLD: usize = 20;

/// Whether a report is what its command makes, and where it is not.
#[must_use]
pub fn text(verified: &Verified) -> String {
    let (files, inputs) = (verified.files, verified.inputs);
    let mut text = if verified.verified {
        // Without that file its name and hash are only what the report says.
        let but = match verified.question_compared {
            true => "",
            false => "; the file of the question is not here, only the report's own copy of it",
        };
        format!(
            "Verified: all {files} files were made again, byte by byte, of {inputs} inputs that are as they were{but}.\n"
        )
    } else {
        let wrong = verified.differences.iter().filter(|one| !matches!(one, Difference::Program { .. }));
        format!(
            "Not verified: of {files} files and {inputs} inputs {} are not as the report says.\n",
            wrong.count()
        )
    };
    for difference in verified.differences.iter().take(TOLD) {
        let _ = writeln!(text, "  {}", difference.say());
    }
    if let Some(more) = verified.differences.len().checked_sub(TOLD).filter(|more| *more > 0) {
        let _ = writeln!(text, "  and {more} more");
    }
    if !verified.signed_by.is_empty() {
        let _ = writeln!(
            text,
            "The DSSE envelope holds this statement, signed by {}; whether the signature is valid must be checked with the tool that made it.",
            verified.signed_by.iter().map(|key| words::visible(named(key))).collect::<Vec<_>>().join(", ")
        );
    }
    let _ = writeln!(text, "The command that was given again: {}", verified.command);
    if !verified.strangers.is_empty() {
        let _ = writeln!(text, "Not of the report, and not looked at: {}", verified.strangers.join(", "));
    }
    text
}

/// A key by its name.
fn named(key: &str) -> &str {
    if key.is_empty() { "a key without a name" } else { key }
}

impl Say for EnvelopeFault {
    fn say(&self) -> String {
        match self {
            Self::NoEnvelope { why } => format!("it is no DSSE envelope: {why}"),
            Self::OtherType { found } => {
                format!("its payload is of type {found:?}, not application/vnd.in-toto+json")
            }
            Self::NoBase64 { why } => format!("its payload is no base64: {why}"),
            Self::OtherStatement => {
                "it holds another statement than certificate.intoto.json, byte by byte".into()
            }
            Self::Unsigned => "nobody signed it".into(),
        }
    }
}

impl Say for Difference {
    fn say(&self) -> String {
        let hash = |hash: &Option<String>| hash.clone().unwrap_or_else(|| "none".into());
        match self {
            Self::Missing { file } => format!("{file}: it is not there"),
            Self::Changed { file } => format!("{file}: it was changed since the report was written"),
            Self::Differs { file } => format!("{file}: made again it has another content"),
            Self::NotMade { file } => format!("{file}: the command makes no such file"),
            Self::Unlisted { file } => {
                format!("{file}: the command makes it, and the report does not list it")
            }
            Self::Input { path, was, is } => {
                format!("input {path}: its SHA-256 was {} and is {}", hash(was), hash(is))
            }
            Self::Demand { demanded, found } => {
                format!("the statement says {found}, and {demanded} is demanded")
            }
            Self::Envelope { fault } => format!("the DSSE envelope: {}", fault.say()),
            Self::Program { was, is } => format!("made by {was}; made again by {is}"),
        }
    }
}
