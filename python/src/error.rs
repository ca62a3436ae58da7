//! Errors of the library as exceptions, with the same message as the command prints.

use hadar::Error;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyString;

pyo3::create_exception!(
    hadar_limits,
    HadarError,
    PyValueError,
    "Something that hadar cannot take: what was found, where, and what to write instead."
);

/// As an exception.
pub(crate) fn raised(error: Error) -> PyErr {
    HadarError::new_err(error.to_string())
}

/// A value as Python writes it, if that is short, else its type.
pub(crate) fn shown(given: &Bound<'_, PyAny>) -> String {
    const LONGEST: usize = 60;
    let kind =
        || given.get_type().name().map_or_else(|_| "?".to_owned(), |name| format!("a value of type {name}"));
    // Of lists and arrays only the type is sure to be short.
    let written = given.len().is_err() || given.is_instance_of::<PyString>();
    let text = written.then(|| given.repr().ok()).flatten().map(|text| text.to_string());
    text.filter(|text| text.len() <= LONGEST).unwrap_or_else(kind)
}

/// One of some names, or an error that lists those it resembles.
pub(crate) fn named<T: Copy>(
    kind: &'static str,
    given: &str,
    all: &[T],
    name: impl Fn(T) -> &'static str,
) -> hadar::Result<T> {
    let found = all.iter().copied().find(|one| name(*one) == given);
    found.ok_or_else(|| {
        let known = all.iter().map(|one| name(*one)).collect::<Vec<_>>();
        match Error::unknown_name(kind, given, known.iter().copied()) {
            Error::UnknownName { nearest, .. } if nearest.is_empty() => Error::malformed(
                format!("there is no {kind} `{given}`"),
                format!("take one of {}", known.join(", ")),
            ),
            error => error,
        }
    })
}
