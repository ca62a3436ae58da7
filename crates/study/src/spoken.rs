//! Answers are data, and whoever renders them supplies the words.
//!
//! The JSON of an answer has sentences in it, and this package knows none. A part of an answer that has a sentence serialises it through
//! `serialize` as a [`Phrase`], which the [`Voice`] of the one who writes puts into words: `hadar_report::words::voice` in every program
//! here. Whoever serialises without one gets the same keys, with `null` where a sentence would be. The parts themselves do not know that
//! they are spoken of: how they serialise stands here.

use crate::air_ranging::AirFinding;
use crate::companion::{Caveat, Unknown};
use crate::condition::Taken;
use crate::range::DepthFinding;
use crate::rule::{Certified, Definition, EmissivityError, IdealCamera, Quotable, WhoMeets};
use crate::warning::Warning;
use crate::{Condition, Finding};
use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::cell::Cell;

/// A part of an answer that has a sentence.
#[derive(Debug, Clone, Copy)]
pub enum Phrase<'a> {
    /// Ranging by air.
    AirFinding(&'a AirFinding),
    /// What the reader of a row of practice must know.
    Caveat(&'a Caveat),
    /// How sure a worst case is.
    Certified(&'a Certified),
    /// What a clause demands.
    Definition(&'a Definition),
    /// Ranging by stereo.
    DepthFinding(&'a DepthFinding),
    /// That errors of emissivities make up more than the distance.
    EmissivityError(&'a EmissivityError),
    /// The verdict on a camera.
    Finding(&'a Finding),
    /// That the camera which no other surpasses does not tell a pair.
    IdealCamera(&'a IdealCamera),
    /// What a 'yes' rests on.
    Condition(&'a Condition),
    /// A rule that can be quoted.
    Quotable(&'a Quotable),
    /// Why a row of practice has no number.
    Unknown(&'a Unknown),
    /// A remark.
    Warning(&'a Warning),
    /// Which cameras meet a rule.
    WhoMeets(&'a WhoMeets),
}

/// Puts a phrase into words.
pub type Voice = fn(Phrase<'_>) -> String;

thread_local! {
    static VOICE: Cell<Option<Voice>> = const { Cell::new(None) };
}

/// The voice before, which is given back at the end, also of a panic.
struct Before(Option<Voice>);

impl Drop for Before {
    fn drop(&mut self) {
        VOICE.set(self.0);
    }
}

/// Runs `write`, in which phrases are put into words by `voice`. The voice is that of this thread alone, and within another call the
/// inner one holds.
pub fn with_voice<T>(voice: Voice, write: impl FnOnce() -> T) -> T {
    let _before = Before(VOICE.replace(Some(voice)));
    write()
}

/// Serialises the sentence of a phrase; null where nobody gave a voice.
pub(crate) fn serialize<S: Serializer>(phrase: Phrase<'_>, serializer: S) -> Result<S::Ok, S::Error> {
    match VOICE.get() {
        Some(voice) => serializer.serialize_str(&voice(phrase)),
        None => serializer.serialize_none(),
    }
}

/// A phrase as a field of what is serialised by hand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spoken<'a>(pub(crate) Phrase<'a>);

impl Serialize for Spoken<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serialize(self.0, serializer)
    }
}

/// Serialises parts of an answer as their sentences.
macro_rules! sentences {
    ($($part:ident),+ $(,)?) => {$(
        impl Serialize for $part {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serialize(Phrase::$part(self), serializer)
            }
        }
    )+};
}

sentences!(
    AirFinding,
    Caveat,
    Definition,
    DepthFinding,
    EmissivityError,
    Finding,
    IdealCamera,
    Quotable,
    Unknown,
    WhoMeets,
);

impl Serialize for Condition {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let value = self.value();
        let fields = if value == Taken::Nothing { 5 } else { 6 };
        let mut object = serializer.serialize_struct("Condition", fields)?;
        object.serialize_field("code", &self.code())?;
        object.serialize_field("kind", self.kind().name())?;
        object.serialize_field("favourable", &self.favourable())?;
        object.serialize_field("figure", &self.figure())?;
        match value {
            Taken::Nothing => object.skip_field("value")?,
            value => object.serialize_field("value", &value)?,
        }
        object.serialize_field("sentence", &Spoken(Phrase::Condition(self)))?;
        object.end()
    }
}

impl Serialize for Certified {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Certified", 3)?;
        object.serialize_field("kind", &self.kind)?;
        object.serialize_field("statement", &Spoken(Phrase::Certified(self)))?;
        object.serialize_field("gap", &self.gap)?;
        object.end()
    }
}

impl Serialize for Warning {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Warning", 2)?;
        object.serialize_field("code", self.code().name())?;
        object.serialize_field("message", &Spoken(Phrase::Warning(self)))?;
        object.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(warning: &Warning) -> serde_json::Value {
        serde_json::to_value(warning).unwrap()["message"].clone()
    }

    #[test]
    fn a_sentence_is_in_the_voice_of_the_one_who_writes() {
        let warning = Warning::Blind;
        assert!(said(&warning).is_null());
        let outer: Voice = |phrase| match phrase {
            Phrase::Warning(warning) => format!("outer {}", warning.code().name()),
            _ => "another".into(),
        };
        with_voice(outer, || {
            assert_eq!(said(&warning), "outer blind");
            with_voice(|_| "inner".into(), || assert_eq!(said(&warning), "inner"));
            let broken =
                std::panic::catch_unwind(|| with_voice(|_| "broken".into(), || panic!("on purpose")));
            assert!(broken.is_err());
            assert_eq!(said(&warning), "outer blind");
            // Another thread has a voice of its own.
            std::thread::scope(|scope| scope.spawn(|| assert!(said(&warning).is_null())).join()).unwrap();
        });
        assert!(said(&warning).is_null());
    }
}
