//! What the program says: every sentence, each in one place, those of a command in its file or folder.
//!
//! A command has its sentences as [`Say`], its text, and what stands below its pictures (`captions`); [`text`] has what several commands
//! say, [`warnings`] a file for each topic.

pub(crate) mod air_ranging;
pub(crate) mod calibrate;
pub(crate) mod cameras;
pub(crate) mod classes;
pub(crate) mod companion;
pub(crate) mod conditions;
pub(crate) mod decompose;
mod demand;
pub(crate) mod diff;
pub mod find;
pub(crate) mod identify;
pub(crate) mod library;
pub(crate) mod page;
pub(crate) mod pictures;
pub mod probability;
pub(crate) mod range;
pub(crate) mod render;
pub(crate) mod rule;
mod safety;
pub(crate) mod several;
pub(crate) mod shortfall;
pub(crate) mod simulate;
pub mod size;
pub(crate) mod sweep;
pub mod text;
pub(crate) mod verify;
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
        Phrase::Condition(it) => it.say(),
        Phrase::Definition(it) => it.say(),
        Phrase::DepthFinding(it) => it.say(),
        Phrase::EmissivityError(it) => it.say(),
        Phrase::Finding(it) => it.say(),
        Phrase::IdealCamera(it) => it.say(),
        Phrase::Quotable(it) => it.say(),
        Phrase::Unknown(it) => it.say(),
        Phrase::WhoMeets(it) => it.say(),
        Phrase::Warning(it) => it.say(),
    }
}
