//! Keywords of the commands, read from dicts; what cannot be is refused by its name.

use crate::error::{raised, shown};
use crate::threads::Threads;
use hadar::Error;
use pyo3::prelude::*;
use std::path::PathBuf;

/// What can be asked for, and what is to be written for it.
pub(crate) trait Wanted: for<'a, 'py> FromPyObject<'a, 'py> {
    const INSTEAD: &'static str;
}

macro_rules! wanted {
    ($($kind:ty: $instead:expr,)*) => { $(impl Wanted for $kind { const INSTEAD: &'static str = $instead; })* };
}

wanted! {
    bool: "give True or False",
    u64: "give a whole number from 0 to 2^64 - 1",
    usize: "give a whole number from 0 to 2^64 - 1",
    Option<usize>: "give a whole number from 0 to 2^64 - 1, or None",
    Option<Threads>: Threads::INSTEAD,
    f64: "give a number",
    Option<f64>: "give a number, or None",
    Vec<f64>: "give a list of numbers",
    String: "give text",
    Option<String>: "give text, or None",
    Vec<String>: "give a list of texts",
    Vec<PathBuf>: "give a list of paths",
    Option<Py<PyAny>>: "give a function, or None",
}

/// One of them, by its name.
pub(crate) fn keyword<T: Wanted>(given: &Borrowed<'_, '_, PyAny>, name: &str) -> PyResult<T> {
    let value = given.get_item(name)?;
    let refused = || Error::malformed(format!("{name}: {}", shown(&value)), T::INSTEAD);
    value.extract().map_err(|_| raised(refused()))
}

/// A struct of keywords.
macro_rules! asked {
    ($(#[$said:meta])* $name:ident { $($field:ident: $kind:ty,)* }) => {
        $(#[$said])*
        pub(crate) struct $name { $($field: $kind,)* }

        impl FromPyObject<'_, '_> for $name {
            type Error = PyErr;

            fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
                Ok(Self { $($field: keyword(&given, stringify!($field))?,)* })
            }
        }
    };
}

pub(crate) use asked;
