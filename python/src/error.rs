//! Errors of the library as exceptions, with the same message as the command prints.

use hadar::Error;
use pyo3::PyErr;
use pyo3::exceptions::PyValueError;

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
