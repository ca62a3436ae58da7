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
            write!(f, "{}", Shown(&path.to_string_lossy(), LONGEST_PART))?;
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
            write!(f, "{separator}{}", Shown(key, LONGEST_NAME))?;
        }
        Ok(())
    }
}

/// What can be wrong with an input.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number outside the range in which it has a meaning.
    #[error(
        "{} is {}{}; it must be {}",
        Shown(.quantity, LONGEST_PART), short(*.value), unit_suffix(.unit), Shown(.expected, LONGEST_PART)
    )]
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
    #[error("there is no {kind} `{}`{}", Shown(.name, LONGEST_NAME), suggestion(.nearest))]
    UnknownName {
        /// What was looked up, e.g. `material`.
        kind: &'static str,
        /// The name that was not found.
        name: String,
        /// The nearest known names, best first; may be empty.
        nearest: Vec<String>,
    },
    /// Two lists that must have the same length do not.
    #[error("{}: {found} values where {expected} are needed", Shown(.what, LONGEST_PART))]
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
        "`{}` is known from {} to {} cm^-1 but is needed at {} cm^-1; narrow the bands, or add extrapolate = \"hold\" or \"linear\" if you accept a guess",
        Shown(.name, LONGEST_NAME), converted(*known_min), converted(*known_max), converted(*needed)
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
    #[error("{}; {}", Shown(.found, LONGEST_PART), Shown(.instead, LONGEST_PART))]
    Malformed {
        /// What was found.
        found: String,
        /// What to write instead.
        instead: String,
    },
    /// Several things that nobody has given, all of them at once.
    #[error("{}; {}{}", Shown(.found, LONGEST_PART), Shown(.instead, LONGEST_PART), below(.lines))]
    Incomplete {
        /// What is missing.
        found: String,
        /// What to do with the lines.
        instead: String,
        /// Lines to paste, each with a place to fill in; the only part of a message that is not on its one line.
        lines: Vec<String>,
    },
    /// The operating system refused a file operation.
    #[error("cannot {}: {}", Shown(.action, LONGEST_PART), Shown(.reason, LONGEST_PART))]
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
        // Comparing takes the product of the lengths, and nothing is like a name that long.
        let comparable = name.len() <= LONGEST_NAME;
        // Case does not count, and a blank is as good as a hyphen or an underscore: `FLIR Boson`.
        let folded = |name: &str| name.to_lowercase().replace([' ', '_'], "-");
        let lower = if comparable { folded(name) } else { String::new() };
        let mut ranked: Vec<(f64, &str)> = known
            .into_iter()
            .filter(|name| comparable && name.len() <= LONGEST_NAME && !name.contains(char::is_control))
            .map(|candidate| {
                // A part of a name, in whatever case, is meant for it; of several the most alike comes first.
                let other = folded(candidate);
                let part = lower.len() > 2 && other.contains(&lower);
                (f64::from(u8::from(part)) + strsim::jaro_winkler(&lower, &other), candidate)
            })
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
            // A text from nowhere has no place to tell.
            other if outer == Place::default() => other,
            other => Self::At { place: outer, source: Box::new(other) },
        }
    }
}

/// Most characters of a name or key, and of another part of a message.
const LONGEST_NAME: usize = 120;
const LONGEST_PART: usize = 400;

/// Text that a message repeats, which may be from a file: on one line, without anything a terminal would obey, its
/// middle left out if it is longer than the given number of characters.
struct Shown<'a>(&'a str, usize);

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(text, most) = *self;
        let put = |f: &mut fmt::Formatter<'_>, part: &str| {
            part.chars().try_for_each(|char| match char.is_control() {
                true => write!(f, "{}", char.escape_default()),
                false => write!(f, "{char}"),
            })
        };
        // An escaped character takes up to eight.
        let shown = |char: char| if char.is_control() { char.escape_default().len() } else { 1 };
        if text.len() <= most / 8 || text.chars().map(shown).sum::<usize>() <= most {
            return put(f, text);
        }
        let (head, tail) = (3 * most / 4, most / 4 - 3);
        let fits = |room: usize| {
            let mut left = room;
            move |char: &char| left.checked_sub(shown(*char)).map(|rest| left = rest).is_some()
        };
        let start: usize = text.chars().take_while(fits(head)).map(char::len_utf8).sum();
        let end: usize = text.chars().rev().take_while(fits(tail)).map(char::len_utf8).sum();
        put(f, &text[..start])?;
        f.write_str(" … ")?;
        put(f, &text[text.len() - end..])
    }
}

/// Lines below a message, indented.
fn below(lines: &[String]) -> String {
    lines.iter().map(|line| format!("\n  {}", Shown(line, LONGEST_PART))).collect()
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

    /// Every one of many, with the error of the first that is not: first without a branch for each, which is several times as fast.
    ///
    /// # Errors
    /// That of `one`.
    pub fn each(values: &[f64], good: impl Fn(f64) -> bool, one: impl Fn(f64) -> Result<f64>) -> Result<()> {
        if values.iter().fold(true, |all, value| all & good(*value)) {
            return Ok(());
        }
        values.iter().try_for_each(|value| one(*value).map(drop))
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
    fn what_a_file_holds_is_repeated_on_one_line_and_not_at_any_length() {
        let message = |found: &str| Error::malformed(found, "do").for_key(found).to_string();
        assert_eq!(message("a\n\u{1b}[2J\u{85}"), r"a\n\u{1b}[2J\u{85}: a\n\u{1b}[2J\u{85}; do");
        let long = format!("head {}\0 tail", "ä".repeat(100_000));
        let message = message(&long);
        assert!(message.starts_with("head ää") && message.contains(r"ä … ä"), "{message}");
        assert!(message.ends_with(r"ää\u{0} tail; do"), "{message}");
        assert_eq!(message.chars().count(), LONGEST_NAME + 2 + LONGEST_PART + 4);
        for length in 0..LONGEST_PART + 2 {
            let shown = Shown(&"\u{7f}".repeat(length), LONGEST_PART).to_string();
            assert!(shown.len() <= LONGEST_PART + "…".len(), "{length}: {shown}");
        }
        let unknown = Error::unknown_name("key", &"a".repeat(1_000_000), ["a"]);
        assert!(matches!(unknown, Error::UnknownName { nearest, .. } if nearest.is_empty()));
    }

    #[test]
    fn the_nearest_names_are_offered() {
        let error = Error::unknown_name("material", "aluminum", ["skin", "aluminium", "gold"]);
        assert_eq!(error.to_string(), "there is no material `aluminum`; did you mean `aluminium`?");
    }
}
