//! The parts of an answer to a rule that are sentences in JSON.

use super::clauses::Definition;
use super::results::{Certified, EmissivityError, IdealCamera, Quotable, WhoMeets};
use crate::spoken::{self, Phrase, Spoken};
use serde::ser::{Serialize, SerializeStruct, Serializer};

impl Serialize for Certified {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Certified", 3)?;
        object.serialize_field("kind", &self.kind)?;
        object.serialize_field("statement", &Spoken(Phrase::Certified(self)))?;
        object.serialize_field("gap", &self.gap)?;
        object.end()
    }
}

impl Serialize for WhoMeets {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        spoken::serialize(Phrase::WhoMeets(self), serializer)
    }
}

impl Serialize for Quotable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        spoken::serialize(Phrase::Quotable(self), serializer)
    }
}

impl Serialize for Definition {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        spoken::serialize(Phrase::Definition(self), serializer)
    }
}

impl Serialize for IdealCamera {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        spoken::serialize(Phrase::IdealCamera(self), serializer)
    }
}

impl Serialize for EmissivityError {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        spoken::serialize(Phrase::EmissivityError(self), serializer)
    }
}
