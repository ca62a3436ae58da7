//! Errors that name quantity, value, unit and place, and say what to write instead.
//!
//! Physics returns [`Error::OutOfRange`] and its like without knowing of files; a reader adds the
//! [`Place`] with [`Error::at`]. A message is one sentence: place, what was found, what is due.

use std::fmt;
use std::path::{Path, PathBuf};

/// Result of everything in this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Where in a file a value stands. Every part is optional; unknown parts are not printed.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Place {
    /// File the value was read from.
    pub path: Option<PathBuf>,
    /// Line, counted from 1.
    pub line: Option<usize>,
    /// Key, column or field, e.g. `target.temperature`.
    pub key: Option<String>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut separator = "";
        if let Some(path) = &self.path {
            write!(f, "{}", path.display())?;
            separator = ": ";
        }
        if let Some(line) = self.line {
            if self.path.is_some() {
                write!(f, ":{line}")?;
            } else {
                write!(f, "line {line}")?;
            }
            separator = ": ";
        }
        if let Some(key) = &self.key {
            write!(f, "{separator}{key}")?;
        }
        Ok(())
    }
}

/// What can be wrong with an input.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number outside the range in which it has a meaning.
    #[error("{quantity} is {}{}; it must be {expected}", short(*.value), unit_suffix(.unit))]
    OutOfRange {
        /// Name of the quantity, e.g. `temperature`.
        quantity: String,
        /// The offending value.
        value: f64,
        /// Unit of the value, empty if dimensionless.
        unit: &'static str,
        /// What it must be, e.g. `above 0 K`.
        expected: String,
    },
    /// A name that is not in the list it must come from.
    #[error("there is no {kind} `{name}`{}", suggestion(.nearest))]
    UnknownName {
        /// What was looked up, e.g. `material`.
        kind: &'static str,
        /// The name that was not found.
        name: String,
        /// The nearest known names, best first; may be empty.
        nearest: Vec<String>,
    },
    /// Two lists that must have the same length do not.
    #[error("{what}: {found} values where {expected} are needed")]
    Length {
        /// What is being counted.
        what: String,
        /// Number found.
        found: usize,
        /// Number needed.
        expected: usize,
    },
    /// A spectrum is asked for outside the range in which it is known.
    #[error(
        "`{name}` is known from {} to {} cm^-1 but is needed at {} cm^-1; narrow the bands, or add extrapolate = \"hold\" or \"linear\" if you accept a guess",
        converted(*known_min), converted(*known_max), converted(*needed)
    )]
    OutsideSpectrum {
        /// Name of the spectrum.
        name: String,
        /// Lowest wavenumber of the data, cm⁻¹.
        known_min: f64,
        /// Highest wavenumber of the data, cm⁻¹.
        known_max: f64,
        /// The wavenumber asked for, cm⁻¹.
        needed: f64,
    },
    /// Something is written in a way that cannot be used.
    #[error("{found}; {instead}")]
    Malformed {
        /// What was found.
        found: String,
        /// What to write instead.
        instead: String,
    },
    /// The operating system refused a file operation.
    #[error("cannot {action}: {reason}")]
    File {
        /// What was tried, e.g. `read the scenario`.
        action: String,
        /// The system's reason and what to do.
        reason: String,
    },
    /// Another error, at a known place.
    #[error("{place}: {source}")]
    At {
        /// Where.
        place: Place,
        /// What.
        source: Box<Error>,
    },
}

impl Error {
    /// A number outside its range.
    pub fn out_of_range(
        quantity: impl Into<String>,
        value: f64,
        unit: &'static str,
        expected: impl Into<String>,
    ) -> Self {
        Self::OutOfRange { quantity: quantity.into(), value, unit, expected: expected.into() }
    }

    /// Something written in a way that cannot be used, and what to write instead.
    pub fn malformed(found: impl Into<String>, instead: impl Into<String>) -> Self {
        Self::Malformed { found: found.into(), instead: instead.into() }
    }

