//! Answers of a program against those of the vectors.

use hadar_evidence::reference::Extended;
use serde_json::Value;

/// What a program answers.
#[derive(Debug, Clone)]
pub(super) enum Found {
    Number(f64),
    Numbers(Vec<f64>),
    Word(String),
    None,
}

impl From<f64> for Found {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<&[f64]> for Found {
    fn from(values: &[f64]) -> Self {
        Self::Numbers(values.to_vec())
    }
}

impl From<Option<f64>> for Found {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Self::None, Self::Number)
    }
}

impl From<&Value> for Found {
    fn from(value: &Value) -> Self {
        match value {
            Value::Number(number) => Self::Number(number.as_f64().unwrap()),
            Value::Array(numbers) => {
                Self::Numbers(numbers.iter().map(|number| number.as_f64().unwrap()).collect())
            }
            Value::String(word) => Self::Word(word.clone()),
            _ => Self::None,
        }
    }
}

/// Which share of its tolerance an answer takes; above 1 it is wrong.
pub(super) fn share(found: &Found, answer: &Value) -> f64 {
    let one = |found: f64, exact: &Value| {
        let exact = Extended::parse(exact.as_str().unwrap());
        let tolerance = |key: &str| answer[key].as_f64().unwrap_or(0.0);
        let allowed =
            (tolerance("relative_tolerance") * exact.abs().to_f64()).max(tolerance("absolute_tolerance"));
        let error = (Extended::from(found) - exact).abs().to_f64();
        // No number is no answer.
        if error == 0.0 {
            0.0
        } else if error.is_nan() {
            f64::INFINITY
        } else {
            error / allowed
        }
    };
    let wrong = |right: bool| if right { 0.0 } else { f64::INFINITY };
    match (found, &answer["value"]) {
        (Found::Number(found), value @ Value::String(_)) => one(*found, value),
        (Found::Numbers(found), Value::Array(values)) if found.len() == values.len() => {
            found.iter().zip(values).map(|(found, value)| one(*found, value)).fold(0.0, f64::max)
        }
        (Found::Word(found), value) => wrong(value == found),
        (found, value) => wrong(matches!(found, Found::None) && value.is_null()),
    }
}

/// What came of all vectors of a topic.
#[derive(Debug, Default)]
pub(super) struct Verdict {
    pub(super) answers: usize,
    pub(super) wrong: Vec<String>,
    /// The largest share, and where.
    pub(super) worst: (f64, String),
}

impl Verdict {
    /// Every answer of a vector, none left out and none too many.
    pub(super) fn judge(&mut self, vector: &Value, found: &[(String, Found)]) {
        let asked = vector["answers"].as_object().unwrap();
        let id = vector["id"].as_str().unwrap();
        assert_eq!(asked.len(), found.len(), "{id}: {found:?}");
        for (name, found) in found {
            let share = share(found, asked.get(name).unwrap_or_else(|| panic!("{id}: no {name}")));
            let place = format!("{id} {name}");
            self.answers += 1;
            if share > 1.0 {
                self.wrong.push(format!("{place}: {found:?}, {share:.3e} of what is allowed"));
            }
            if share > self.worst.0 {
                self.worst = (share, place);
            }
        }
    }
}
