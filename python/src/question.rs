//! Scenarios and rules as Python says them: a file, text, or a dict.

use crate::error::raised;
use crate::quantity::{as_written, parts, refuse_masked};
use hadar::error::{Error, Result};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// No scenario is as deep, and Rust's stack deeper.
const DEEPEST: usize = 32;

/// What is asked, before it is read.
#[derive(Debug, Clone)]
pub(crate) enum Question {
    File(PathBuf),
    Text(String),
    /// A dict as text, whose lines nobody has seen.
    Dict(String),
}

impl Question {
    /// A path-like object is a file; so is a string on one line without `=`, or one that ends in `.toml`. Any other is TOML.
    pub(crate) fn of(given: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(dict) = given.cast::<PyDict>() {
            let text = toml::to_string(&table(dict, "", DEEPEST)?);
            let text = text.map_err(|error| {
                raised(Error::malformed(
                    format!("the dict cannot be written as TOML ({error})"),
                    "use plain values",
                ))
            })?;
            return Ok(Self::Dict(text));
        }
        match given.extract::<String>() {
            Ok(text) if text.contains('\n') || text.contains('=') && !text.ends_with(".toml") => {
                Ok(Self::Text(text))
            }
            Ok(path) => Ok(Self::File(path.into())),
            Err(_) => given
                .extract::<PathBuf>()
                .map(Self::File)
                .map_err(|_| PyTypeError::new_err("a scenario is a path, TOML text or a dict of its tables")),
        }
    }

    /// Reads it; relative paths in it start from its folder, or from the current one.
    pub(crate) fn read<T>(
        &self,
        of_file: impl FnOnce(&Path) -> Result<T>,
        of_text: impl FnOnce(&str, Option<&Path>) -> Result<T>,
    ) -> Result<T> {
        match self {
            Self::File(path) => of_file(path),
            Self::Text(text) | Self::Dict(text) => of_text(text, None),
        }
    }

    /// An error as it is about what was given: lines of a dict are none.
    pub(crate) fn told(&self, error: Error) -> Error {
        match (self, error) {
            (Self::Dict(_), Error::At { mut place, source }) => {
                place.line = None;
                match place.key {
                    None if place.path.is_none() => *source,
                    _ => Error::At { place, source },
                }
            }
            (_, error) => error,
        }
    }
}

fn table(dict: &Bound<'_, PyDict>, key: &str, deepest: usize) -> PyResult<Table> {
    let mut table = Table::new();
    for (name, value) in dict {
        let Ok(name) = name.extract::<String>() else {
            let found = format!("{key}: a key {} that is no text", name.repr()?);
            return Err(raised(Error::malformed(found, "name tables and keys by strings")));
        };
        let full = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
        table.insert(name, of_object(&value, &full, deepest)?);
    }
    Ok(table)
}

/// Plain values; numbers of NumPy, paths and days are taken for what they say.
fn of_object(given: &Bound<'_, PyAny>, key: &str, deepest: usize) -> PyResult<Value> {
    let Some(deepest) = deepest.checked_sub(1) else {
        let found = format!("tables and lists more than {DEEPEST} deep");
        return Err(raised(
            Error::malformed(found, "write no dict or list that contains itself").for_key(key),
        ));
    };
    refuse_masked(given, key)?;
    let items = |items: Vec<Bound<'_, PyAny>>| -> PyResult<Value> {
        let each = items.iter().enumerate().map(|(i, item)| of_object(item, &format!("{key}[{i}]"), deepest));
        Ok(Value::Array(each.collect::<PyResult<_>>()?))
    };
    if let Ok(dict) = given.cast::<PyDict>() {
        return table(dict, key, deepest).map(Value::Table);
    }
    if given.is_instance_of::<PyBool>() {
        return given.extract().map(Value::Boolean);
    }
    if given.is_instance_of::<PyString>() {
        return given.extract().map(Value::String);
    }
    if given.is_instance_of::<PyInt>() {
        // What is larger than a file's whole numbers is a number all the same.
        let whole = given.extract().map(Value::Integer);
        return whole.or_else(|_| given.extract().map(Value::Float)).map_err(|_| {
            let found = "a whole number that is too large";
            raised(Error::malformed(found, "give one below 1e308").for_key(key))
        });
    }
    if given.is_instance_of::<PyFloat>() {
        return given.extract().map(Value::Float);
    }
    if given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() {
        return items(given.try_iter()?.collect::<PyResult<_>>()?);
    }
    if let Some(parts) = parts(given)? {
        let number = match of_object(&parts.values, key, deepest)? {
            Value::Integer(number) => number as f64,
            Value::Float(number) => number,
            _ => {
                let found = format!("an array in `{}`", parts.unit);
                let instead = "write a list of texts, a number and its unit in each";
                return Err(raised(Error::malformed(found, instead).for_key(key)));
            }
        };
        let (number, unit) = as_written(&parts, number)?;
        return Ok(Value::String(format!("{number} {unit}")));
    }
    if given.hasattr("tolist")? {
        return of_object(&given.call_method0("tolist")?, key, deepest);
    }
    if given.hasattr("isoformat")? {
        let text: String = given.call_method0("isoformat")?.extract()?;
        if let Ok(day) = text.parse() {
            return Ok(Value::Datetime(day));
        }
    }
    if given.hasattr("__fspath__")? {
        let text = given.extract::<PathBuf>()?.to_string_lossy().into_owned();
        return Ok(Value::String(text));
    }
    let found = match given.is_none() {
        true => "None".to_owned(),
        false => format!("a value of type {}", given.get_type().name()?),
    };
    let instead = "leave the key out, or write text, a number, a truth value, a list or a dict";
    Err(raised(Error::malformed(found, instead).for_key(key)))
}
