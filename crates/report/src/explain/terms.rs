//! The field's terms, symbols and the equations of the paper's supplement: one table, `terms.tsv`, of which the guide's page of symbols is made, too.
//!
//! A row has, with tabs between: name, symbol (`H_{req}`, braces and `^` as in TeX), keys that hold it (`;` between), unit, other names, page of the guide, meaning.

use serde::Serialize;

const TERMS: &str = include_str!("terms.tsv");
/// Terms that are offered for words that are no name of one.
const MOST_ALIKE: usize = 5;

/// A term of the field.
#[derive(Debug, Clone, Serialize)]
pub struct Term {
    /// The field's name of it, or the number of an equation in the supplement of the paper (`S27`).
    pub name: &'static str,
    /// Its symbol as in TeX, empty where it has none.
    pub symbol: &'static str,
    /// Keys of files and of answers that hold a value of it.
    pub keys: Vec<&'static str>,
    /// Its unit; `-` where it has none.
    pub unit: &'static str,
    /// Other names under which it is looked up.
    pub also: Vec<&'static str>,
    /// Page of the guide that says more, a path below its sources.
    pub see: &'static str,
    /// What it means, in one to three sentences.
    pub meaning: &'static str,
    /// Whether it is an equation of the supplement.
    pub is_equation: bool,
}

impl Term {
    /// Its symbol as it is typed: `H_req` for `H_{req}`.
    #[must_use]
    pub fn typed_symbol(&self) -> String {
        self.symbol.replace(['{', '}', '^'], "")
    }

    /// All under which it is looked up.
    fn labels(&self) -> impl Iterator<Item = String> {
        let others = self.also.iter().map(|name| (*name).to_owned());
        [self.name.to_owned(), self.typed_symbol()]
            .into_iter()
            .chain(others)
            .filter(|label| !label.is_empty())
    }
}

/// All terms, in the order of the guide.
pub fn terms() -> impl Iterator<Item = Term> {
    TERMS.lines().filter_map(|line| {
        let mut parts = line.split('\t');
        let mut next = || parts.next();
        let list =
            |text: &'static str| text.split(';').map(str::trim).filter(|one| !one.is_empty()).collect();
        let name = next()?;
        let is_equation = name.strip_prefix('S').is_some_and(|number| number.parse::<u8>().is_ok());
        Some(Term {
            name,
            symbol: next()?,
            keys: list(next()?),
            unit: next()?,
            also: list(next()?),
            see: next()?,
            meaning: next()?,
            is_equation,
        })
    })
}

/// The terms that a word names: by name or symbol as they are written, else whatever its case, its hyphens, and Greek letters as such or spelt.
///
/// ```
/// use hadar_report::explain::term;
/// let names = |word| term(word).iter().map(|term| term.name).collect::<Vec<_>>();
/// assert_eq!(names("temperature resolution"), ["NETD"]);
/// assert_eq!(names("gamma"), names("γ"));
/// ```
#[must_use]
pub fn term(word: &str) -> Vec<Term> {
    let exact: Vec<Term> = terms().filter(|term| term.labels().any(|label| label == word)).collect();
    if !exact.is_empty() {
        return exact;
    }
    let folded = folded(word);
    let singular = folded.strip_suffix('s').unwrap_or(&folded);
    let is_one = |label: String| {
        let label = super::terms::folded(&label);
        label == folded || (singular.len() > 2 && label == singular)
    };
    terms().filter(|term| !folded.is_empty() && term.labels().any(is_one)).collect()
}

/// Terms of which one label contains all the words, for words that are no name of one.
#[must_use]
pub fn terms_like(words: &str) -> Vec<Term> {
    let words: Vec<String> = words.split_whitespace().map(folded).filter(|word| word.len() > 2).collect();
    let has_all = |label: String| {
        let label = folded(&label);
        words.iter().all(|word| label.contains(word.as_str()))
    };
    terms().filter(|term| !words.is_empty() && term.labels().any(has_all)).take(MOST_ALIKE).collect()
}

