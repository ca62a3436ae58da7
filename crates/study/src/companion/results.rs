//! A companion table as data: rows of a kind, with values, the conditions that they hold under, a caveat, or why there is no value.

use super::measure::{Caveat, Measure, Unknown};
use hadar::policy::practice::ObserverTask;
use serde::ser::{Serialize, SerializeStruct, Serializer};

/// What sizing practice says of a camera, for comparison with what is proved.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Companion {
    /// The camera; `None` without one.
    pub camera: Option<String>,
    /// Critical dimension of the target, m.
    pub size_m: Option<f64>,
    /// Distance of the target from the camera, m.
    pub distance_m: Option<f64>,
    /// The rows, kind by kind.
    pub rows: Vec<CompanionRow>,
}

impl Companion {
    /// Rows of a measure.
    pub fn of_measure(&self, measure: Measure) -> impl Iterator<Item = &CompanionRow> {
        self.rows.iter().filter(move |row| row.measure == measure)
    }
}

impl Serialize for Companion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut out = serializer.serialize_struct("Companion", 5)?;
        out.serialize_field("camera", &self.camera)?;
        out.serialize_field("size_m", &self.size_m)?;
        out.serialize_field("distance_m", &self.distance_m)?;
        out.serialize_field("rows", &self.rows)?;
        out.serialize_field("caveats", &Caveats)?;
        out.end()
    }
}

/// What the codes of caveats mean.
struct Caveats;

impl Serialize for Caveats {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(Caveat::ALL.iter().map(|caveat| (caveat.code(), *caveat)))
    }
}

/// A condition that a value holds under.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Condition {
    /// Its unit is in its name.
    Number(f64),
    /// A name.
    Text(String),
}

/// One row.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CompanionRow {
    /// Name of the measure that the row gives.
    pub measure: Measure,
    /// What an observer is to do, where that matters.
    pub task: Option<ObserverTask>,
    /// Values, as many as the measure has quantities; or why there are none.
    pub values: Result<Vec<f64>, Unknown>,
    /// What they hold under, by name with the unit in it.
    pub conditions: Vec<(&'static str, Condition)>,
}

impl CompanionRow {
    pub(super) const fn new(measure: Measure, task: Option<ObserverTask>) -> Self {
        Self { measure, task, values: Err(Unknown::NotCompared), conditions: Vec::new() }
    }

    pub(super) fn with(self, values: Result<Vec<f64>, Unknown>) -> Self {
        Self { values, ..self }
    }

    pub(super) fn under(mut self, name: &'static str, value: f64) -> Self {
        self.conditions.push((name, Condition::Number(value)));
        self
    }

    pub(super) fn of(mut self, name: &'static str, text: &str) -> Self {
        self.conditions.push((name, Condition::Text(text.to_owned())));
        self
    }

    /// The value of a quantity of the measure, where it is known.
    #[must_use]
    pub fn value(&self, quantity: &str) -> Option<f64> {
        self.named().find(|(name, _)| *name == quantity).and_then(|(_, value)| value)
    }

    /// The number of a condition.
    #[must_use]
    pub fn condition(&self, name: &str) -> Option<f64> {
        self.conditions.iter().find(|(of, _)| *of == name).and_then(|(_, condition)| match condition {
            Condition::Number(number) => Some(*number),
            Condition::Text(_) => None,
        })
    }

    /// Quantities with their values.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, Option<f64>)> + '_ {
        let values = self.values.as_ref().ok();
        let value = move |i: usize| values.and_then(|values| values.get(i).copied());
        self.measure.quantities().iter().enumerate().map(move |(i, name)| (*name, value(i)))
    }

    /// Why there are no values.
    #[must_use]
    pub fn unknown(&self) -> Option<Unknown> {
        self.values.as_ref().err().copied()
    }
}

/// Pairs as an object, in their order.
struct Named<'a, V>(&'a [(&'static str, V)]);

impl<V: Serialize> Serialize for Named<'_, V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (*name, value)))
    }
}

impl Serialize for CompanionRow {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let values: Vec<_> = self.named().collect();
        let mut out = serializer.serialize_struct("CompanionRow", 8)?;
        out.serialize_field("kind", self.measure.kind().code())?;
        out.serialize_field("code", self.measure.code())?;
        out.serialize_field("task", &self.task)?;
        out.serialize_field("values", &Named(&values))?;
        out.serialize_field("conditions", &Named(&self.conditions))?;
        out.serialize_field("caveat", self.measure.caveat().code())?;
        out.serialize_field("unknown", &self.unknown().map(Unknown::code))?;
        out.serialize_field("reason", &self.unknown())?;
        out.end()
    }
}