    /// An unknown name, with the three nearest of the `known` ones.
    pub fn unknown_name<'a>(
        kind: &'static str,
        name: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let mut ranked: Vec<(f64, &str)> = known
            .into_iter()
            .map(|candidate| (strsim::jaro_winkler(name, candidate), candidate))
            .filter(|(score, _)| *score > 0.6)
            .collect();
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
        let nearest = ranked.into_iter().take(3).map(|(_, candidate)| candidate.to_owned()).collect();
        Self::UnknownName { kind, name: name.to_owned(), nearest }
    }

    /// An operating-system error on `path`.
    pub fn file(action: impl Into<String>, path: &Path, reason: impl fmt::Display) -> Self {
        Self::File { action: action.into(), reason: reason.to_string() }.in_file(path)
    }

    /// Adds a file to the place; parts already known are kept.
    #[must_use]
    pub fn in_file(self, path: &Path) -> Self {
        self.at(Place { path: Some(path.to_owned()), ..Place::default() })
    }

    /// Adds a line (from 1) to the place; parts already known are kept.
    #[must_use]
    pub fn on_line(self, line: usize) -> Self {
        self.at(Place { line: Some(line), ..Place::default() })
    }

    /// Adds a key to the place; parts already known are kept.
    #[must_use]
    pub fn for_key(self, key: impl Into<String>) -> Self {
        self.at(Place { key: Some(key.into()), ..Place::default() })
    }

    /// Adds a place; parts of the place that are already known are kept.
    #[must_use]
    pub fn at(self, outer: Place) -> Self {
        match self {
            Self::At { place, source } => Self::At {
                place: Place {
                    path: place.path.or(outer.path),
                    line: place.line.or(outer.line),
                    key: place.key.or(outer.key),
                },
                source,
            },
            other => Self::At { place: outer, source: Box::new(other) },
        }
    }
}

/// A number in the shortest form that gives it back.
fn short(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && size.is_finite() && !(1e-5..1e16).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// A wavenumber without the last digits of one that was converted from a wavelength.
fn converted(wavenumber_cm1: f64) -> String {
    short((wavenumber_cm1 * 1e6).round() / 1e6)
}

fn unit_suffix(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

fn suggestion(nearest: &[String]) -> String {
    match nearest {
        [] => String::new(),
        [one] => format!("; did you mean `{one}`?"),
        many => format!("; the nearest are `{}`", many.join("`, `")),
    }
}

/// The one checking vocabulary: each returns the value, or an error that names it.
pub mod check {
    use super::{Error, Result};

    /// A finite number.
    pub fn finite(quantity: &str, value: f64, unit: &'static str) -> Result<f64> {
        within(value.is_finite(), quantity, value, unit, "a finite number")
    }

    /// A finite number above zero.
    pub fn positive(quantity: &str, value: f64, unit: &'static str) -> Result<f64> {
        within(value.is_finite() && value > 0.0, quantity, value, unit, "a finite number above 0")
    }

    /// A finite number, zero or above.
    pub fn non_negative(quantity: &str, value: f64, unit: &'static str) -> Result<f64> {
        within(value.is_finite() && value >= 0.0, quantity, value, unit, "a finite number, 0 or above")
    }

    /// A number in [0, 1].
    pub fn unit_interval(quantity: &str, value: f64) -> Result<f64> {
        within((0.0..=1.0).contains(&value), quantity, value, "", "between 0 and 1")
    }

    fn within(ok: bool, quantity: &str, value: f64, unit: &'static str, expected: &str) -> Result<f64> {
        if ok { Ok(value) } else { Err(Error::out_of_range(quantity, value, unit, expected)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_one_sentence_with_place_found_and_remedy() {
        let error = Error::out_of_range("temperature", -3.0, "K", "above 0 K")
            .for_key("target.temperature")
            .on_line(4)
            .in_file(Path::new("a.toml"))
            .in_file(Path::new("ignored.toml"));
        assert_eq!(
            error.to_string(),
            "a.toml:4: target.temperature: temperature is -3 K; it must be above 0 K"
        );
    }

    #[test]
    fn a_number_beyond_all_measure_stays_short() {
        let message = |value| Error::out_of_range("t", value, "K", "less").to_string();
        assert_eq!(message(1e300), "t is 1e300 K; it must be less");
        assert_eq!(message(-2.5e-9), "t is -2.5e-9 K; it must be less");
        assert_eq!(message(0.0), "t is 0 K; it must be less");
    }

    #[test]
    fn the_nearest_names_are_offered() {
        let error = Error::unknown_name("material", "aluminum", ["skin", "aluminium", "gold"]);
        assert_eq!(error.to_string(), "there is no material `aluminum`; did you mean `aluminium`?");
    }
}
