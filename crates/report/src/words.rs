//! What the program says: every sentence of an answer, each in one place.

mod air_ranging;
mod classes;
mod companion;
mod conditions;
mod demand;
pub mod probability;
mod range;
pub(crate) mod rule;
pub(crate) mod shortfall;
pub mod size;
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
        Phrase::AirFinding(it) => it.say(),
        Phrase::Caveat(it) => it.say(),
        Phrase::Certified(it) => it.say(),
        Phrase::Definition(it) => it.say(),
        Phrase::DepthFinding(it) => it.say(),
        Phrase::EmissivityError(it) => it.say(),
        Phrase::Finding(it) => it.say(),
        Phrase::IdealCamera(it) => it.say(),
        Phrase::Proviso(it) => it.say(),
        Phrase::Quotable(it) => it.say(),
        Phrase::Unknown(it) => it.say(),
        Phrase::WhoMeets(it) => it.say(),
        Phrase::Warning(it) => it.say(),
    }
}
