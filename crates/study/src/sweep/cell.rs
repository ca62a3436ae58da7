//! A value of a table.

use serde_json::{Number, Value};
use std::sync::Arc;

/// A value of a table.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Cell {
    /// None.
    #[default]
    Empty,
    /// Yes or no.
    Boolean(bool),
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f64),
    /// A text.
    Text(Arc<str>),
}

impl Cell {
    /// What is no list and no table.
    #[must_use]
    pub fn of_json(value: &Value) -> Option<Self> {
        match value {
            Value::Null => Some(Self::Empty),
            Value::Bool(value) => Some(Self::Boolean(*value)),
            Value::Number(number) => Some(match (number.as_i64(), number.as_f64()) {
                (Some(whole), _) => Self::Integer(whole),
                (None, Some(number)) => Self::Number(number),
                (None, None) => Self::Empty,
            }),
            Value::String(text) => Some(Self::Text(text.as_str().into())),
            Value::Array(_) | Value::Object(_) => None,
        }
    }

    /// As JSON, which has no number that is not finite.
    #[must_use]
    pub fn to_json(&self) -> Value {
        match self {
            Self::Empty => Value::Null,
            Self::Boolean(value) => Value::Bool(*value),
            Self::Integer(whole) => Value::from(*whole),
            Self::Number(number) => Number::from_f64(*number).map_or(Value::Null, Value::Number),
            Self::Text(text) => Value::String(text.as_ref().to_owned()),
        }
    }

    /// Its number, if it is one.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Integer(whole) => Some(*whole as f64),
            Self::Number(number) => Some(*number),
            Self::Empty | Self::Boolean(_) | Self::Text(_) => None,
        }
    }
}
