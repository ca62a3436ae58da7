//! What a word means: a term of the field, a key of a file, the code of a warning, a key of an answer.
//!
//! Keys of files are those of the readers' own table ([`keys`]), codes those of the table of warnings, with their [words](crate::words::warnings). Keys of answers are
//! told by the documentation of the fields that they are made of: `results.tsv` is collected from the sources by a test, which
//! fails where it is not what the sources say; `named.tsv` has those that are no fields. Terms of the field are rows of `terms.tsv`.

mod terms;

use crate::words::conditions::EXPLAINED;
use crate::words::rule::REASONS;
use crate::words::shortfall;
use crate::words::warnings;
use hadar_scenario::keys::{self, Place, Silent};
use hadar_study::warning::Code;
use serde::Serialize;

pub use terms::{Term, term, terms, terms_like};

const RESULTS: &str = include_str!("explain/results.tsv");
const NAMED: &str = include_str!("explain/named.tsv");

/// All that is explained.
#[derive(Debug, Clone, Serialize)]
pub struct Reference {
    /// Terms and symbols of the field, and the equations of the paper's supplement.
    pub terms: Vec<Term>,
    /// Keys of files, by their tables.
    pub keys: Vec<ExplainedKey>,
    /// Codes of warnings, each with its meaning.
    pub warnings: Vec<ExplainedCode>,
    /// Codes of conditions of a verdict; those of figures of a camera are their keys.
    pub conditions: Vec<ExplainedCode>,
    /// Codes of what a camera falls short of.
    pub shortfalls: Vec<ExplainedCode>,
    /// Codes of reasons for which a rule is not passed.
    pub reasons: Vec<ExplainedCode>,
    /// Keys of answers in JSON, each with its meaning.
    pub results: Vec<ResultKey>,
}

/// A key of a file.
#[derive(Debug, Clone, Serialize)]
pub struct ExplainedKey {
    /// Where the key may be written, the shortest path first.
    pub paths: Vec<String>,
    /// What the key means, in a sentence.
    pub meaning: &'static str,
    /// What may be written: kind, units, range.
    pub value: String,
    /// Whether it must be there.
    pub required: bool,
    /// What it is where nothing is written, as it would be written; none where that takes words.
    pub default: Option<&'static str>,
    /// What it means that nothing is written; none where it must be, or has a default.
    pub silent: Option<&'static str>,
    /// A line to write; none of a table.
    pub example: Option<String>,
    /// Where the key is used: an equation of the paper, or what is done with it.
    pub enters: &'static str,
    /// Commands that read a file with this key.
    pub commands: Vec<&'static str>,
    /// Of a table, its keys.
    pub inside: Vec<&'static str>,
}

/// The code of a warning.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ExplainedCode {
    /// The code as it is printed, without brackets.
    pub code: &'static str,
    /// What the code means, in a sentence.
    pub meaning: &'static str,
    /// What to do about it.
    pub remedy: &'static str,
}

/// A key of an answer in JSON.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ResultKey {
    /// Name of the key, without its path.
    pub key: &'static str,
    /// What it is a part of.
    pub of: &'static str,
    /// What it means, with its unit.
    pub meaning: &'static str,
}

impl From<&Place> for ExplainedKey {
    fn from(place: &Place) -> Self {
        let key = place.key;
        let (default, silent) = match key.silent {
            Silent::Refused => (None, None),
            Silent::Is(value) => (Some(value), None),
            Silent::Means(words) => (None, Some(words)),
        };
        Self {
            paths: place.paths.clone(),
            meaning: key.meaning,
            value: key.value.words(),
            required: key.silent == Silent::Refused,
            default,
            silent,
            example: (!key.is_table()).then(|| format!("{} = {}", key.name, key.example)),
            enters: key.enters,
            commands: place.commands.clone(),
            inside: key.value.keys_inside().iter().map(|key| key.name).collect(),
        }
    }
}

