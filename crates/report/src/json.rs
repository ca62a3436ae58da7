//! The JSON of answers: every one is written here, so that its sentences are in the words of this package.

use crate::words;
use hadar::error::{Error, Result};
use hadar_study::spoken::with_voice;
use serde::Serialize;
use serde_json::Value;

/// Anything as JSON in memory.
///
/// # Errors
/// What is no JSON, which would be a bug.
pub fn value(answer: &impl Serialize) -> Result<Value> {
    spoken(|| serde_json::to_value(answer))
}

/// Anything as JSON of one line.
///
/// # Errors
/// What is no JSON, which would be a bug.
pub fn line(answer: &impl Serialize) -> Result<String> {
    spoken(|| serde_json::to_string(answer))
}

/// Anything as JSON of a line a key.
///
/// # Errors
/// What is no JSON, which would be a bug.
pub fn pretty(answer: &impl Serialize) -> Result<String> {
    spoken(|| serde_json::to_string_pretty(answer))
}

fn spoken<T>(write: impl FnOnce() -> serde_json::Result<T>) -> Result<T> {
    with_voice(words::voice, write)
        .map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))
}
