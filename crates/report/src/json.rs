//! The JSON of answers: every one is written here, so that its sentences are in the words of this package.

use crate::words;
use hadar::error::{Error, Result};
use hadar::words::{has_hidden, is_hidden};
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
    spoken(|| serde_json::to_string(answer)).map(seen)
}

/// Anything as JSON of a line a key.
///
/// # Errors
/// What is no JSON, which would be a bug.
pub fn pretty(answer: &impl Serialize) -> Result<String> {
    spoken(|| serde_json::to_string_pretty(answer)).map(seen)
}

/// The same JSON, letters that are not seen or change the order of others as `\u202e`. They are in its strings alone.
fn seen(text: String) -> String {
    if !has_hidden(&text) {
        return text;
    }
    let mut out = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        if is_hidden(letter) {
            letter.encode_utf16(&mut [0; 2]).iter().for_each(|unit| out.push_str(&format!("\\u{unit:04x}")));
        } else {
            out.push(letter);
        }
    }
    out
}

fn spoken<T>(write: impl FnOnce() -> serde_json::Result<T>) -> Result<T> {
    with_voice(words::voice, write)
        .map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_letter_that_is_not_seen_is_written_as_its_number() {
        let name = "gold\u{202e}\u{E0041}\u{7f}ä\n";
        let text = line(&name).unwrap();
        assert_eq!(text, "\"gold\\u202e\\udb40\\udc41\\u007fä\\n\"");
        assert_eq!(serde_json::from_str::<String>(&text).unwrap(), name);
    }
}
