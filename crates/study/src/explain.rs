//! What a word means: a key of a file, the code of a warning, a key of an answer.
//!
//! Keys of files are those of the readers' own table ([`keys`]), codes those of the catalogue of warnings. Keys of answers are
//! told by the documentation of the fields that they are made of: `results.tsv` is collected from the sources by a test, which
//! fails where it is not what the sources say; `named.tsv` has those that are no fields.

use crate::scenario::keys::{self, Place};
use crate::warning::Code;
use serde::Serialize;

const RESULTS: &str = include_str!("explain/results.tsv");
const NAMED: &str = include_str!("explain/named.tsv");

/// A key of an answer in JSON.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ResultKey {
    /// The key.
    pub key: &'static str,
    /// What it is a part of.
    pub of: &'static str,
    /// What it means, with its unit.
    pub meaning: &'static str,
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
/// use hadar_study::explain::result;
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
    keys::find(word)
}

/// All words that mean something, for those that are like one.
#[must_use]
pub fn words() -> Vec<String> {
    let keys = keys::all().into_iter().flat_map(|place| {
        let name = place.key.name.to_owned();
        place.paths.into_iter().chain([name])
    });
    let codes = Code::ALL.iter().map(|code| code.name().to_owned());
    let mut words: Vec<String> = keys.chain(codes).chain(results().map(|one| one.key.to_owned())).collect();
    words.sort_unstable();
    words.dedup();
    words
}