/// Every name of a term, for those that are like one.
pub(super) fn names() -> impl Iterator<Item = String> {
    terms().flat_map(|term| term.labels().collect::<Vec<_>>())
}

/// Letters and digits alone, in lower case, Greek letters spelt.
fn folded(text: &str) -> String {
    let mut folded = String::new();
    for letter in text.to_lowercase().chars() {
        match letter {
            'é' | 'è' => folded.push('e'),
            'α' => folded.push_str("alpha"),
            'γ' => folded.push_str("gamma"),
            'δ' => folded.push_str("delta"),
            'ε' => folded.push_str("epsilon"),
            'η' => folded.push_str("eta"),
            'λ' => folded.push_str("lambda"),
            'ν' => folded.push_str("nu"),
            'ρ' => folded.push_str("rho"),
            'σ' => folded.push_str("sigma"),
            'φ' => folded.push_str("phi"),
            'µ' | 'μ' => folded.push('u'),
            letter if letter.is_alphanumeric() || letter == '*' => folded.push(letter),
            _ => {}
        }
    }
    folded
}

#[cfg(test)]
mod tests {
    use super::{term, terms, terms_like};
    use crate::explain;
    use std::collections::BTreeSet;

    fn names(word: &str) -> Vec<&'static str> {
        term(word).iter().map(|term| term.name).collect()
    }

    #[test]
    fn terms_are_found_by_name_symbol_and_plain_words() {
        for (word, name) in [
            ("d", "statistical distance"),
            ("D", "statistical distance"),
            ("d0", "semantic distance"),
            ("V", "thermal lighting factor"),
            ("γ", "electronic over photon noise"),
            ("Gamma", "electronic over photon noise"),
            ("H_req", "required hardware"),
            ("netd", "NETD"),
            ("NESR", "NESR"),
            ("D*", "D*"),
            ("temperature resolution", "NETD"),
            ("Cramer Rao bound", "Cramér-Rao bound"),
            ("cramér–rao bound", "Cramér-Rao bound"),
            ("nearest state", "closest confuser"),
            ("Fisher information", "Fisher information"),
            ("false alarms", "false alarm"),
            ("stand-in", "surrogate target"),
            ("t", "exposure"),
            ("T", "temperature"),
            ("f", "focal length"),
            ("F", "f-number"),
            ("s27", "S27"),
            ("(S29)", "S29"),
            ("nuisance", "nuisance parameter"),
            ("Planck", "Planck's law"),
        ] {
            assert_eq!(names(word), [name], "{word}");
        }
        assert!(names("").is_empty() && names("size.toml").is_empty());
        assert_eq!(terms_like("resolution of temperature").first().map(|term| term.name), Some("NETD"));
        assert!(terms_like("nothing of the kind").is_empty());
        assert_eq!(terms_like("temperature difference").first().map(|term| term.name), Some("NETD"));
    }

    #[test]
    fn every_row_is_whole_and_says_what_there_is() {
        let guide = hadar_testing::repository().join("docs/src");
        let all: Vec<_> = terms().collect();
        assert!(all.len() > 150, "{}", all.len());
        let different: BTreeSet<&str> = all.iter().map(|term| term.name).collect();
        assert_eq!(different.len(), all.len());
        let equations: BTreeSet<String> = (1..=58).map(|number| format!("S{number}")).collect();
        assert!(equations.iter().all(|name| different.contains(name.as_str())));
        for term in &all {
            let name = term.name;
            assert!(term.meaning.split_whitespace().count() > 3 && term.meaning.ends_with('.'), "{name}");
            assert!(!term.unit.is_empty(), "{name}");
            assert!(guide.join(term.see).is_file(), "{name}: {}", term.see);
            for key in &term.keys {
                let is_known = !explain::key(key).is_empty() || !explain::result(key).is_empty();
                assert!(is_known, "{name}: {key}");
            }
            // Nobody finds two terms under one label that is written the same.
            let others = all.iter().filter(|other| other.name != name);
            let taken =
                others.flat_map(|other| other.labels()).find(|label| term.labels().any(|own| own == *label));
            assert_eq!(taken, None, "{name}");
        }
    }
}
