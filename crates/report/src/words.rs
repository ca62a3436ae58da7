//! What the program says: every sentence of an answer, each in one place.

pub mod warnings;

use hadar_study::spoken::Phrase;

/// What is said in a sentence.
pub trait Say {
    /// The sentence, or what stands in one.
    fn say(&self) -> String;
}

/// The sentence of a part of an answer, as its JSON has it.
#[must_use]
pub fn voice(phrase: Phrase<'_>) -> String {
    match phrase {
        Phrase::Warning(warning) => warning.say(),
        _ => String::new(),
    }
}
