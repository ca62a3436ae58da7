//! Answers with as many digits as are trusted, and the tolerance within which another program's must be.
//!
//! A number f answers v where |f − v| ≤ max(r|v|, a), r the relative and a the absolute tolerance; a list does where each of
//! its numbers does.

use super::json::Json;
use crate::reference::Extended;

/// Digits of what is computed in 512 bits throughout.
const DIGITS: usize = 25;
/// Digits of what has been rounded to doubles on the way, or is the place of a minimum.
const DIGITS_OF_DOUBLES: usize = 14;
/// What a double leaves of a number, with some steps of a careful computation.
const STEPS: f64 = 1e-15;

/// A question with its answers.
#[derive(Debug, Clone)]
pub struct Vector {
    /// Its name within the topic.
    pub id: &'static str,
    /// What is hard about it.
    pub about: &'static str,
    pub(super) inputs: Json,
    /// What comes out, by name.
    pub answers: Vec<(String, Answer)>,
}

/// What comes out, and how nearly.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    value: Json,
    relative: f64,
    absolute: f64,
}

/// What doubles can do at hcν/kT = x: a rounding of x alone costs x of them.
pub(super) fn reach(x: f64) -> f64 {
    STEPS * (10.0 + x)
}

/// 1, 2 or 5 times a power of ten, not below.
fn rounded_up(tolerance: f64) -> f64 {
    let exponent = tolerance.log10().floor() as i32;
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| format!("{step}e{exponent}").parse().unwrap_or(tolerance));
    steps.into_iter().find(|step| *step >= tolerance * (1.0 - 1e-12)).unwrap_or(tolerance)
}

impl Answer {
    /// A number, to a share of itself.
    pub(super) fn one(value: &Extended, relative: f64) -> Self {
        Self::of(Json::Text(value.to_decimal(DIGITS)), relative, 0.0)
    }

    /// Numbers, each to a share of itself.
    pub(super) fn many(values: &[Extended], relative: f64) -> Self {
        let digits = values.iter().map(|value| Json::Text(value.to_decimal(DIGITS)));
        Self::of(Json::List(digits.collect()), relative, 0.0)
    }

    /// A number that has passed through doubles.
    pub(super) fn double(value: f64, relative: f64) -> Self {
        Self::of(Json::Text(Extended::from(value).to_decimal(DIGITS_OF_DOUBLES)), relative, 0.0)
    }

    /// Numbers that have passed through doubles.
    pub(super) fn doubles(values: &[f64], relative: f64) -> Self {
        let digits = values.iter().map(|value| Extended::from(*value).to_decimal(DIGITS_OF_DOUBLES));
        Self::of(Json::List(digits.map(Json::Text).collect()), relative, 0.0)
    }

    /// A word.
    pub(super) fn text(value: &str) -> Self {
        Self::of(value.into(), 0.0, 0.0)
    }

    /// There is none: no value does what is asked.
    pub(super) fn none() -> Self {
        Self::of(Json::Null, 0.0, 0.0)
    }

    /// The same also where it is no farther off than this.
    pub(super) fn or_within(self, absolute: f64) -> Self {
        Self { absolute, ..self }
    }

    fn of(value: Json, relative: f64, absolute: f64) -> Self {
        let relative = if relative > 0.0 { rounded_up(relative) } else { 0.0 };
        Self { value, relative, absolute }
    }

    fn json(&self) -> Json {
        let mut entries = vec![("value".to_owned(), self.value.clone())];
        if self.relative > 0.0 {
            entries.push(("relative_tolerance".into(), self.relative.into()));
        }
        if self.absolute > 0.0 {
            entries.push(("absolute_tolerance".into(), self.absolute.into()));
        }
        Json::Object(entries)
    }
}

impl Vector {
    pub(super) fn new<const N: usize>(
        id: &'static str,
        about: &'static str,
        inputs: Json,
        answers: [(&str, Answer); N],
    ) -> Self {
        let answers = answers.into_iter().map(|(name, answer)| (name.to_owned(), answer)).collect();
        Self { id, about, inputs, answers }
    }

    pub(super) fn json(&self) -> Json {
        let answers = self.answers.iter().map(|(name, answer)| (name.clone(), answer.json()));
        Json::object([
            ("id", self.id.into()),
            ("about", self.about.into()),
            ("inputs", self.inputs.clone()),
            ("answers", Json::Object(answers.collect())),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_are_rounded_up_to_one_digit() {
        for (tolerance, expected) in
            [(1e-15, 1e-15), (1.1e-15, 2e-15), (4.9e-12, 5e-12), (5.1e-12, 1e-11), (0.3, 0.5)]
        {
            assert_eq!(rounded_up(tolerance), expected);
        }
    }
}