impl From<&'static [&'static str; 3]> for ExplainedCode {
    fn from([code, meaning, remedy]: &'static [&'static str; 3]) -> Self {
        Self { code, meaning, remedy }
    }
}

impl From<Code> for ExplainedCode {
    fn from(code: Code) -> Self {
        let words = warnings::of_code(code);
        Self { code: code.name(), meaning: words.meaning, remedy: words.remedy }
    }
}

/// All that is explained: what `hadar explain --all` prints, and a page or a guide is made of.
///
/// ```
/// let reference = hadar_report::explain::all();
/// assert!(reference.keys.iter().any(|key| key.paths.iter().any(|path| path == "camera.exposure")));
/// assert!(reference.warnings.iter().any(|warning| warning.code == "nearest-at-edge"));
/// ```
#[must_use]
pub fn all() -> Reference {
    Reference {
        terms: terms().collect(),
        keys: keys::all().iter().map(ExplainedKey::from).collect(),
        warnings: Code::ALL.iter().copied().map(ExplainedCode::from).collect(),
        conditions: conditions().collect(),
        shortfalls: shortfalls().collect(),
        reasons: reasons().collect(),
        results: results().collect(),
    }
}

/// Codes of conditions of a verdict.
pub fn conditions() -> impl Iterator<Item = ExplainedCode> {
    EXPLAINED.iter().map(ExplainedCode::from)
}

/// Codes of what a camera falls short of.
pub fn shortfalls() -> impl Iterator<Item = ExplainedCode> {
    shortfall::EXPLAINED.iter().map(ExplainedCode::from)
}

/// Codes of reasons for which a rule is not passed.
pub fn reasons() -> impl Iterator<Item = ExplainedCode> {
    REASONS.iter().map(ExplainedCode::from)
}

/// The one of some codes that is called so.
#[must_use]
pub fn called(word: &str, mut codes: impl Iterator<Item = ExplainedCode>) -> Option<ExplainedCode> {
    let name = word.trim_matches(['[', ']']);
    codes.find(|one| one.code == name)
}

/// All keys of answers.
pub fn results() -> impl Iterator<Item = ResultKey> {
    RESULTS.lines().chain(NAMED.lines()).filter_map(|line| {
        let mut parts = line.split('\t');
        Some(ResultKey { key: parts.next()?, of: parts.next()?, meaning: parts.next()? })
    })
}

/// What a key of an answer means, in each part of an answer that has it; a path means its last key.
///
/// ```
/// use hadar_report::explain::result;
/// assert!(result("pairs[0].distance_nearest").iter().all(|one| one.meaning.contains("earest")));
/// ```
#[must_use]
pub fn result(word: &str) -> Vec<ResultKey> {
    let last = word.rsplit('.').next().unwrap_or(word);
    let key = last.split('[').next().unwrap_or(last);
    results().filter(|one| one.key == key).collect()
}

/// The code of a warning by its name.
#[must_use]
pub fn code(word: &str) -> Option<Code> {
    let name = word.trim_matches(['[', ']']);
    Code::ALL.iter().copied().find(|code| code.name() == name)
}

/// The keys of files that a word means.
#[must_use]
pub fn key(word: &str) -> Vec<Place> {
    let found = keys::find(word);
    // The code of a condition is called as the key that would settle it.
    if found.is_empty() { keys::find(&format!("camera.{}", word.replace('-', "_"))) } else { found }
}

/// All words that mean something, for those that are like one.
#[must_use]
pub fn words() -> Vec<String> {
    let keys = keys::all().into_iter().flat_map(|place| {
        let name = place.key.name.to_owned();
        place.paths.into_iter().chain([name])
    });
    let codes = Code::ALL.iter().map(|code| code.name().to_owned());
    let codes = codes.chain(conditions().chain(shortfalls()).chain(reasons()).map(|one| one.code.to_owned()));
    let mut words: Vec<String> =
        keys.chain(codes).chain(results().map(|one| one.key.to_owned())).chain(terms::names()).collect();
    words.sort_unstable();
    words.dedup();
    words
}
