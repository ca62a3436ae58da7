//! Warnings, conditions and mistakes as a page shows them.

use hadar::error::{Error, Result};
use hadar_report::json;
use hadar_report::words::Say;
use hadar_report::words::warnings::of_code;
use hadar_study::Condition;
use hadar_study::warning::Warning;
use serde::Serialize;

/// A warning or a condition as it is shown.
#[derive(Debug, Serialize)]
pub(crate) struct Said {
    code: String,
    message: String,
    remedy: String,
}

impl From<&Warning> for Said {
    fn from(warning: &Warning) -> Self {
        let code = warning.code();
        Self { code: code.name().into(), message: warning.say(), remedy: of_code(code).remedy.into() }
    }
}

impl From<&Condition> for Said {
    fn from(condition: &Condition) -> Self {
        let message =
            if condition.favourable() { format!("only if {}", condition.say()) } else { condition.say() };
        Self { code: condition.code(), message, remedy: condition.figure() }
    }
}

/// What is wrong with a scenario or a rule, and where.
#[derive(Debug, Serialize)]
pub(crate) struct Told {
    message: String,
    line: Option<usize>,
    key: Option<String>,
}

impl From<&Error> for Told {
    fn from(error: &Error) -> Self {
        let place = match error {
            Error::At { place, .. } => place.clone(),
            _ => Default::default(),
        };
        Self { message: error.to_string(), line: place.line, key: place.key }
    }
}

/// What the page gets.
#[derive(Debug, Serialize)]
struct Answered<T> {
    /// The answer; none where there is an error.
    answer: Option<T>,
    /// What is wrong.
    error: Option<Told>,
}

/// An answer, or what is wrong, as JSON.
pub(crate) fn told<T: Serialize>(answer: Result<T>) -> Result<String> {
    json::line(&match answer {
        Ok(answer) => Answered { answer: Some(answer), error: None },
        Err(error) => Answered { answer: None, error: Some(Told::from(&error)) },
    })
}
